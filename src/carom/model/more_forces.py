"""Forces along coordinates of joints, forces by curves, and forces of the user's functions, as arrays."""

from __future__ import annotations

from carom._compiled.composed import is_compiled, joined, once
from carom._compiled.record_arrays import table
from carom._compiled.user_functions import Functions
from carom.model.arrays import FRICTION, FRICTIONS, PUSH, PUSHES, USER_FORCE, USER_FORCES, Place
from carom.model.laws import LawTable
from carom.model.pieces import Pieces
from carom.scene.friction import bound_of
from carom.scene.more_forces import (
    Actuator,
    CurveSpring,
    JointForce,
    JointFriction,
    JointSpring,
    Law,
    UserForce,
)


class MoreForces:
    """The forces of a scene that are not linear springs, loads or mounts."""

    def __init__(
        self,
        scene,
        coordinates,
        functions: Functions,
        pieces: Pieces,
        friction_laws: LawTable,
        implicit: bool,
    ):
        self.pushes, self.forces, self.frictions, self.named = [], [], [], []
        self.width = 0
        self.laws: dict[int, Law] = {}  # of actuators, by the index of the force
        self.curves: dict[int, tuple[int, int]] = {}  # by the index of the force
        self.places: dict[int, Place] = {}
        for force in scene.forces:
            d = force.definition
            if isinstance(d, CurveSpring):
                self.curves[force.index] = pieces.add(d.tension)
            elif isinstance(d, Actuator):
                made = _actuator(force, coordinates, functions, self.laws, implicit)
                self._add(force, PUSHES, self.pushes, made)
            elif isinstance(d, JointForce) or (isinstance(d, JointSpring) and not implicit):
                self._add(force, PUSHES, self.pushes, _push(force, coordinates, functions))
            elif isinstance(d, JointFriction) and bound_of(d.bound) > 0.0:
                made = _friction(d, coordinates, friction_laws)
                self._add(force, FRICTIONS, self.frictions, made)
            elif isinstance(d, UserForce):
                self._add(force, USER_FORCES, self.forces, self._of_user(force, functions))

    def _add(self, force, kind: int, rows: list, made) -> None:
        self.places[force.index] = Place(kind, len(rows), len(rows) + 1)
        rows.append(made)

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


def _friction(d, coordinates, friction_laws: LawTable):
    made = table(FRICTION, 1)
    made.coordinate, made.law = (
        coordinates.number(d.joint, d.coordinate),
        friction_laws.add(d.bound),
    )
    return made


@once
def of_coordinate(function):
    """Return a function of (t, x), x = (q, q'), from a function of t, q and q'."""
    if not is_compiled(function):
        return lambda t, x: function(float(t), float(x[0]), float(x[1]))

    def call(t, x):
        return function(t, x[0], x[1])

    return joined(call, function)
