"""Points on curves: closed and open, sharp, crossing themselves, fixed or moving, with what acts along them."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import draw
from campaigns.case import Case
from carom.geometry import quaternion

#: distance from the curve, by its size; difference of the coordinate and its rates, by the length of the curve
ON_CURVE, JUMP = 1e-9, 0.05


def case(seed: int) -> Case:
    """Return rail number `seed`: a third of the curves belong to moving bodies, a third to the child."""
    rng = np.random.default_rng([16, seed])
    step = draw.STEPS[seed % 3]
    closed, moving, slot = rng.random(3) < (0.6, 0.4, 0.3)
    curve, kind = _curve(rng, bool(closed))
    scene, start = carom.Scene(gravity=(0, 0, -9.81)), rng.uniform(0.2, 0.8) * curve.length
    point, along = curve.point(start), curve.tangent(start)
    speed = rng.choice((0.0, 1.0, 10.0)) * rng.normal()
    parent = carom.GROUND
    if moving:
        middle = curve.ends[:, 0].mean(axis=0)
        parent = scene.add_body(
            mass=10.0 ** rng.uniform(-1, 1), inertia=rng.uniform(0.5, 0.8, 3), position=middle
        )
        scene.add_force(
            carom.forces.Spring(50.0, anchor_parent=middle + (0, 0, 2), anchor_child=middle),
            carom.GROUND,
            parent,
        )
    if slot:
        child = scene.add_body(
            mass=10.0 ** rng.uniform(-1, 1), inertia=rng.uniform(0.5, 0.8, 3), velocity=-speed * along,
            position=point + 0.3 * rng.normal(size=3),
        )  # fmt: skip
        joint = carom.joints.CurveOnPoint(curve, anchor=point)
    else:
        shape = draw.shape(draw.SHAPES[rng.integers(len(draw.SHAPES))], 0.1, rng)
        child = scene.add_body(
            shape, mass=10.0 ** rng.uniform(-1, 1), orientation=draw.attitude(rng), velocity=speed * along,
            position=point + rng.choice((0.0, 0.05)) * rng.normal(size=3),
        )  # fmt: skip
        joint = carom.joints.PointOnCurve(curve, anchor=point)
    rail = scene.add_joint(joint, parent, child, name="rail")
    loads = _loads(scene, rail, curve, start, rng)
    label = {"kind": kind, "step": step, "loads": loads, "moving": bool(moving), "slot": bool(slot)}
    return Case(scene, 1.0, step, label, lambda s: _off(s, curve, bool(slot)))


def _curve(rng, closed: bool):
    """Return a curve of some metres, and its kind."""
    if closed and rng.random() < 0.5:
        a, b, c = rng.uniform(0.3, 1.0, 3)
        n, m = (int(k) for k in rng.integers(1, 4, 2))
        phase = rng.uniform(0, 6)
        return carom.curves.Curve(
            lambda u: (a * np.cos(n * u), b * np.sin(m * u), c * np.sin(u + phase)), 0, 2 * np.pi, closed=True
        ), "function"  # fmt: skip
    points = rng.normal(size=(int(rng.integers(4, 10)), 3))
    if rng.random() < 0.3:
        points[:, rng.integers(3)] *= 0.02  # nearly in a plane: it crosses itself, or nearly
    return carom.curves.Spline(points, closed=closed), "closed spline" if closed else "open spline"


def _loads(scene, rail, curve, start: float, rng) -> list[str]:
    """Add what acts along the curve; an open one has stops at its ends."""
    which = []
    if not curve.closed:
        e = rng.uniform(0, 1)
        scene.add_stop(rail, lower=-start, restitution=e)
        scene.add_stop(rail, upper=curve.length - start, restitution=e)
    if rng.random() < 0.3:
        which.append("JointFriction")
        scene.add_force(carom.forces.JointFriction(rail, 10.0 ** rng.uniform(-2, 1)))
    if rng.random() < 0.3:
        which.append("JointSpring")
        scene.add_force(
            carom.forces.JointSpring(rail, 10.0 ** rng.uniform(0, 2), damping=rng.uniform(0, 1))
        )
    elif curve.closed and rng.random() < 0.2:
        which.append("JointForce")
        scene.add_force(carom.forces.JointForce(rail, rng.normal()))
    return which


def _off(s: carom.Solution, curve, slot: bool) -> float:
    """Return how far the point is from its curve, or its coordinate from its rates, by what is allowed."""
    joint = s.scene["rail"]
    owner, other = (joint.child, joint.parent) if slot else (joint.parent, joint.child)
    anchor = np.broadcast_to(joint.definition.anchor, (len(s.t), 3))
    if other.index >= 0:
        local = quaternion.rotate_back(other.orientation, joint.definition.anchor - other.position)
        anchor = s.position[:, other.index] + quaternion.rotate(
            s.orientation[:, other.index], local
        )
    if owner.index >= 0:
        turn = quaternion.multiply(
            s.orientation[:, owner.index], quaternion.conjugate(owner.orientation)
        )
        anchor = owner.position + quaternion.rotate_back(turn, anchor - s.position[:, owner.index])
    q, rate = s["rail"].coordinate, s["rail"].rate
    place = curve.point(q + curve.nearest(joint.definition.anchor))
    size = np.ptp(curve.ends[:, 0], axis=0).max()
    away = np.max(np.linalg.norm(anchor - place, axis=1)) / size / ON_CURVE
    if len(s.impacts):
        return float(away)
    jumps = np.diff(q) - 0.5 * (rate[1:] + rate[:-1]) * np.diff(s.t)
    return float(max(away, np.max(np.abs(jumps), initial=0.0) / (JUMP * curve.length)))
