"""Every joint of the registry, made from the names of its arguments: what it keeps, and its coordinates."""

import inspect
import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

import carom
from carom.geometry.quaternion import matrix
from carom.scene.joints import JOINTS, Distance, KnifeEdge
from verified import agree, verifies

#: the child is a ball at (0, 0, 1) that turns with the parent, a plate at the origin, about the origin
CHILD, AXIS, TURN = np.array([0.0, 0.0, 1.0]), np.array([0.6, 0.0, 0.8]), (0.3, -0.2, 0.4)
ARGUMENTS = {
    "anchor": CHILD, "anchor_parent": (0, 0, 0), "anchor_child": CHILD, "axis": AXIS, "normal": (0, 0, 1),
    "direction": (1, 0, 0), "axis_parent": (1, 0, 0), "axis_child": (0, 1, 0), "pitch": 0.3, "radius": 1.0,
    "curve": carom.curves.Curve(lambda u: (u, 0.3 * math.sin(u), 1.2 - 0.2 * math.cos(u)), -4, 4),
}  # fmt: skip
#: of rails that can be left and of rods with limits, which lose energy where they strike
LOOSE = {"start", "side", "restitution", "friction", "impact_law", "lower", "upper"}


def joined(kind):
    """Two bodies in a common turn, with a joint of a kind, and a spring that moves what it leaves free."""
    scene = carom.Scene(gravity=(0, 0, 0))
    turns = kind is not KnifeEdge  # its parent is the ground
    pair = [
        scene.add_body(
            mass=m, inertia=i, position=x, velocity=np.cross(TURN, x) if turns else (0, 0, 0),
            angular_velocity=TURN if turns else (0, 0, 0),
        )
        for m, i, x in ((2.0, (0.4, 0.5, 0.6), np.zeros(3)), (1.0, (0.2, 0.3, 0.25), CHILD))
    ]  # fmt: skip
    names = inspect.signature(kind).parameters.keys() - LOOSE
    given = {name: ARGUMENTS[name] for name in names}
    if kind.__name__ == "RollingDisc":  # its axis is not that of the plane
        given["axis"] = (0, 1, 0)
    parent = pair[0] if turns else carom.GROUND
    joint = scene.add_joint(kind(**given), parent, pair[1])
    spring = carom.forces.Spring(
        20.0, anchor_parent=(0.4, 0.3, 0.1), anchor_child=CHILD + (0.2, -0.5, 0.3), rest_length=0.7
    )
    scene.add_force(spring, *pair)
    return scene, joint


def angle(axis, R):
    """Return the angle about an axis of matrices that turn about it."""
    across = np.linalg.svd(axis[None])[2][1]
    return np.arctan2(R @ across @ np.cross(axis, across), R @ across @ across)


def arc_length(point):
    """Return the arc length of the curve of the tests from its lowest point to the foot of another one."""
    u = 0.0
    for _ in range(30):  # (c - y) . c' = 0, by Gauss and Newton
        c = np.array([u, 0.3 * math.sin(u), 1.2 - 0.2 * math.cos(u)])
        slope = np.array([1.0, 0.3 * math.cos(u), 0.2 * math.sin(u)])
        u -= (c - point) @ slope / (slope @ slope)
    return quad(lambda v: math.hypot(1.0, 0.3 * math.cos(v), 0.2 * math.sin(v)), 0.0, u)[0]


def measured(joint, s):
    """Return the coordinates (T, n) of a joint from the attitudes as matrices, which are 1 at the start."""
    d, name = joint.definition, joint.kind
    Rp, Rc = (np.moveaxis(matrix(s.orientation), 1, 0)[k] for k in (0, -1))
    xp, xc = (s.position[:, k] for k in (0, -1))
    R, place = np.swapaxes(Rp, -1, -2) @ Rc, np.einsum("tji,tj->ti", Rp, xc - xp)
    first = next((getattr(d, a) for a in ("axis", "normal", "direction") if hasattr(d, a)), None)
    x, y, z = np.eye(3)
    if name == "Universal":
        one, other = R @ y, np.swapaxes(R, -1, -2) @ x
        return np.stack([np.arctan2(one @ z, one @ y), np.arctan2(other @ z, other @ x)], axis=1)
    if name == "Spherical":
        return Rotation.from_matrix(R).as_rotvec()
    if name == "Distance":
        return np.linalg.norm(place, axis=1)[:, None]
    if name == "PointOnCurve":
        return np.array([[arc_length(one)] for one in place])
    if (
        name == "CurveOnPoint"
    ):  # the point of the parent, in axes of the child from its place at the start
        back = np.einsum("tji,tj->ti", Rc, xp + Rp @ CHILD - xc) + CHILD
        return np.array([[arc_length(one)] for one in back])
    along = [x, y] if d.guide == "plane" else [first]
    slides = [(place - CHILD) @ one for one in along] if "slide" in d.coordinates else []
    turns = [angle(first, R)] if "turn" in d.coordinates else []
    return np.stack(slides + turns if d.guide == "plane" else turns + slides, axis=1)


@verifies(
    "joints.{kind.__name__}",
    "energy and both momenta are kept; coordinates are those of the attitudes",
    "invariant",
)
@pytest.mark.parametrize("kind", JOINTS, ids=lambda kind: kind.__name__)
def test_what_a_joint_keeps(kind):
    scene, joint = joined(kind)
    s = carom.simulate(scene, 0.5, step=5e-3, method="rk8")
    # The forces of a joint do no work, and are equal and opposite. Of order 8: h^8 is round-off.
    agree(s.total_energy, s.total_energy[0], atol=1e-11)
    if kind is not KnifeEdge:
        mass, R = np.array([b.mass for b in scene.bodies]), carom.geometry.quaternion
        inertia = np.array([b.inertia for b in scene.bodies])
        turn = R.matrix(s.orientation)
        spin = np.einsum("tnij,njk,tnlk,tnl->tni", turn, inertia, turn, s.angular_velocity)
        linear = mass[:, None] * s.velocity
        angular = spin + np.cross(s.position, linear)
        for momentum in (linear.sum(axis=1), angular.sum(axis=1)):
            agree(momentum, momentum[:1] + 0 * momentum, atol=1e-11)
    for error in s.constraint_errors:  # returned to round-off in each step
        assert np.max(error) < 1e-12
    # Coordinates are as many as are named, and their rates are their derivatives.
    q, rate = s.joint_coordinates(joint)
    if kind.coordinates:
        assert q.shape == (len(s.t), len(kind.coordinates))
        slope = (q[2:] - q[:-2]) / 0.01
        np.testing.assert_allclose(slope, rate[1:-1], rtol=0, atol=5e-3)  # h^2 q'''/6
    if q.size:  # curves are splines of their functions
        atol = 1e-6 if "Curve" in kind.__name__ else 1e-12
        agree(q, measured(joint, s), atol=atol)
        assert np.max(np.abs(q - q[0])) > (1e-3 if kind is not Distance else -1.0)
