"""What forces are reported to exert, and coordinates of joints, against what a run has done."""

import math

import numpy as np
import pytest

import carom
from carom import GROUND, forces, joints
from carom.geometry import quaternion
from carom.scene.forces import FORCES

G = np.array([0.3, -0.2, -9.81])
ENDS = dict(anchor_parent=(0.1, 0.3, 0.1), anchor_child=(1.2, -0.5, 0.3))
CURVE = [[0.1, 1.0, 2.0, 5.0], [-3.0, 0.0, 4.0, 30.0]]
MOUNT = dict(damping=(1.0, 2.0), turn_stiffness=(3.0, 4.0), turn_damping=(0.1, 0.2))
SERVO = dict(gain=2.0, bias=(0.1, -1.0, -0.2), gear=1.5, control=0.4)


def of_user(t, states):
    """Return forces and torques that do not balance."""
    out = np.zeros((2, 6))
    out[0, :3] = 0.7 * (states[1, :3] - states[0, :3])
    out[1, :3] = -0.4 * states[1, 7:10] + math.sin(9.0 * t)
    out[:, 3:] = -0.1 * states[::-1, 10:]
    return out


#: of two bodies, or on one
FREE = {
    "spring": (forces.Spring(20.0, **ENDS, rest_length=0.7, damping=0.4), 2),
    "curve": (forces.CurveSpring(**ENDS, tension=CURVE, damping=0.2), 2),
    "force": (forces.Force((0.5, 0.2, 9.0), anchor=(1.2, 1.0, 0.0)), 1),
    "thrust": (forces.Force((0.5, 0.2, 3.0), anchor=(1.2, 1.0, 0.0), follow=True), 1),
    "torque": (forces.Torque((0.1, 0.2, 0.3)), 2),
    "turning torque": (forces.Torque((0.1, 0.2, 0.3), follow=True), 2),
    "mount": (forces.Bushing((30.0, 20.0), anchor=(0.5, 0.4, 0.2), axis=(1, 0, 1), **MOUNT), 2),
    "user": (lambda pair: forces.UserForce(pair, of_user), 0),
    "drag": (forces.Drag(30.0, coefficient=0.5, area=0.2), 1),
    "wind": (forces.Wind((1.0, -2.0, 0.5), 30.0, coefficient=0.5, area=0.2), 1),
    "field": (forces.Wind(lambda t, x: x - t, 30.0, coefficient=0.5, area=0.2), 1),
    "lift": (forces.Magnus(30.0, radius=0.3, velocity=(1.0, 2.0, 0.0)), 1),
    "buoyancy": (forces.Buoyancy(volume=2e-3), 1),
}
#: along a coordinate of a joint
ALONG = {
    "spring": lambda j, k: forces.JointSpring(j, 4.0, 0.1, 0.2, k),
    "servo": lambda j, k: forces.Actuator(j, **SERVO, coordinate=k),
    "position servo": lambda j, k: forces.PositionServo(
        j, 3.0, 0.2, limit=0.4, target=1.0, coordinate=k
    ),
    "velocity servo": lambda j, k: forces.VelocityServo(
        j, 0.4, limit=0.4, target=1.0, no_load=9.0, coordinate=k
    ),
    "saturated": lambda j, k: forces.Actuator(j, **SERVO, force_range=(-0.1, 0.5), coordinate=k),
    "number": lambda j, k: forces.JointForce(j, 0.7, k),
    "function": lambda j, k: forces.JointForce(j, lambda t, q, u: 0.5 - 0.3 * q - u + t, k),
    "friction": lambda j, k: forces.JointFriction(j, 0.05, k),
    "law": lambda j, k: forces.JointFriction(j, carom.Friction(0.08, 0.05, 0.3), k),
    "drive": lambda j, k: forces.Drive(j, 0.05, k, rate=0.4),
    "drive by a motion": lambda j, k: forces.Drive(j, 0.05, k, motion=lambda t: (t, 1.0 + t, 1.0)),
    "inertia": lambda j, k: forces.JointInertia(j, 0.02, k),
    "strand": lambda j, k: forces.BeltStrand(j, 0.3, 4.0, 0.1, k),
}


def bodies(scene, moves=0.0):
    """Return two bodies whose inertias are not diagonal, at rest or with velocities."""
    turn = quaternion.matrix(quaternion.exp(np.array([0.3, -0.5, 0.8])))
    moments = (0.2, 0.3, 0.25), (0.1, 0.15, 0.2)
    return [
        scene.add_body(
            mass=2.0 - k, inertia=turn @ np.diag(moments[k]) @ turn.T, position=(k, 0.2 * k, 0.1),
            orientation=quaternion.exp(np.array([0.1, 0.7 * k, 0.2])),
            velocity=(0, moves * k, 0.5 * moves), angular_velocity=(moves, 2.0 * moves * k, moves),
        )
        for k in range(2)
    ]  # fmt: skip


