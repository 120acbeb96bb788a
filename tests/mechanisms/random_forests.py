"""Random forests of joints, with velocities that fit them."""

import numpy as np
from scipy.spatial.transform import Rotation

from carom import GROUND, Scene, joints

KINDS = ("Revolute", "Spherical", "Fixed", "Prismatic")
MORE = ("Cylindrical", "Universal", "Planar", "PointOnLine", "PointOnPlane", "Screw")
PITCH = 0.7


def unit(rng):
    e = rng.normal(size=3)
    return e / np.linalg.norm(e)


def second(axis):
    """A direction across an axis."""
    e = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    return e / np.linalg.norm(e)


def free_motion(kind, axis, rng):
    """Draw the angular and linear velocity that one of MORE leaves free."""
    turn, slide = rng.normal(size=3), rng.normal(size=3)
    along, across = slide @ axis * axis, slide - slide @ axis * axis
    about, b = turn @ axis * axis, second(axis)
    return {
        "Cylindrical": (about, along),
        "Universal": (about + turn @ b * b, 0.0),
        "Planar": (about, across),
        "PointOnLine": (turn, along),
        "PointOnPlane": (turn, across),
        "Screw": (about, PITCH / (2.0 * np.pi) * about),
    }[kind]


def where(kind, anchor, axis):
    """Arguments of the definition of a joint."""
    if kind == "Universal":
        return dict(anchor=anchor, axis_parent=axis, axis_child=second(axis))
    name = {"Planar": "normal", "PointOnPlane": "normal", "PointOnLine": "direction"}
    out = dict(anchor=anchor)
    if kind not in ("Spherical", "Fixed"):
        out[name.get(kind, "axis")] = axis
    if kind == "Screw":
        out["pitch"] = PITCH
    return out


def plan(rng, count, floating=0.2, kinds=KINDS, each=False):
    """Draw a forest: for each body its parent (-1 ground, None floating), joint, pose and inertia.

    Joints are drawn from `kinds`, or those of `kinds` `each` in turn. Positions and velocities
    are those of the whole, by rigid motion from parent to child.
    """
    rows, motion = [], []
    for k in range(count):
        parent = None if rng.random() < floating else int(rng.integers(-1, k))
        kind = kinds[rng.integers(len(kinds))] if not each else kinds[k]
        x, anchor, axis = rng.normal(size=3), rng.normal(size=3), unit(rng)
        if parent is None:
            v, w = rng.normal(size=3), rng.normal(size=3)
        else:
            xp, vp, wp = motion[parent] if parent >= 0 else np.zeros((3, 3))
            if kind in MORE:
                turn, slide = free_motion(kind, axis, rng)
            else:
                slide, turn = 0.0, {
                    "Revolute": rng.normal() * axis,
                    "Spherical": rng.normal(size=3),
                    "Fixed": np.zeros(3),
                    "Prismatic": np.zeros(3),
                }[kind]  # fmt: skip
            w = wp + turn
            v = slide + vp + np.cross(wp, anchor - xp) + np.cross(w, x - anchor)
            if kind == "Prismatic":
                v = v + rng.normal() * axis
        motion.append((x, v, w))
        a, b = rng.uniform(0.3, 1.0, 2)
        turn = Rotation.random(random_state=rng).as_matrix()
        inertia = turn @ np.diag([a, b, rng.uniform(1.01 * abs(a - b), a + b)]) @ turn.T
        q = np.roll(Rotation.random(random_state=rng).as_quat(), 1)
        rows.append(
            dict(
                name=f"b{k}", parent=parent, kind=kind, anchor=anchor, axis=axis,
                mass=rng.uniform(0.5, 2.0), inertia=0.5 * (inertia + inertia.T), position=x,
                orientation=q, velocity=v, angular_velocity=w,
            )
        )  # fmt: skip
    return rows


def build(rows, *, gravity=(0.3, -0.2, -9.81), bodies=None, edges=None, flips=(), turn=None):
    """Return the scene of a plan; bodies and joints may be added in any order, joints flipped.

    `turn` (a matrix) turns the whole world.
    """
    R = np.eye(3) if turn is None else turn
    scene = Scene(gravity=R @ gravity)
    for k in range(len(rows)) if bodies is None else bodies:
        row = rows[k]
        q = (
            Rotation.from_matrix(R) * Rotation.from_quat(np.roll(row["orientation"], -1))
        ).as_quat()
        scene.add_body(
            name=row["name"], mass=row["mass"], inertia=row["inertia"], orientation=np.roll(q, 1),
            **{key: R @ row[key] for key in ("position", "velocity", "angular_velocity")},
        )  # fmt: skip
    for k in range(len(rows)) if edges is None else edges:
        row = rows[k]
        if row["parent"] is None:
            continue
        make = getattr(joints, row["kind"])
        arguments = where(row["kind"], R @ row["anchor"], R @ row["axis"])
        parent = GROUND if row["parent"] < 0 else scene[f"b{row['parent']}"]
        pair = (parent, scene[row["name"]])
        if k in flips and row["parent"] >= 0:
            pair = pair[::-1]
            if row["kind"] == "Universal":  # the same axes in the same bodies
                first, other = arguments["axis_parent"], arguments["axis_child"]
                arguments.update(axis_parent=other, axis_child=first)
        scene.add_joint(make(**arguments), *pair, name=f"j{k}")
    return scene


def with_loop(scene):
    """Add a pendulum far away on a rod without mass: it takes the scene out of the tree back end."""
    x = np.array([50.0, 0.0, 0.0])
    bob = scene.add_body(mass=1.0, inertia=[1, 1, 1], position=x, name="far")
    scene.add_joint(joints.Distance(x + [0, 0, 1], x), GROUND, bob, name="rod")
    return scene
