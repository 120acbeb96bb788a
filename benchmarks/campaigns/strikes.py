"""Bodies on one joint that strike the ground: random kinds of joints, shapes, laws, friction and restitution.

A body with few freedoms has an inverse mass W of rank 1 or 2 where it touches: slip and approach stop together,
and friction may hold it wedged (mathematics page, §1.9). What must be: the run ends at its time, the ledger
closes, no line of it gains energy (but impacts by Newton's law), and no impulse is absurd.
"""

from __future__ import annotations

import numpy as np

import carom
from campaigns.case import Case
from carom import GROUND, joints

LAWS = ("newton", "poisson", "stronge")
KINDS = (
    "revolute", "prismatic", "cylindrical", "screw", "spherical", "universal", "planar", "point on line",
    "point on plane", "distance", "knife edge",
)  # fmt: skip
SHAPES = ("box", "sphere", "capsule", "convex")
DURATION, STEP = 0.4, 5e-3
SIZE = 0.1  # of the bodies, about [m]


def case(seed: int) -> Case:
    """Return strike number `seed`."""
    rng = np.random.default_rng([16, 2, seed])
    kind = KINDS[rng.integers(len(KINDS))]
    law = LAWS[rng.integers(3)]
    friction = float(rng.choice([0.0, rng.uniform(0.0, 0.5), rng.uniform(0.0, 2.0), 1.0, 5.0]))
    restitution = float(rng.choice([0.0, 0.5, 1.0, rng.uniform(), rng.uniform()]))
    form = SHAPES[rng.integers(len(SHAPES))]
    size = SIZE * float(rng.uniform(0.5, 1.5))
    s = carom.Scene(gravity=(0, 0, -9.81))
    floor = s.add_half_space((0, 0, 0), (0, 0, 1))
    centre = np.array([0.0, 0.0, size * rng.uniform(1.2, 3.0)])
    turn = rng.normal(size=4)
    body = s.add_body(
        _shape(form, size, rng), density=float(10.0 ** rng.uniform(1, 4)), position=centre,
        orientation=turn / np.linalg.norm(turn), name="body",
    )  # fmt: skip
    s.add_joint(_joint(kind, centre, size, rng), GROUND, body, name="joint")
    s.add_contact(body, floor, friction=friction, restitution=restitution, impact_law=law)
    label = {
        "kind": kind, "shape": form, "step": STEP, "impact_law": law, "friction": friction,
        "restitution": restitution,
    }  # fmt: skip
    return Case(s, DURATION, STEP, label)


def _shape(form: str, size: float, rng):
    part = rng.uniform(0.4, 1.0, 3)
    if form == "box":
        return carom.Box(*(size * part))
    if form == "sphere":
        return carom.Sphere(0.5 * size * part[0])
    if form == "capsule":
        return carom.Capsule(0.25 * size * part[0], size * part[1])
    points = rng.normal(size=(int(rng.integers(5, 10)), 3))
    return carom.Convex(0.5 * size * points / np.linalg.norm(points, axis=1)[:, None])


def _joint(kind: str, centre, size: float, rng):
    """Return a joint of the body at `centre` with the ground; axes of round angles now and then."""
    axis = rng.normal(size=3)
    if rng.random() < 0.3:
        a = np.radians(rng.choice([15.0, 30.0, 45.0, 60.0, 75.0, 89.0]))
        axis = np.array([np.sin(a), 0.0, np.cos(a)])
    if kind == "revolute" and rng.random() < 0.5:
        axis[2] = 0.0  # it falls
    axis /= np.linalg.norm(axis)
    near = centre + size * rng.uniform(-1.0, 1.0, 3)
    across = np.cross(axis, rng.normal(size=3))
    across /= np.linalg.norm(across)
    if kind == "revolute":
        return joints.Revolute(near, axis)
    if kind == "prismatic":
        return joints.Prismatic(axis)
    if kind == "cylindrical":
        return joints.Cylindrical(near, axis)
    if kind == "screw":
        return joints.Screw(
            near, axis, float(rng.choice([-1.0, 1.0]) * size * rng.uniform(0.1, 3.0))
        )
    if kind == "spherical":
        return joints.Spherical(near)
    if kind == "universal":
        return joints.Universal(near, axis, across)
    if kind == "planar":
        return joints.Planar(axis)
    if kind == "point on line":
        return joints.PointOnLine(near, axis)
    if kind == "point on plane":
        return joints.PointOnPlane(near, axis)
    if kind == "distance":
        return joints.Distance(near + 3.0 * size * axis, near)
    return joints.KnifeEdge(near, axis, across)
