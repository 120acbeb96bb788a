"""Forces along joint coordinates, springs with a characteristic curve, and user-defined forces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.scene.bodies import Body
from carom.scene.constraints import check_functions, coordinate_kind, distinct_bodies
from carom.scene.joints import Joint
from carom.scene.values import apart, keep


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class JointSpring:
    """A spring and damper along a coordinate of a joint: ``-stiffness (q - rest) - damping q'``.

    An angle includes whole turns (a clock spring). One coordinate may have several springs.

    Parameters
    ----------
    joint : Joint
    stiffness, damping : float
        For an angle [N m/rad] and [N m s/rad], for a displacement [N/m] and [N s/m]; at least 0. Default 0.
    rest : float
        Coordinate without spring force [rad or m]; at the start the coordinate is 0. Default 0.
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    """

    joint: Joint
    stiffness: float
    damping: float
    rest: float
    coordinate: int

    def __init__(
        self,
        joint: Joint,
        stiffness: float = 0.0,
        damping: float = 0.0,
        rest: float = 0.0,
        coordinate: int = 0,
    ):
        coordinate_kind(joint, coordinate)
        keep(
            self,
            joint=joint,
            stiffness=checks.number("stiffness", stiffness, least=0.0),
            damping=checks.number("damping", damping, least=0.0),
            rest=checks.number("rest", rest),
            coordinate=int(coordinate),
        )


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class JointForce:
    """A force or torque along a joint coordinate: it acts on the child, its opposite on the parent.

    Its work is in `ledger.loads`.

    Parameters
    ----------
    joint : Joint
    force : float or callable
        Force [N] along a displacement or torque [N m] about an angle: a number, or a function
        ``force(t, q, rate)`` of the time, the coordinate and its rate, plain Python or compiled with Numba.
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    """

    joint: Joint
    force: float | Callable
    coordinate: int

    def __init__(self, joint: Joint, force: float | Callable, coordinate: int = 0):
        coordinate_kind(joint, coordinate)
        given = force if callable(force) else checks.number("force", force)
        keep(self, joint=joint, force=given, coordinate=int(coordinate))


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class JointFriction:
    """Dry (Coulomb) friction along a joint coordinate: a force `bound` against the motion.

    A joint without motion sticks exactly while the force that keeps it at rest is at most `bound`. Changes
    between slip and stick are located within the step. The work of the friction is in `ledger.friction`.

    Parameters
    ----------
    joint : Joint
    bound : float
        Friction force [N] along a displacement or torque [N m] about an angle, at least 0.
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    """

    joint: Joint
    bound: float
    coordinate: int

    def __init__(self, joint: Joint, bound: float, coordinate: int = 0):
        coordinate_kind(joint, coordinate)
        bound = checks.number("bound", bound, least=0.0)
        keep(self, joint=joint, bound=bound, coordinate=int(coordinate))


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class JointInertia:
    """Inertia along a joint coordinate, with the kinetic energy ``inertia q'^2/2``.

    It models the rotor of a motor behind a gear: the moment of inertia of the rotor times the square of the
    gear ratio (in robotics: reflected inertia, armature). It has no mass and no weight, and exerts no
    gyroscopic torque on the bodies. One coordinate may have several.

    Parameters
    ----------
    joint : Joint
    inertia : float
        [kg m^2] for an angle, [kg] for a displacement; at least 0.
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    """

    joint: Joint
    inertia: float
    coordinate: int

    def __init__(self, joint: Joint, inertia: float, coordinate: int = 0):
        coordinate_kind(joint, coordinate)
        inertia = checks.number("inertia", inertia, least=0.0)
        keep(self, joint=joint, inertia=inertia, coordinate=int(coordinate))


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class CurveSpring:
    """A spring between a point of the parent and a point of the child, with a given characteristic curve.

    Parameters
    ----------
    anchor_parent, anchor_child : (3,)
        The two points, in the world at the start [m]; they must differ.
    tension : (2, n) array-like or scipy.interpolate.PPoly
        Force [N] that pulls the points together, as a function of their distance [m]: two rows (distances,
        tensions), interpolated by a monotone cubic (`scipy.interpolate.PchipInterpolator`); or a piecewise
        polynomial of degree 5 at most. The first and the last piece are extrapolated.
    damping : float
        Damping coefficient [N s/m], at least 0. Default 0.
    """

    anchor_parent: np.ndarray
    anchor_child: np.ndarray
    tension: object
    damping: float

    def __init__(
        self,
        anchor_parent: ArrayLike,
        anchor_child: ArrayLike,
        tension: ArrayLike,
        damping: float = 0.0,
    ):
        start, end, distance = apart(anchor_parent, anchor_child)
        if not distance > 0.0:
            raise ValueError(
                f"anchor_child must differ from anchor_parent, got {checks.shown(anchor_child)} for both"
            )
        keep(
            self,
            anchor_parent=start,
            anchor_child=end,
            tension=_curve(tension),
            damping=checks.number("damping", damping, least=0.0, unit="N s/m"),
        )


def _curve(given):
    if hasattr(given, "c") and hasattr(given, "x") and not isinstance(given, type):
        return given
    table = checks.finite_array("tension", given, (2, None))
    if table.shape[1] < 2 or not np.all(np.diff(table[0]) > 0.0):
        raise ValueError(
            f"tension must have two distances or more, each above the one before, got {checks.shown(given)}"
        )
    from scipy.interpolate import PchipInterpolator

    return PchipInterpolator(table[0], table[1])


@arguments.known
@dataclass(frozen=True, init=False, eq=False)
class UserForce:
    """User-defined forces and torques on any bodies.

    Parameters
    ----------
    bodies : sequence of Body
        The n bodies on which the forces act, each once.
    function : callable
        ``function(t, states) -> (n, 6)``: `states` (n, 13) has position, orientation (quaternion, scalar first,
        body to world), velocity and angular velocity of each body, world axes. The result has a force [N] and a
        torque about the mass centre [N m] for each body, world axes. Plain Python, or compiled with Numba,
        which is about 200 times faster.
    potential : callable, optional
        ``potential(t, states) -> float`` [J]; the forces are its negative gradient. If it is given, the energy
        of the forces is part of `potential_energy`; otherwise their work is in `ledger.loads`.
    """

    bodies: tuple[Body, ...]
    function: Callable
    potential: Callable | None

    def __init__(
        self, bodies: Body | Sequence[Body], function: Callable, potential: Callable | None = None
    ):
        bodies = distinct_bodies(bodies)
        check_functions(function, potential=potential)
        keep(self, bodies=bodies, function=function, potential=potential)
