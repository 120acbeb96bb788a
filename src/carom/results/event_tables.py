"""Tables of impacts and of events: columns as arrays, rows as records."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import Columns
from carom.scene.shown import hodograph_of, html_of
from carom.scene.table import RecordTable, Table

CURVED = 1 << 40  # features of curved pieces are above this number, vertices below


class ImpactRecord(NamedTuple):
    """One contact point of an impact.

    Vectors are in contact axes (normal, tangent 1, tangent 2) unless the field says otherwise; with anisotropic
    friction tangent 1 is along its axis. For a stop of an
    angle `unit` is ``"rad/s"``: velocities are in rad/s, impulses in N m s, W in 1/(kg m^2), the penetration in
    rad.

    In a multiple impact, for example when both ends of an edge strike, each contact point has a record of its
    own, with its own velocity, effective mass and impulse. These records have the same time and `together`
    above 1; the effects of their impulses and their energies add up. Points of one body on a half-space that
    move alike are replaced by their mean point, with one record. A point without an impulse has no record.
    """

    time: float  #: time of the impact [s]
    contact: int  #: number of the contact: its index in `Solution.pairs`
    point: np.ndarray  #: (3,) contact point, world [m]
    normal: np.ndarray  #: (3,) normal from `other` to `body`, world
    relative_velocity_before: np.ndarray  #: (3,) velocity before [m/s]; approach is negative
    relative_velocity_after: np.ndarray  #: (3,) velocity after [m/s]
    impulse: np.ndarray  #: (3,) impulse on the body [N s]
    energy_change: (
        float  #: change of energy of the system [J]; in a multiple impact the share of the point
    )
    penetration: float  #: greatest penetration of the boundary layer, delta b [m]
    duration: float  #: duration [s] by the stiffness of the contact; NaN where none is stated
    law: str  #: law of restitution
    inverse_mass: np.ndarray  #: (3, 3) Delassus operator W of the contact [1/kg]
    #: e of the contact; NaN where parts of a body have materials with different ones
    restitution: float
    friction: float  #: mu of the contact; NaN likewise, and if it is anisotropic
    compression_work: float  #: work of the normal force in compression [J]
    restitution_work: float  #: work of the normal force in restitution [J]
    friction_loss: float  #: energy that friction dissipates [J]
    together: int  #: number of points in this multiple impact; 1 for a single impact
    wedged: int  #: 1 if friction wedges the pair, so that the law of restitution cannot hold; otherwise 0
    located: (
        int  #: 1 if the time was located; 0 in a time-stepping (Moreau) step: its end is the time
    )
    #: greatest normal force [N], of a stop of an angle the torque [N m]; NaN where none is stated
    peak_force: float
    layer_duration: float  #: duration in the boundary layer [s], which its width decides
    name: str  #: name of the contact or stop; ``body-other`` for a default pair
    body: str  #: name of the body on which the impulse acts; for a stop the child of its joint
    other: (
        str  #: name of the half-space or body that it strikes; for a stop the parent of its joint
    )
    unit: str  #: unit of the velocities: "m/s", or "rad/s" for a stop of an angle

    def plot(self, **options):
        """Draw the hodograph of the impact, `carom.plots.hodograph`, and return its axes.

        Parameters
        ----------
        **options
            Other arguments of that function, for example ``panel="slip"`` and ``ax``.
        """
        return hodograph_of(self, options)

    def force(self, stiffness=None):
        """Return the force of the impact in time.

        Parameters
        ----------
        stiffness : Stiffness or Hertz
            Stiffness of the contact; of a `Hertz` with its radius.

        Returns
        -------
        carom.impact.force.ImpactForce

        Raises
        ------
        ValueError
            If the impact is part of a multiple impact, or its friction is a law or anisotropic.
        """
        from carom.impact.force import of_record

        return of_record(self, stiffness)

    def _repr_html_(self) -> str:
        return html_of(self)


class ImpactTable(RecordTable[ImpactRecord]):
    """All K impacts of a run in the order of time; the columns (K, ...) are the fields of `ImpactRecord`.

    Examples
    --------
    >>> scene = carom.Scene(gravity=(0, 0, -9.81))
    >>> floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    >>> ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5))
    >>> contact = scene.add_contact(ball, floor, restitution=0.5)
    >>> impacts = carom.simulate(scene, duration=0.8, step=0.01).impacts
    >>> print(impacts.time.round(6))
    [0.285569 0.571137 0.713922 0.785314]
    >>> first = impacts[0]
    >>> print(first.relative_velocity_before[0].round(6), first.relative_velocity_after[0].round(6))
    -2.801428 1.400714
    >>> print(first.body, "on", first.other)
    body1 on half_space1
    """

    _record, _a_row = ImpactRecord, "impact"

    def __repr__(self) -> str:
        head = f"<ImpactTable: {len(self)} impacts"
        rows = [
            f"  t = {r.time:.9f} s  {r.name}  u_n {r.relative_velocity_before[0]:+.6g} -> "
            f"{r.relative_velocity_after[0]:+.6g} {r.unit}  dE = {r.energy_change:.6g} J"
            for r in (self[k] for k in range(min(len(self), 8)))
        ]
        more = [f"  ... {len(self) - 8} more"] if len(self) > 8 else []
        return "\n".join([head, *rows, *more]) + ">"


class JointImpulse(NamedTuple):
    """Impulse of one joint on its child in one impact, world axes."""

    time: float  #: time of the impact [s]
    impact: int  #: index in `Solution.impacts`; of a multiple impact that of its first point
    joint: int  #: index of the joint in `Scene.joints`
    impulse: np.ndarray  #: (3,) impulse on the child at its anchor [N s]
    angular_impulse: np.ndarray  #: (3,) angular impulse on the child about its anchor [N m s]
    name: str  #: name of the joint


class JointImpulseTable(RecordTable[JointImpulse]):
    """Impulses of joints in impacts, in the order of time; the columns are the fields of `JointImpulse`.

    There is a row for each impact and each joint of a body whose velocity it changes. ``table["hinge"]`` has
    the rows of a joint.

    Examples
    --------
    A rod of 1 kg and 1 m on a hinge strikes a pin at 2/3 of its length, its centre of percussion: the hinge
    takes nothing along the blow.

    >>> scene = carom.Scene(gravity=(0, 0, 0))
    >>> rod = scene.add_body(carom.Box(1, 0.02, 0.02), mass=1, position=(0.5, 0, 0), velocity=(0, 0, -0.5),
    ...                      inertia=(1 / 12, 1 / 12, 1 / 12), angular_velocity=(0, 1, 0), name="rod")
    >>> hinge = carom.joints.Revolute(anchor=(0, 0, 0), axis=(0, 1, 0))
    >>> joint = scene.add_joint(hinge, carom.GROUND, "rod", name="hinge")
    >>> pin = scene.add_static(carom.Sphere(0.01), position=(2 / 3, 0, -0.1), name="pin")
    >>> contact = scene.add_contact("rod", "pin", restitution=1.0)
    >>> solution = carom.simulate(scene, duration=0.2)
    >>> bool(abs(solution.joint_impulses["hinge"].impulse).max() < 0.02 * solution.impacts.impulse[0, 0])
    True
    """

    _record, _a_row, _of = JointImpulse, "impulse", "joint"


@dataclass(frozen=True, eq=False, repr=False)
class EventTable(Table[dict]):
    """Events of contacts in the order of time: impacts, and changes of persistent contacts.

    The kind "held" means that a contact becomes persistent, "jams" that it reaches Painleve's paradox. As in
    the tables below, ``len`` is the number of rows, and ``table[k]`` is row k as a dict of all columns.
    """

    time: np.ndarray  #: (E,) time of the event [s]
    kind: np.ndarray  #: (E,) "impact", "held", "slips", "sticks", "opens" or "jams"
    contact: np.ndarray  #: (E,) index of the contact


@dataclass(frozen=True, eq=False, repr=False)
class SwitchTable(Table[dict]):
    """Parts that were switched in a run, in the order of time."""

    time: np.ndarray  #: (S,) time [s]
    part: np.ndarray  #: (S,) name of the part
    on: np.ndarray  #: (S,) whether it was put into the motion, or taken out
    energy: np.ndarray  #: (S,) change of the energy of the system by this [J]
    switch: np.ndarray  #: (S,) name of the switch; "" if `carom.Run.switch` did it


@dataclass(frozen=True, eq=False, repr=False)
class ContactTable(Table[dict]):
    """Intervals of persistent contact, in the order of their starts.

    An interval lasts as long as a contact point keeps slipping, or keeps sticking. When faces of two bodies
    slide on each other, the corners of their overlap change; a new corner continues the interval of the corner
    that it replaces.
    """

    contact: np.ndarray  #: (M,) index of the contact
    #: (M,) number of the contact point; on a half-space the vertex of the shape
    feature: np.ndarray
    start: np.ndarray  #: (M,) start of the interval [s]
    end: np.ndarray  #: (M,) end of the interval, at latest the end of the run [s]
    mode: np.ndarray  #: (M,) "slipping" or "sticking" (or rolling, or at rest)


@dataclass(frozen=True, eq=False, repr=False)
class ForceTable(Table[dict]):
    """Forces of persistent contacts, in the order of time: one row for each active point and saved time."""

    saved: np.ndarray  #: (M,) index of the saved time
    contact: np.ndarray  #: (M,) index of the contact
    body: np.ndarray  #: (M,) index of its body
    other: np.ndarray  #: (M,) index of the other body, -1 for a half-space
    mode: np.ndarray  #: (M,) "slipping" or "sticking" (or rolling, or at rest)
    point: np.ndarray  #: (M, 3) contact point, world [m]
    force: np.ndarray  #: (M, 3) force on the body, contact axes [N]
    vector: np.ndarray  #: (M, 3) force on the body, world axes [N]


def force_table(touch) -> ForceTable:
    """Return the forces of all active points that were saved, (M,)."""
    row = touch[np.argsort(touch.saved, kind="stable")].view(Columns)
    mode = np.array(["open", "slipping", "sticking"])[row.mode]
    columns = (row.saved, row.contact, row.body, row.other, mode, row.point, row.force, row.push)
    return ForceTable(*(np.array(column) for column in columns))


_MODES = {"slips": 1, "sticks": 2, "opens": 0}


def contact_table(event, kinds, first, end: float) -> ContactTable:
    """Return the intervals of persistent contact between events.

    Parameters
    ----------
    event : records of the run, (E,)
    kinds : their names, by code
    first : (C,) first vertex of each contact with a half-space, 0 for two bodies
    end : time of the last state
    """
    rows, at = [], {}  # rows: contact, feature, start, end, mode; at: the present row of a point
    fields = ("contact", "feature", "kind", "time", "mode")
    for contact, feature, code, time, first_mode in zip(*(event[f].tolist() for f in fields)):
        key, kind = (contact, feature), kinds[code]
        if kind not in ("held", "slips", "sticks", "opens"):
            continue
        if kind != "held" and key not in at:  # the point has replaced another one
            others = [other for other in at if other[0] == key[0]]
            if not others:
                continue
            at[key] = at.pop(others[0])
        mode: int = first_mode if kind == "held" else _MODES[kind]
        if key in at:
            if rows[at[key]][4] == mode:
                continue  # slip has only turned
            rows[at.pop(key)][3] = time
        if mode > 0:
            at[key] = len(rows)
            rows.append([*key, time, end, mode])
    columns = list(zip(*rows)) if rows else [[]] * 5
    contact = np.array(columns[0], dtype=np.int64)
    feature = np.array(columns[1], dtype=np.int64)
    return ContactTable(
        contact,
        np.where(feature < CURVED, feature - first[contact], feature),
        np.array(columns[2], dtype=float),
        np.array(columns[3], dtype=float),
        np.array(["open", "slipping", "sticking"])[np.array(columns[4], dtype=np.int64)],
    )
