"""Forces along coordinates of joints, forces by curves, and forces of the user's functions, as arrays."""

from __future__ import annotations

import math

import numpy as np

from carom._compiled.composed import is_compiled, joined, once
from carom._compiled.record_arrays import Columns, table
from carom._compiled.user_functions import Functions
from carom.model.arrays import FRICTION, PIECE, PUSH, USER_FORCE
from carom.model.thresholds import LAW_KINK
from carom.scene.friction import anisotropy_of, bound_of
from carom.scene.more_forces import (
    Actuator,
    CurveSpring,
    JointForce,
    JointFriction,
    JointSpring,
    Law,
    UserForce,
)
from carom.scene.speed_law import SpeedLaw, curve_of

DEGREE = 5
#: columns of a contact that say what its restitution is
RESTITUTION = (
    "restitution", "restitution_piece", "last_restitution_piece", "restitution_exponent",
)  # fmt: skip


def note_kinks(pieces: np.ndarray) -> None:
    """Write to the pieces of a law the places where a derivative jumps, the ends of a table among them.

    Beyond its pieces a law is constant. Jumps are those of the coefficients of both sides, by the least width.
    """
    width, c = pieces["end"] - pieces["start"], pieces["c"]
    after = np.vstack([c, np.zeros(DEGREE + 1)])
    before = np.zeros_like(after)
    for k in range(1, DEGREE + 1):
        for j in range(k, DEGREE + 1):
            before[1:, k] += math.comb(j, k) * c[:, j] * width ** (j - k)
    least = np.minimum(np.append(width, np.inf), np.insert(width, 0, np.inf))
    k = np.arange(1, DEGREE - 1)  # quintics have jumps above: two derivatives at each end are given
    jumps = np.max(np.abs(after - before)[:, k] * least[:, None] ** k, axis=1)
    places = np.append(pieces["start"], pieces["end"][-1])
    kinks = jumps > LAW_KINK * np.max(np.abs(c[:, 0]))
    pieces["kinks"][:, 0] = np.maximum.accumulate(np.where(kinks, places, -np.inf))[:-1]
    pieces["kinks"][:, 1] = np.minimum.accumulate(np.where(kinks, places, np.inf)[::-1])[::-1][1:]


class Pieces:
    """Pieces of all polynomials of a scene."""

    def __init__(self):
        self.rows = table(PIECE, 0)
        self.known: dict[tuple, tuple[int, int, float]] = {}  # laws of a speed

    def add(self, curve) -> tuple[int, int]:
        """Add a `scipy.interpolate.PPoly`; return the range of its pieces."""
        c, x = np.asarray(curve.c, dtype=float), np.asarray(curve.x, dtype=float)
        if c.ndim != 2 or len(c) > DEGREE + 1:
            raise ValueError(
                f"a polynomial in pieces must have one value and degree {DEGREE} at most, got coefficients of "
                f"shape {c.shape}"
            )
        pieces = table(PIECE, len(x) - 1)
        pieces.start, pieces.end = x[:-1], x[1:]
        pieces.c[:, : len(c)] = c[::-1].T
        first = len(self.rows)
        self.rows = np.concatenate([self.rows, pieces]).view(Columns)
        return first, len(self.rows)

    def add_law(self, law: float | SpeedLaw, length: float = 1.0) -> tuple[int, int, float]:
        """Return pieces and exponent of a row whose speeds are `length` times those of a law."""
        if not isinstance(law, SpeedLaw) or anisotropy_of(law) is not None:
            return 0, 0, 0.0
        if (law, length) not in self.known:
            curve = curve_of(law).scaled(length)
            first, last = self.add(curve)
            note_kinks(self.rows[first:last])
            self.known[law, length] = first, last, curve.exponent
        return self.known[law, length]

    def add_restitution(self, e: float | SpeedLaw, length: float = 1.0) -> tuple[float, ...]:
        """Return the values of `RESTITUTION` of such a row."""
        return np.nan if isinstance(e, SpeedLaw) else e, *self.add_law(e, length)


class MoreForces:
    """The forces of a scene that are not linear springs, loads or mounts."""

    def __init__(
        self,
        scene,
        coordinates,
        functions: Functions,
        pieces: tuple[Pieces, Pieces],
        implicit: bool,
    ):
        self.pushes, self.forces, self.frictions, self.named = [], [], [], []
        of_forces, of_frictions = pieces
        self.width = 0
        self.laws: dict[int, Law] = {}  # of actuators, by the index of the force
        self.curves: dict[int, tuple[int, int]] = {}  # by the index of the force
        for force in scene.forces:
            d = force.definition
            if isinstance(d, CurveSpring):
                self.curves[force.index] = of_forces.add(d.tension)
            elif isinstance(d, Actuator):
                self.pushes.append(_actuator(force, coordinates, functions, self.laws, implicit))
            elif isinstance(d, JointForce) or (isinstance(d, JointSpring) and not implicit):
                self.pushes.append(_push(force, coordinates, functions))
            elif isinstance(d, JointFriction) and bound_of(d.bound) > 0.0:
                self.frictions.append(_friction(d, coordinates, of_frictions))
            elif isinstance(d, UserForce):
                self.forces.append(self._of_user(force, functions))

    def _of_user(self, force, functions):
        d, name = force.definition, f"the force {force.name!r}"
        made, n = table(USER_FORCE, 1), len(d.bodies)
        made.address = functions.address(d.function, (n, 13), (n, 6), name)
        if d.potential is not None:
            potential = f"the potential of {name}"
            made.energy_address = functions.address(d.potential, (n, 13), (1,), potential)
        made.first = len(self.named)
        self.named += [b.index for b in d.bodies]
        made.last = len(self.named)
        self.width = max(self.width, 13 * n)
        return made

    @property
    def any(self) -> bool:
        """Whether there are any."""
        return bool(self.pushes or self.forces or self.frictions or self.curves)


def _push(force, coordinates, functions):
    d, made = force.definition, table(PUSH, 1)
    made.coordinate = coordinates.number(d.joint, d.coordinate)
    if isinstance(d, JointSpring):
        made.stiffness, made.damping, made.rest = d.stiffness, d.damping, d.rest
    elif callable(d.force):
        name = f"the force {force.name!r}"
        made.address = functions.address(of_coordinate(d.force), (2,), (1,), name)
    else:
        made.force = d.force
    return made


def _actuator(force, coordinates, functions, laws, implicit: bool):
    d, made = force.definition, table(PUSH, 1)
    made.coordinate, made.force = coordinates.number(d.joint, d.coordinate), d.constant(d.control)
    if d.law:
        laws[force.index] = law = Law(d)
        name = f"the force {force.name!r}"
        made.address = functions.address(of_coordinate(law), (2,), (1,), name)
    elif not (implicit and is_damped_spring(d)):
        made.stiffness, made.damping = d.spring
    return made


def is_damped_spring(d) -> bool:
    """Return whether an actuator has a spring and damper that an implicit step may take as a row."""
    return not d.law and min(d.spring) >= 0.0 and max(d.spring) > 0.0


def _friction(d, coordinates, pieces):
    made = table(FRICTION, 1)
    made.coordinate, made.bound = coordinates.number(d.joint, d.coordinate), bound_of(d.bound)
    made.piece, made.last_piece, made.exponent = pieces.add_law(d.bound)
    return made


@once
def of_coordinate(function):
    """Return a function of (t, x), x = (q, q'), from a function of t, q and q'."""
    if not is_compiled(function):
        return lambda t, x: function(float(t), float(x[0]), float(x[1]))

    def call(t, x):
        return function(t, x[0], x[1])

    return joined(call, function)
