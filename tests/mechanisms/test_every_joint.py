"""Every joint of the registry, made from the names of its arguments: what it keeps, and its coordinates."""

import inspect
import math

import numpy as np
import pytest

import carom
from carom.scene.joints import JOINTS, KnifeEdge

#: the child is a ball at (0, 0, 1) that turns with the parent, a plate at the origin, about the origin
CHILD, AXIS, TURN = np.array([0.0, 0.0, 1.0]), np.array([0.6, 0.0, 0.8]), (0.3, -0.2, 0.4)
ARGUMENTS = {
    "anchor": CHILD, "anchor_parent": (0, 0, 0), "anchor_child": CHILD, "axis": AXIS, "normal": (0, 0, 1),
    "direction": (1, 0, 0), "axis_parent": (1, 0, 0), "axis_child": (0, 1, 0), "pitch": 0.3, "radius": 1.0,
    "curve": carom.curves.Curve(lambda u: (u, 0.3 * math.sin(u), 1.2 - 0.2 * math.cos(u)), -4, 4),
}  # fmt: skip
#: of rails that can be left, which lose energy where they strike
LOOSE = {"start", "side", "restitution", "friction", "impact_law"}


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


@pytest.mark.parametrize("kind", JOINTS, ids=lambda kind: kind.__name__)
def test_what_a_joint_keeps(kind):
    scene, joint = joined(kind)
    s = carom.simulate(scene, 0.5, step=5e-3, method="rk8")
    # The forces of a joint do no work, and are equal and opposite. Of order 8: h^8 is round-off.
    np.testing.assert_allclose(s.total_energy, s.total_energy[0], rtol=0, atol=1e-11)
    if kind is not KnifeEdge:
        mass, R = np.array([b.mass for b in scene.bodies]), carom.geometry.quaternion
        inertia = np.array([b.inertia for b in scene.bodies])
        turn = R.matrix(s.orientation)
        spin = np.einsum("tnij,njk,tnlk,tnl->tni", turn, inertia, turn, s.angular_velocity)
        linear = mass[:, None] * s.velocity
        angular = spin + np.cross(s.position, linear)
        for momentum in (linear.sum(axis=1), angular.sum(axis=1)):
            np.testing.assert_allclose(momentum, momentum[:1] + 0 * momentum, rtol=0, atol=1e-11)
    for error in s.constraint_errors:  # returned to round-off in each step
        assert np.max(error) < 1e-12
    # Coordinates are as many as are named, and their rates are their derivatives.
    q, rate = s.joint_coordinates(joint)
    if kind.coordinates:
        assert q.shape == (len(s.t), len(kind.coordinates))
        slope = (q[2:] - q[:-2]) / 0.01
        np.testing.assert_allclose(slope, rate[1:-1], rtol=0, atol=5e-3)  # h^2 q'''/6
