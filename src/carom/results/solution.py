"""What a run hands back: the motion, the impacts, the energy ledger, and how it ended."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from carom import checks
from carom.geometry import quaternion
from carom.results.constraint_rows import ConstraintRows, constraint_rows
from carom.results.dense_output import between, flights
from carom.results.drawn import Drawn
from carom.results.event_tables import (
    ContactTable,
    EventTable,
    ForceTable,
    ImpactTable,
    force_table,
)
from carom.results.ledger import Ledger
from carom.results.portable import Portable
from carom.status import Status

if TYPE_CHECKING:
    from carom.results.assemble import Written
    from carom.results.state import SystemState
    from carom.run import Run
    from carom.scene.all_pairs import PairTable
    from carom.scene.scene import Scene

SIDES = ("right", "left")


@dataclass(frozen=True, eq=False)
class Solution(Portable, Drawn):
    """The motion of N bodies at T saved times, with K impacts.

    Attributes
    ----------
    t : (T,)
        Saved times [s].
    position : (T, N, 3)
        Mass centres, world [m].
    orientation : (T, N, 4)
        Unit quaternions (w, x, y, z), body to world.
    velocity, angular_velocity : (T, N, 3)
        World axes [m/s], [rad/s]. At a time where an impact happened: after it.
    kinetic_energy, potential_energy, total_energy : (T,)
        Of all bodies, gravity and springs [J].
    impacts : ImpactTable
        One record for each impact.
    events : EventTable
        Impacts and changes of persistent contacts, in their order.
    contacts : ContactTable
        Intervals of contact that stays: which point, from when to when, slipping or sticking.
    held_residual : (T,)
        How far velocities and impulses of persistent contacts are from their law [m/s]: the greatest of all
        steps since the saved time before. Worked out from the velocities of the bodies and the impulses that
        were applied, whoever found them: ``|p - P_K(p - rho (w + mu |w_t| n))| / rho`` of each point, with P_K
        the projection on the friction cone and rho its mass; of a point held alone, the velocity that it must
        not have. 0 where nothing is held.
    pairs : PairTable
        What touches what, by the number that tables call `contact`: columns `body`, `other` (-1 for a
        half-space), `plane` (-1 for a body), `law` (a place in `laws`). First the contacts of `Scene.contacts`,
        then those of `set_contact_default`: with half-spaces, body by body, then of two bodies (of more than 64
        bodies on which only gravity acts: of those that came near each other, in the order in which they did).
        Stops in joints have the numbers after these.
    ledger : Ledger
        Where the energy went.
    status : Status
        How the run ended; `success` and `message` say it shorter and longer.
    warnings : tuple of str
        What has gone beyond `Options.energy_tolerance`, and bodies that are in a surface: when, how much, what
        to change. Empty if all is well.
    stats : dict
        Counts: steps, trial steps, rejected ones (by their error), cuts, located events, impacts, holds;
        steps of active points and their rounds (or sweeps); `explicit_steps`, those that a symplectic
        method left to the explicit one in singular positions; `parts`, by how many those outnumber the (trial)
        steps that were made in parts, as a body turned far; and `whole_steps`, in how many steps bodies that
        touch were taken whole, as a crowd: impacts of these are at the ends of steps (`impacts.located`).

    scene : Scene
        What was run.
    settings : dict
        Duration, step, method and tolerances of the run.
    t_events : list of (n,), or None
        For each of the `events` that `simulate` was given the times [s] at which it happened.
    state_events : list of lists of SystemState, or None
        The states at these times. (Files have neither.)

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
    >>> print(solution.contact_force[-1, 0].round(9) + 0.0)  # it rests
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
    stats: dict[str, int]
    scene: Scene = field(repr=False)
    pairs: PairTable = field(repr=False)
    settings: dict[str, Any]
    _run: Run = field(repr=False)
    _touch: np.recarray = field(repr=False)
    #: what the rest is worked out from; None: from a file, which has had it all
    _written: Written | None = field(repr=False, default=None)
    warnings: tuple[str, ...] = ()
    t_events: list[np.ndarray] | None = field(repr=False, default=None)
    state_events: list[list[SystemState]] | None = field(repr=False, default=None)
    _stopped_by: str = field(repr=False, default="")

    @classmethod
    def _from_run(cls, run: Run, status: Status) -> Solution:
        """Collect what a run has written down."""
        from carom.results.assemble import assemble

        return cls(**assemble(run, status))

    @cached_property
    def orientation(self) -> np.ndarray:
        """Unit quaternions (T, N, 4), body to world."""
        from carom.results.assemble import orientation

        return orientation(self)

    @cached_property
    def kinetic_energy(self) -> np.ndarray:
        """Of all bodies (T,) [J]."""
        from carom.results.assemble import energy

        return energy(self, "kinetic")

    @cached_property
    def potential_energy(self) -> np.ndarray:
        """Of gravity, springs and forces of your own that have one (T,) [J]."""
        from carom.results.assemble import energy

        return energy(self, "potential")

    @cached_property
    def impacts(self) -> ImpactTable:
        """One record for each impact."""
        from carom.results.assemble import impact_table

        return impact_table(self)

    @cached_property
    def events(self) -> EventTable:
        """Impacts and changes of persistent contacts, in their order."""
        from carom.results.assemble import event_table

        return event_table(self)

    @cached_property
    def contacts(self) -> ContactTable:
        """Intervals of contact that stays."""
        from carom.results.assemble import intervals

        return intervals(self)

    @cached_property
    def ledger(self) -> Ledger:
        """Where the energy went."""
        from carom.results.assemble import ledger

        return ledger(self)

    @property
    def success(self) -> bool:
        """Whether the run reached its end, or an event that ends it, and kept the balance of energy."""
        return self.status in (Status.SUCCESS, Status.STOPPED)

    @property
    def message(self) -> str:
        """How the run ended, in a sentence; if it failed, with the time it reached."""
        if self.status.ended:
            from carom.results.accuracy import taken_whole

            why = self.warnings if self.status is Status.INACCURATE else ()
            if self._stopped_by:
                why = (f"That was {self._stopped_by} at t = {self.t[-1]:.9g} s.", *why)
            return " ".join((self.status.message, *why, *taken_whole(self.stats)))
        return f"{self.status.message} (reached t = {self.t[-1]:.9g} s)"

    @property
    def total_energy(self) -> np.ndarray:
        """Kinetic plus potential energy (T,) [J]."""
        return self.kinetic_energy + self.potential_energy

    @cached_property
    def _reactions(self) -> np.ndarray:
        from carom.results.assemble import element_reactions

        return element_reactions(self)

    @cached_property
    def joint_reactions(self) -> np.ndarray:
        """Force and torque (T, J, 6) of each joint on its child at its anchor, world axes [N], [N m].

        In the order of `Scene.joints`. Where redundant joints leave it open, the one of least norm, each row
        weighed by its own stiffness against motion (the diagonal of A M^-1 A^T).
        """
        from carom.results.assemble import joint_reactions

        return joint_reactions(self)

    @cached_property
    def constraint_forces(self) -> np.ndarray:
        """Multipliers (T, K) of the rows of `Scene.constraints`, in their order.

        Of a `Driver` the force [N] or torque [N m] of its motor along the coordinate; of a `Coupling` that
        which acts on each joint, divided by its factor; of `Rows` the factor of each row in the force.
        """
        from carom.results.assemble import constraint_forces

        return constraint_forces(self)

    def joint_coordinates(self, joint) -> tuple[np.ndarray, np.ndarray]:
        """Return (coordinates, rates), each (T, n), of a joint at saved times, worked out from the states.

        Of the child against the parent, positive along the directions of the definition (turns by
        the right-hand rule), 0 at the start. Directions turn with the parent; only `axis_child` with the child.

        ==================  ========================================================================
        Revolute            turn [rad]
        Prismatic           slide of the child's anchor [m]
        Cylindrical, Screw  turn, slide
        Universal           q1 about `axis_parent`, q2 about `axis_child`: in axes of the parent the child is
                            turned by R1(q1) R2(q2) since the start
        Planar              two slides, turn about the normal; slides along t1, the world axis least along
                            the normal (x before y before z) at the start made tangent, and normal x t1
        PointOnLine         slide
        PointOnPlane        two slides, as for Planar
        Distance            length [m] (not 0 at the start)
        Spherical           rotation vector [rad], angle in [0, pi], in the world axes of the start, fixed in
                            the parent; its rates are the relative angular velocity in the same axes
        Fixed, KnifeEdge,   none: n = 0
        rolling
        ==================  ========================================================================

        Turns are counted over the run by the mean of the rates between two saved times, which must
        not be wrong by half a turn: save often enough (`save_at`). At an impact the rate is that after it.

        Parameters
        ----------
        joint : Joint or str
            A joint of the scene, or its name.

        Raises
        ------
        KeyError
            If nothing in the scene is called so.
        TypeError, ValueError
            If it is no joint, or one of another scene.
        """
        from carom.results.joint_coordinates import joint_coordinates

        return joint_coordinates(self, joint)

    @cached_property
    def constraint_errors(self) -> tuple[np.ndarray, np.ndarray]:
        """How well joints and constraints are kept at saved times: position and velocity, (T, R) each.

        Absolute errors of the R rows of `constraint_rows`, which names them and their units (velocities: a
        second). The error of an angle does not count whole turns.
        """
        from carom.results.assemble import constraint_errors

        return constraint_errors(self)

    @cached_property
    def constraint_rows(self) -> ConstraintRows:
        """The R rows of joints and constraints that `constraint_errors` is of: columns `name` and `unit`.

        Units are "m" or "rad"; "" where factors of your own make it (`Rows`, a `Coupling` of turns and slides).
        """
        return constraint_rows(self.scene)

    def evaluate(self, t, side: str = "right"):
        """Return (position, orientation, velocity, angular_velocity) at times between saved ones.

        Exact for bodies on which only gravity acts, while they touch nothing. Else cubic in each interval
        between saved steps and events, so continuous except at impacts; error of order 4 in the saved interval
        for positions and orientations, of order 3 for velocities.

        Parameters
        ----------
        t : float or (n,)
            Times within the run [s].
        side : {"right", "left"}
            Which velocity at the time of an event: after it (default) or before it.

        Returns
        -------
        tuple of arrays
            (n, N, 3), (n, N, 4), (n, N, 3), (n, N, 3); without the first axis for a single time.

        Raises
        ------
        ValueError
            If a time is outside the run, or `side` is another word.
        """
        checks.choice("side", side, SIDES)
        times = checks.times("t", t, self.t[0], self.t[-1])
        known = zip(self._nodes, self._flights)
        bodies = [between(node, flies, times, side) for node, flies in known]
        x, Q, v, w = (np.stack(column, axis=1) for column in zip(*bodies))
        Q = quaternion.multiply(Q, quaternion.conjugate(self._run.to_principal))
        result = (x, Q, v, w)
        return tuple(a[0] for a in result) if np.ndim(t) == 0 else result

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
        """Forces of all points of contact that stay, as a table: for scenes with many contacts.

        `contact_mode` and `contact_force` have a place for each contact of `pairs` at each saved time.
        """
        return force_table(self._touch)

    @cached_property
    def _contact_sums(self) -> tuple[np.ndarray, np.ndarray]:
        from carom.results.assemble import contact_sums

        count = len(self.pairs.body) + len(self.scene.stops)
        return contact_sums(self._touch, len(self.t), count)

    @cached_property
    def _nodes(self):
        from carom.results.assemble import nodes

        return nodes(self._run)

    @cached_property
    def _flights(self):
        return flights(self)

    def impact_history(self, k: int, steps: int | None = None):
        """Return impact k resolved in time inside its boundary layer, a `LayerHistory`.

        Parameters
        ----------
        k : int
            Number of the impact.
        steps : int, optional
            Spline steps through the layer. Default: `Options.layer_steps`.

        Raises
        ------
        IndexError
            If there is no impact k.
        ValueError
            If impact k is a part of one of several points.
        """
        from carom.impact.history import impact_layer

        count, k = len(self.impacts), checks.integer("k", k)
        if not -count <= k < count:
            raise IndexError(f"k must be the number of an impact, got impact {k} of {count}")
        record = self.impacts[k]
        if record.together > 1:
            raise ValueError(
                f"impact {k} was resolved together with others ({record.together} closed points), and has "
                "no boundary layer of its own; look at one with impacts.together == 1"
            )
        contacts = self._run.compiled.system.contacts
        row = contacts[int(np.searchsorted(contacts.number, record.contact))]
        return impact_layer(
            record.inverse_mass, record.relative_velocity_before, record.friction,
            record.restitution, penetration=float(row.penetration), width=float(row.width),
            law=record.law,
            steps=self._run.options.layer_steps if steps is None else steps,
        )  # fmt: skip

    def __repr__(self) -> str:
        return (
            f"<Solution: {self.position.shape[1]} bodies, t = {self.t[0]:g} .. {self.t[-1]:g} s in "
            f"{len(self.t)} saved steps, {len(self.impacts)} impacts; {self.message}>"
        )