def wrenches(s):
    """Return the wrench (T, N, 6) that each body needs beside gravity, about its mass centre."""
    a, w = s._accelerations, s.angular_velocity
    turn, scene = quaternion.matrix(s.orientation), s.scene
    inertia = turn @ np.array([b.inertia for b in scene.bodies]) @ np.swapaxes(turn, -1, -2)
    spin, change = (np.einsum("tnij,tnj->tni", inertia, x) for x in (w, a[..., 3:]))
    mass = np.array([b.mass for b in scene.bodies])[:, None]
    return np.concatenate([mass * (a[..., :3] - G), change + np.cross(w, spin)], axis=-1)


def arm(s, body, point):
    """Return the arm (T, 3) from the centre of a body to a point of it, given in the world at the start."""
    local = quaternion.rotate_back(body.orientation, np.asarray(point) - body.position)
    return quaternion.rotate(s.orientation[:, body.index], local)


@pytest.mark.parametrize("name", FREE)
def test_a_force_is_what_moves_the_bodies(name):
    definition, count = FREE[name]
    scene = carom.Scene(gravity=G)
    pair = bodies(scene, 1.0)
    given = definition(pair) if count == 0 else definition
    scene.add_force(given, *pair[2 - count :] if count else (), name="one")
    s = carom.simulate(scene, 0.2, step=0.02)
    found, needs = s["one"], wrenches(s)
    twist = np.concatenate([s.velocity, s.angular_velocity], axis=-1)
    # The sum of what acts on all bodies gives them the power.
    np.testing.assert_allclose(found.power, np.sum(needs * twist, axis=(1, 2)), atol=1e-12)
    assert np.ptp(found.power) > 1e-3
    if count == 0:
        np.testing.assert_allclose(found.force, needs[..., :3], atol=1e-12)
        np.testing.assert_allclose(found.torque, needs[..., 3:], atol=1e-12)
        return
    anchor = getattr(given, "anchor_child", getattr(given, "anchor", None))
    at = pair[1].position if anchor is None else anchor
    moment = found.torque + np.cross(arm(s, pair[1], at), found.force)
    np.testing.assert_allclose(found.force, needs[:, 1, :3], atol=1e-12)
    np.testing.assert_allclose(moment, needs[:, 1, 3:], atol=1e-12)
    if hasattr(given, "anchor_parent"):
        ends = [s.position[:, b.index] + arm(s, b, p) for b, p in zip(pair, ENDS.values())]
        gap = ends[1] - ends[0]
        np.testing.assert_allclose(found.length, np.linalg.norm(gap, axis=1), atol=1e-12)
        pull = -found.tension[:, None] * gap / found.length[:, None]
        np.testing.assert_allclose(pull, found.force, atol=1e-12)
        slope = (found.length[2:] - found.length[:-2]) / 0.04  # h^2 d'''/6
        np.testing.assert_allclose(found.length_rate[1:-1], slope, atol=0.05)


@pytest.mark.parametrize("kind", ["turn", "slide", "cross"])
@pytest.mark.parametrize("name", ALONG)
def test_a_force_along_a_coordinate_is_what_moves_it(name, kind):
    """On the ground, where the reaction of the joint is the only other force."""
    scene = carom.Scene(gravity=G)
    child, k = bodies(scene)[1], 0
    if kind == "cross":
        at, k = np.array([0.7, 0.3, 0.1]), 1
        joint = scene.add_joint(joints.Universal(at, (1, 0, 0), (0, 1, 0)), GROUND, child)
    else:
        at, axis = (0.2, 0, 0), (0.6, 0, 0.8)
        slide = joints.Prismatic(axis, anchor=at)
        made = joints.Revolute(at, axis) if kind == "turn" else slide
        joint = scene.add_joint(made, GROUND, child)
    scene.add_force(ALONG[name](joint, k), name="one")
    s = carom.simulate(scene, 0.2, step=0.02)
    found, needs, motion = s["one"], wrenches(s)[:, 1], s._reports.motion(joint, s._saved, k)
    if name == "inertia":
        acts = getattr(found, "force" if kind == "slide" else "torque")
        assert np.isnan(acts).all()
        assert np.isnan(found.power).all()
        return
    reaction, axis = s.joint_reactions[:, 0], motion.along[:, 0]
    force = np.zeros((len(s.t), 6))
    value = getattr(found, "force" if kind == "slide" else "torque")
    force[:, slice(3) if kind == "slide" else slice(3, 6)] = value[:, None] * axis
    force += reaction
    force[:, 3:] += np.cross(arm(s, child, at), force[:, :3])  # both act at the anchor
    np.testing.assert_allclose(force, needs, atol=1e-12)
    np.testing.assert_allclose(found.power, value * motion.rate[:, 0], atol=1e-12)
    assert np.max(np.abs(value)) > 1e-3


def test_each_kind_of_force_is_tried():
    pair = bodies(scene := carom.Scene())
    joint = scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, pair[0])
    tried = {type(one(pair) if n == 0 else one) for one, n in FREE.values()}
    tried |= {type(make(joint, 0)) for make in ALONG.values()}
    assert tried == set(FORCES) - {forces.ModalSpring}  # `tests/flexible`: it acts on no point
