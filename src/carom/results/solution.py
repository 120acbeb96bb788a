"""`Solution`: the motion, the impacts and the energy ledger of a run, and how it ended."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from carom import arguments, checks
from carom._compiled.record_arrays import Columns
from carom.geometry import quaternion
from carom.model.laws import law_of, with_slip
from carom.results.dense_output import curves, flights
from carom.results.drawn import Drawn
from carom.results.endings import message
from carom.results.event_tables import (
    ContactTable,
    EventTable,
    ForceTable,
    ImpactTable,
    JointImpulseTable,
    SwitchTable,
    force_table,
)
from carom.results.exerted import COLUMNS_EACH, rows_of, rubs
from carom.results.joint_coordinates import in_degrees, of_scene
from carom.results.ledger import Ledger
from carom.results.named import Source
from carom.results.names import ConstraintRows, Numbers, constraint_rows
from carom.results.portable import Portable
from carom.results.spans import InSpans
from carom.status import Status
from carom.stepping.settings import settings_of

if TYPE_CHECKING:
    from carom.impact import ImpactForces
    from carom.results.assemble import Written
    from carom.results.state import SystemState
    from carom.run import Run
    from carom.scene.all_pairs import PairTable
    from carom.scene.bodies import HalfSpace, StaticBody
    from carom.scene.scene import Scene

SIDES = ("right", "left")


@arguments.attributes()
@dataclass(frozen=True, eq=False)
class Solution(Portable, Drawn, Source, InSpans):
    """The motion of N bodies at T saved times, with K impacts.

    ``solution["name"]`` has the results of one part: a body, a joint, a force, a contact.

    Attributes
    ----------
    t : (T,)
        Saved times [s].
    position : (T, N, 3)
        Positions of the mass centres, world [m].
    orientation : (T, N, 4)
        Unit quaternions (w, x, y, z), body to world.
    velocity, angular_velocity : (T, N, 3)
        Velocities of the mass centres [m/s] and angular velocities [rad/s], world axes. At the time of an
        impact: the values after it.
    kinetic_energy, potential_energy, total_energy : (T,)
        Energies of the whole system [J].
    impacts : ImpactTable
        One record for each impact.
    events : EventTable
        Impacts and changes of persistent contacts, in the order of time.
    contacts : ContactTable
        Intervals of persistent contact: contact point, start, end, and slip or stick.
    held_residual : (T,)
        Largest residual of the contact law in persistent contacts [m/s], over all steps since the previous
        saved time; 0 without persistent contact. It is computed from the velocities of the bodies and the
        applied impulses, independent of the solver: for each point ``|p - P_K(p - rho (w + mu |w_t| n))| /
        rho``, where P_K is the projection onto the friction cone and rho the effective mass of the point. For a
        single contact point it is the velocity that the contact forbids.
    pairs : PairTable
        The pairs that may touch; tables refer to them by their number `contact`, and ``pairs[k]`` is pair k.
        Columns: `body`, `other` (-1 for a half-space), `plane` (-1 for a body), `law` (an index in the list
        `laws`). First come the contacts of `Scene.contacts`, then those of `set_contact_default`: pairs with
        half-spaces, body by body, then pairs of two bodies (with more than 64 bodies on which only gravity
        acts: only the pairs that came near each other, in the order in which they did). Stops of joints have
        the numbers after these.
    ledger : Ledger
        Energy balance of the run.
    status : Status
        How the run ended; see also `success` and `message`.
    warnings : tuple of str
        Sentences about energy errors above `Options.energy_tolerance`, penetrations, contact problems that were
        not solved, energy that Newton's law of restitution added, jams, and laws of restitution that could not
        hold, with the time, the amount and a remedy. Empty if there are none.
    stats : dict
        Counts: steps, trial steps, steps rejected by their error, cuts, located events, impacts, contacts that
        became persistent; steps with active contacts and their iterations; `explicit_steps`: steps in singular
        positions that a symplectic method replaced by explicit ones; `parts`: additional steps because steps
        were divided for a large rotation of a body; `whole_steps`: steps that touching bodies, such as a crowd,
        took as time-stepping (Moreau) steps, with impacts at the end of the step (`impacts.located` is 0);
        `busiest_contact`: name of the contact or stop with the most impacts and changes of contact;
        `busiest_events`: their number.

    scene : Scene
        The scene of the run.
    settings : dict
        Duration, step, method and tolerances of the run.
    t_events : list of (n,), or None
        For each of the `events` that `simulate` was given the times [s] at which it happened.
    state_events : list of lists of SystemState, or None
        The states at these times.

    Examples
    --------
    >>> scene = carom.Scene(gravity=(0, 0, -9.81))
    >>> floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    >>> ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5))
    >>> contact = scene.add_contact(ball, floor, restitution=0.5)
    >>> solution = carom.simulate(scene, duration=2.0, step=0.01)
    >>> solution.position.shape
    (201, 1, 3)
    >>> x, Q, v, w = solution.evaluate(0.1)  # between saved times, too
    >>> print(v.round(6) + 0.0)
    [[ 0.     0.    -0.981]]
    >>> solution["body1"].velocity.shape  # the motion of one body
    (201, 3)
    >>> print(solution["body1-half_space1"].force[-1].round(9) + 0.0)  # it rests
    [9.81 0.   0.  ]
    >>> bool(abs(solution.ledger.residual).max() < 1e-13)
    True
    """

    t: np.ndarray
    position: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    held_residual: np.ndarray
    status: Status
    stats: dict[str, Any]
    scene: Scene = field(repr=False)
    pairs: PairTable = field(repr=False)
    settings: dict[str, Any]
    _run: Run = field(repr=False)
    _touch: np.recarray = field(repr=False)
    #: records from which other fields are computed; None if the solution is from a file, which has all fields
    _written: Written | None = field(repr=False, default=None)
    warnings: tuple[str, ...] = ()
    t_events: list[np.ndarray] | None = field(repr=False, default=None)
    state_events: list[list[SystemState]] | None = field(repr=False, default=None)
    _stopped_by: str = field(repr=False, default="")
    #: what is known about a failure beyond its status
    _reason: str = field(repr=False, default="")

    @classmethod
    def _from_run(cls, run: Run, status: Status, **watched) -> Solution:
        """Make the solution from the records of a run."""
        from carom.results.assemble import assemble

        return cls(**assemble(run, status), **watched)

    @property
    def _assemble(self):
        """The functions that make results from the records of the run; they load compiled code."""
        from carom.results import assemble

        return assemble

    @property
    def _series(self) -> np.recarray:
        assert self._written is not None
        return self._written.series

    @cached_property
    def orientation(self) -> np.ndarray:
        """Unit quaternions (T, N, 4), body to world."""
        return self._assemble.orientation(self)

    @cached_property
    def kinetic_energy(self) -> np.ndarray:
        """Kinetic energy of all bodies (T,) [J]."""
        return np.array(self._series["kinetic"])

    @cached_property
    def potential_energy(self) -> np.ndarray:
        """Potential energy of gravity, springs and user-defined forces with a potential (T,) [J]."""
        return np.array(self._series["potential"])

    @cached_property
    def impacts(self) -> ImpactTable:
        """One record for each impact."""
        return self._assemble.impact_table(self)._by_name(self._numbers)

    @cached_property
    def events(self) -> EventTable:
        """Impacts and changes of persistent contacts, in the order of time."""
        return self._assemble.event_table(self)._by_name(self._numbers)

    @cached_property
    def contacts(self) -> ContactTable:
        """Intervals of persistent contact."""
        return self._assemble.intervals(self)._by_name(self._numbers)

    @cached_property
    def switches(self) -> SwitchTable:
        """Parts that were switched off or on, or that broke, in the order of time."""
        return self._assemble.switch_table(self)

    @cached_property
    def ledger(self) -> Ledger:
        """Energy balance of the run."""
        sums = (np.array(self._series[one.name]) for one in fields(Ledger)[2:])
        return Ledger(self.kinetic_energy, self.potential_energy, *sums)

    def __contains__(self, name) -> bool:
        """Return whether the scene of this run has a part of this name, or this part."""
        return name in self.scene

    @property
    def _scene(self) -> Scene:
        return self.scene

    @cached_property
    def _numbers(self) -> Numbers:
        return Numbers(self.scene, self.pairs)

    @cached_property
    def _reports(self):
        from carom.results.reports import Reports

        return Reports(self.scene)

    @property
    def _saved(self):
        """The records of the run, as far as they were written."""
        from carom.model.records import written

        return written(self._run.records, self._run.clock)

    def _report(self, forces) -> np.recarray:
        """Return what some forces exert (T, R), as `Reports.exerted` does."""
        if self._spans:
            return self._by_span(lambda part: part._report(forces)).view(Columns)
        ranges = self._assemble.ranges_of(self._run, self._reports.compiled, len(self.t))
        frictions = self._solved[1] if any(map(rubs, forces)) else {}
        return self._reports.exerted(forces, self._saved, ranges, frictions)

    @cached_property
    def _exerted(self) -> np.ndarray:
        from carom.results.reports import numbers

        if not self.scene.forces:
            return np.zeros((len(self.t), 0, COLUMNS_EACH))
        return numbers(self._report(self.scene.forces))[..., :COLUMNS_EACH]

    def _exerted_by(self, force) -> np.ndarray:
        rows = [k for k, row in enumerate(rows_of(self.scene)) if row.force is force]
        return self._exerted[:, rows]

    @cached_property
    def joint_impulses(self) -> JointImpulseTable:
        """Impulses of the joints in impacts: what a bearing takes when something strikes.

        They are computed from the velocities before and after each impact when they are asked for, some tenths
        of a millisecond for each. Impacts that were not located (`ImpactTable.located`) have none. If joints
        are redundant, these are the impulses of least norm, as for `joint_reactions`.
        """
        from carom.results.joint_impulses import joint_impulses

        return joint_impulses(self)

    @property
    def message(self) -> str:
        """How the run ended, in sentences; if it failed, with the time that it reached."""
        finer = settings_of(self.settings, self._run.options).finer
        said = message(self.status, self._reason, finer, self.t[-1], self.warnings)
        if not self.status.ended:
            return said
        from carom.results.accuracy import taken_whole

        more = () if self.status is Status.INACCURATE else taken_whole(self.stats)
        if self._stopped_by:
            more = (f"That was {self._stopped_by} at t = {self.t[-1]:.9g} s.", *more)
        elif not_seen := [i for i, t in enumerate(self.t_events or ()) if not len(t)]:
            names = ", ".join(f"events[{i}]" for i in not_seen)
            more = (f"{names} did not happen.", *more)
        return " ".join((said, *more))

    @cached_property
    def _accelerations(self) -> np.ndarray:
        if self._spans:
            return self._by_span(lambda part: part._accelerations)
        return self._assemble.accelerations(self)

    @cached_property
    def _solved(self) -> tuple[np.ndarray, dict[int, np.ndarray]]:
        if self._spans:
            dry = [force.index for force in self.scene.forces if rubs(force)]
            values = {
                index: self._by_span(
                    lambda part, k=index: part._solved[1].get(k, np.zeros(len(part.t)))
                )
                for index in dry
            }
            return self._by_span(lambda part: part._solved[0]), values
        return self._assemble.element_reactions(self)

    @cached_property
    def joint_reactions(self) -> np.ndarray:
        """Force and torque (T, J, 6) of each joint on its child at its anchor, world axes [N], [N m].

        In the order of `Scene.joints`. If joints are redundant, reactions are not unique: these are the
        reactions of least norm, where each row is weighted by its diagonal entry of A M^-1 A^T.
        """
        return self._solved[0][:, : len(self.scene.joints)]

    @cached_property
    def constraint_forces(self) -> np.ndarray:
        """Multipliers (T, K) of the rows of `Scene.constraints`, in their order.

        For a `Driver`, the force [N] or torque [N m] of its motor along the coordinate. For a `Coupling`, the
        force or torque on each joint divided by the factor of the joint. For `Rows`, the factor of each row in
        the constraint force.
        """
        return self._assemble.multipliers(self.scene, self._solved[0])

    @arguments.known
    def joint_coordinates(self, joint, *, degrees: bool = False) -> tuple[np.ndarray, np.ndarray]:
        """Return (coordinates, rates), each (T, n), of a joint at saved times, computed from the states.

        Coordinates are those of the child relative to the parent: 0 at the start, positive along the directions
        of the definition (angles by the right-hand rule). Directions turn with the parent, except `axis_child`,
        which turns with the child.

        ==================  ========================================================================
        Revolute            angle [rad]
        Prismatic           displacement of the child's anchor [m]
        Cylindrical, Screw  angle, displacement
        Universal           q1 about `axis_parent`, q2 about `axis_child`: in axes of the parent the child has
                            turned by R1(q1) R2(q2) since the start
        Planar              two displacements, along t1 and normal x t1, and the angle about the normal; t1 is
                            the world axis with the smallest component along the normal at the start (the
                            first of x, y, z), projected onto the plane
        PointOnLine         displacement
        PointOnPlane        two displacements, as for Planar
        PointOnCurve,       arc length from the start, positive towards the end of the curve; laps of a closed
        CurveOnPoint        curve are counted like turns
        Distance            length [m] (not 0 at the start)
        Spherical           rotation vector [rad], angle in [0, pi], in the world axes of the start, fixed in
                            the parent; its rates are the relative angular velocity in the same axes
        Fixed, KnifeEdge,   none: n = 0
        rolling
        ==================  ========================================================================

        Angles include whole turns, which the run counts. (In files of earlier versions they are counted
        with the mean of the rates between two saved times, whose error must be less than half a turn.) At the
        time of an impact the rate is the value after it.

        Parameters
        ----------
        joint : Joint or str
            A joint of the scene, or its name.
        degrees : bool
            Whether angles and their rates are in degrees. Default False: radians.

        Raises
        ------
        KeyError
            If the scene has no part with this name.
        TypeError, ValueError
            If `joint` is not a joint, or belongs to another scene.
        """
        joint = of_scene(self.scene, joint)
        if self._spans:
            read = [
                self._by_span(lambda part, k=k: part.joint_coordinates(joint, degrees=degrees)[k])
                for k in range(2)
            ]
            return read[0], read[1]
        motion = self._reports.motion(joint, self._saved)
        read = motion.value.copy(), motion.rate.copy()
        return in_degrees(joint, *read) if checks.flag("degrees", degrees) else read

    @cached_property
    def constraint_errors(self) -> tuple[np.ndarray, np.ndarray]:
        """Errors of joints and constraints at saved times: of position and of velocity, (T, R) each.

        They are absolute errors of the R rows in `constraint_rows`, which has the names and units of the rows
        (units of velocity errors: the same per second). Errors of angles do not include whole turns. While a
        part is switched off, they are NaN.
        """
        if self._spans:
            x, v = (self._by_span(lambda part, k=k: part.constraint_errors[k]) for k in range(2))
            return x, v
        return self._assemble.constraint_errors(self)

    @cached_property
    def constraint_rows(self) -> ConstraintRows:
        """The R rows of joints and constraints in `constraint_errors`: columns `name` and `unit`.

        Units are "m" or "rad", or "" if user-defined factors determine the unit (`Rows`, a `Coupling` of angles
        and displacements).
        """
        return constraint_rows(self.scene)

    @arguments.known
    def evaluate(self, t, side: str = "right"):
        """Return (position, orientation, velocity, angular_velocity) at times between saved ones.

        The states are those of the motion. For a body on which only gravity acts, while it touches nothing,
        they are in closed form. For other bodies the run is repeated from the saved state before, with the
        method of the run; this takes as long as the run took there. A cubic through both saved states replaces
        it if the repeated motion misses the next saved state by more than ten times the tolerances and by more
        than a tenth of its difference from the cubic (for example in a pile where impacts follow each other),
        or if user-defined functions of a file are missing. The error of the cubic is of order 4 in the saved
        interval for positions and orientations, and of order 3 for velocities.

        Parameters
        ----------
        t : float or (n,)
            Times within the run [s].
        side : {"right", "left"}
            Velocity at the time of an event: after it (``"right"``, default) or before it (``"left"``).

        Returns
        -------
        tuple of arrays
            Arrays (n, N, 3), (n, N, 4), (n, N, 3), (n, N, 3); for a single time without the first axis.

        Raises
        ------
        ValueError
            If a time is outside the run, or `side` is invalid.
        """
        from carom.results.replay import evaluate

        checks.choice("side", side, SIDES)
        times = checks.times("t", t, self.t[0], self.t[-1])
        if self._spans:
            return self._by_time(t, side, lambda part, now: part.evaluate(now, side))
        *states, cubic = curves(self, times, side)
        evaluate(self, times, cubic, *states)
        return self._seen(t, *states)

    def _curve(self, t, side: str = "right"):
        """Return the result of `evaluate`, but with cubics where there is no closed form, for pictures."""
        if self._spans:
            return self._by_time(t, side, lambda part, now: part._curve(now, side))
        return self._seen(t, *curves(self, np.atleast_1d(np.asarray(t, dtype=float)), side)[:4])

    def _seen(self, t, x, Q, v, w):
        """Return states with attitudes of the scene's axes, without the first axis for a single time."""
        Q = quaternion.multiply(Q, quaternion.conjugate(self._run.to_principal))
        return tuple(a[0] for a in (x, Q, v, w)) if np.ndim(t) == 0 else (x, Q, v, w)

    @cached_property
    def _replay(self):
        from carom.results.replay import Replay

        return Replay(self)

    @property
    def contact_mode(self) -> np.ndarray:
        """Modes (T, C) of the contacts: 0 open, 1 slipping, 2 sticking (or rolling, or at rest)."""
        return self._contact_sums[0]

    @property
    def contact_force(self) -> np.ndarray:
        """Forces (T, C, 3) of persistent contacts in contact axes (normal, tangent 1, tangent 2) [N]."""
        return self._contact_sums[1]

    @cached_property
    def forces(self) -> ForceTable:
        """Forces at all points of persistent contact, as a table.

        It is smaller than `contact_mode` and `contact_force` in scenes with many contacts, because these have
        an entry for each contact of `pairs` at each saved time.
        """
        return force_table(self._touch)._by_name(self._numbers)

    def surface_power(self, part: HalfSpace | StaticBody | str) -> np.ndarray:
        """Return the power (T,) [W] of the drive of a surface that moves in itself, at the saved times.

        It is that of the forces of persistent contact. The work of all drives, with what they do in impacts, is
        in `Ledger.loads`.

        Parameters
        ----------
        part : HalfSpace, StaticBody or str
            A half-space or a static body of the scene, or its name.
        """
        one = self.scene[part] if isinstance(part, str) else part
        place = [k for k, known in enumerate(self.scene.fixed) if known is one]
        if not place:
            raise ValueError(
                f"part must be a half-space or a static body of the scene, got {checks.shown(part)}"
            )
        plane = np.append(self.pairs.plane, np.full(len(self.scene.stops), -1))
        rows = plane[self._touch.contact] == place[0]
        return np.bincount(self._touch.saved[rows], self._touch.power[rows], len(self.t))

    @cached_property
    def _contact_sums(self) -> tuple[np.ndarray, np.ndarray]:
        count = len(self.pairs.body) + len(self.scene.stops)
        return self._assemble.contact_sums(self._touch, len(self.t), count)

    @cached_property
    def _nodes(self):
        return self._assemble.nodes(self._run)

    @cached_property
    def _flights(self):
        return flights(self)

    @arguments.known
    def impact_forces(self, k: int, stiffness=None) -> ImpactForces:
        """Return the forces in time of impact k and of all impacts at its time, which share it.

        Parameters
        ----------
        k : int
            Index of the impact; negative indices count from the end.
        stiffness : Stiffness or Hertz, or a sequence of them, optional
            Of all impacts at this time, or of each. Default: those that the contacts state. Of a face with
            several points each point has it.

        Returns
        -------
        carom.impact.ImpactForces

        Raises
        ------
        IndexError
            If there is no impact k.
        TypeError, ValueError
            If no stiffness in newton is stated, or the impacts have no course in time with it: they were solved
            with other ratios of stiffnesses or another exponent, or one after another.
        """
        from carom.results.impact_forces import impact_forces

        count, k = len(self.impacts), checks.integer("k", k)
        if not -count <= k < count:
            raise IndexError(f"k must be the index of an impact, got impact {k} of {count}")
        return impact_forces(self, k, stiffness)

    def impact_history(self, k: int, steps: int | None = None):
        """Return impact k resolved in time inside its boundary layer, a `LayerHistory`.

        Parameters
        ----------
        k : int
            Index of the impact.
        steps : int, optional
            Number of spline steps through the layer. Default: `Options.layer_steps`.

        Raises
        ------
        IndexError
            If there is no impact k.
        ValueError
            If impact k is part of a multiple impact, its friction is a law or anisotropic, or parts of the
            bodies have different materials.
        """
        from carom.impact.history import impact_layer

        count, k = len(self.impacts), checks.integer("k", k)
        if not -count <= k < count:
            raise IndexError(f"k must be the index of an impact, got impact {k} of {count}")
        record = self.impacts[k]
        if record.together > 1:
            raise ValueError(
                f"impact {k} is part of a multiple impact ({record.together} closed points) and has no "
                "boundary layer of its own; choose an impact with impacts.together == 1"
            )
        system = self._span_at(float(record.time))._run.compiled.system
        contacts = system.contacts
        row = contacts[int(np.searchsorted(contacts.number, record.contact))]
        law = law_of(system, row)
        if with_slip(law):
            raise ValueError(
                f"k must be an impact whose friction is a number, got {k}, of a law: the layer of the paper "
                "has none"
            )
        if row.axis_of > 0:
            raise ValueError(
                f"k must be an impact whose friction is a number, got {k}, of anisotropic friction"
            )
        if not np.isfinite(record.friction + record.restitution):
            raise ValueError(
                f"k must be an impact of a contact with one material, got {k}: the parts that struck are not "
                "recorded"
            )
        return impact_layer(
            record.inverse_mass, record.relative_velocity_before, record.friction,
            record.restitution, penetration=float(row.penetration), width=float(row.width),
            law=record.law, tangential_restitution=float(law.tangential_restitution),
            steps=self._run.options.layer_steps if steps is None else steps,
        )  # fmt: skip

    def __repr__(self) -> str:
        return (
            f"<Solution: {self.position.shape[1]} bodies, t = {self.t[0]:g} .. {self.t[-1]:g} s in "
            f"{len(self.t)} saved steps, {len(self.impacts)} impacts; {self.message}>"
        )
