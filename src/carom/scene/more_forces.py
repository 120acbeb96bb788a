"""Forces along coordinates of joints, springs with a curve, and forces by functions of the user's."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom import checks
from carom.scene.bodies import Body
from carom.scene.constraints import check_functions, coordinate_kind, distinct_bodies
from carom.scene.joints import Joint
from carom.scene.values import apart, keep


@dataclass(frozen=True, init=False, eq=False)
class JointSpring:
    """A spring and damper along a coordinate of a joint: ``-stiffness (q - rest) - damping q'``.

    An angle counts whole turns (a clock spring). On one coordinate there may be several.

    Parameters
    ----------
    joint : Joint
    stiffness, damping : float
        [N m/rad] and [N m s/rad] of a turn, [N/m] and [N s/m] of a slide, at least 0. Default 0.
    rest : float
        Where it is relaxed [rad or m]; the coordinate is 0 as the joint stands at the start. Default 0.
    coordinate : int
        Which coordinate of the joint. Default 0.
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


@dataclass(frozen=True, init=False, eq=False)
class JointForce:
    """A force or torque along a coordinate of a joint, on the child, its opposite on the parent.

    Parameters
    ----------
    joint : Joint
    force : float or callable
        [N] of a slide, [N m] of a turn: a number, or a function ``force(t, q, rate)`` of the time, the
        coordinate and its rate, plain Python or compiled with Numba. Its work goes to `ledger.loads`.
    coordinate : int
        Which coordinate of the joint. Default 0.
    """

    joint: Joint
    force: float | Callable
    coordinate: int

    def __init__(self, joint: Joint, force: float | Callable, coordinate: int = 0):
        coordinate_kind(joint, coordinate)
        given = force if callable(force) else checks.number("force", force)
        keep(self, joint=joint, force=given, coordinate=int(coordinate))


@dataclass(frozen=True, init=False, eq=False)
class JointFriction:
    """Dry (Coulomb) friction along a coordinate of a joint: up to `bound`, against the motion.

    Where there is no motion it is what keeps it so, as long as that is within the bound: the joint sticks,
    exactly. Slip that stops and stick that breaks are located within the step. Its work goes to
    `ledger.friction`.

    Parameters
    ----------
    joint : Joint
    bound : float
        [N] of a slide, [N m] of a turn, at least 0.
    coordinate : int
        Which coordinate of the joint. Default 0.
    """

    joint: Joint
    bound: float
    coordinate: int

    def __init__(self, joint: Joint, bound: float, coordinate: int = 0):
        coordinate_kind(joint, coordinate)
        bound = checks.number("bound", bound, least=0.0)
        keep(self, joint=joint, bound=bound, coordinate=int(coordinate))


@dataclass(frozen=True, init=False, eq=False)
class JointInertia:
    """Inertia along a coordinate of a joint: a part ``inertia q'^2/2`` of the kinetic energy.

    The rotor of a motor that turns fast behind a gear, as the joint feels it: its moment of inertia times the
    square of the ratio (robotics: reflected inertia, armature). It has no mass and no weight, and no gyroscopic
    torque on the bodies. On one coordinate there may be several.

    Parameters
    ----------
    joint : Joint
    inertia : float
        [kg m^2] of a turn, [kg] of a slide, at least 0.
    coordinate : int
        Which coordinate of the joint. Default 0.
    """

    joint: Joint
    inertia: float
    coordinate: int

    def __init__(self, joint: Joint, inertia: float, coordinate: int = 0):
        coordinate_kind(joint, coordinate)
        inertia = checks.number("inertia", inertia, least=0.0)
        keep(self, joint=joint, inertia=inertia, coordinate=int(coordinate))


@dataclass(frozen=True, init=False, eq=False)
class CurveSpring:
    """A spring on the line between a point of the parent and one of the child, with a curve of your own.

    Parameters
    ----------
    anchor_parent, anchor_child : (3,)
        The two points, in the world at the start [m]; they must differ.
    tension : (2, n) array-like or scipy.interpolate.PPoly
        With which it pulls the points together [N], over their distance [m]: rows (distances, tensions) of
        points of a curve, joined by a monotone cubic (`scipy.interpolate.PchipInterpolator`); or a polynomial
        in pieces of degree 5 at most. Beyond the ends the last piece goes on.
    damping : float
        [N s/m], at least 0. Default 0.
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


@dataclass(frozen=True, init=False, eq=False)
class UserForce:
    """Forces and torques by a function of your own, on any bodies.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies, n of them, each once.
    function : callable
        ``function(t, states) -> (n, 6)``: `states` (n, 13) has position, orientation (quaternion, scalar first,
        body to world), velocity and angular velocity of each body, world axes; the result a force [N] and a
        torque about the mass centre [N m] for each, world axes. Plain Python, or compiled with Numba, which is
        some 200 times faster.
    potential : callable, optional
        ``potential(t, states) -> float`` [J], of which the forces are the negative gradient. Where it is given
        the energy of the forces is part of `potential_energy`; else their work goes to `ledger.loads`.
    """

    bodies: tuple[Body, ...]
    function: Callable
    potential: Callable | None

    def __init__(
        self,
        bodies: Body | Sequence[Body],
        function: Callable,
        potential: Callable | None = None,
    ):
        bodies = distinct_bodies(bodies)
        check_functions(function, potential=potential)
        keep(self, bodies=bodies, function=function, potential=potential)
