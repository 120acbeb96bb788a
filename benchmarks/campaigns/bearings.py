"""Bearings with play: a pin in a ring of boxes, which it touches one, two or none at a time."""

from __future__ import annotations

import numpy as np

import carom
from campaigns.case import Case
from carom import GROUND, joints
from carom.geometry import quaternion

RADIUS, WALL = 0.01, 0.005
Y = np.array([0.0, 1.0, 0.0])
#: of the play: how far the pin may be beyond a corner of the ring
BEYOND = 1e-3


def case(seed: int) -> Case:
    """Return case number `seed`: a loose pin, or that of an arm, in a ring that stands or that turns."""
    rng = np.random.default_rng([11, seed])
    kind = str(rng.choice(["pin", "planar", "free", "moving"]))
    count, play = int(rng.choice([12, 24, 48])), float(rng.choice([1e-4, 5e-4, 1e-3]))
    mu, e = float(rng.choice([0.0, 0.1, 0.3, 0.5])), float(rng.choice([0.0, 0.3, 0.8]))
    g, long = float(rng.choice([0.0, 9.81, 9.81])), rng.random() < 0.5
    start = (
        float(rng.uniform(5, 170)),
        float(rng.choice([0, 2, 10, -5])),
        float(rng.choice([0, 0.2])),
    )
    scene, turning = carom.Scene(gravity=(0, 0, -g)), None
    pin = arm(scene, kind, play, 0.02 if long else 0.01, *start)
    boxes = ring(count, play, 0.01 if long else 0.03, float(rng.uniform(0.0, 0.2)))
    if kind != "free":
        normal = joints.Planar(normal=Y, anchor=tuple(pin.position))
        scene.add_joint(normal, GROUND, pin)
    if kind == "moving":
        shape = carom.Compound(boxes)
        turning = scene.add_body(shape, mass=0.5, position=shape.centroid)
        scene.add_joint(joints.Revolute((0, 0, 0.1), Y), GROUND, turning)
        scene.add_contact(pin, turning, restitution=e, friction=mu)
    else:
        for shape, place, turn in boxes:
            wall = scene.add_static(shape, position=place, orientation=turn)
            scene.add_contact(pin, wall, restitution=e, friction=mu)
    corner = (RADIUS + play) / np.cos(np.pi / count) - RADIUS

    def off(s: carom.Solution) -> float:
        """Return how far the axis of the pin is from that of the ring, by the way to a corner."""
        far = axis(s, 0, pin) - (axis(s, 1, turning) if kind == "moving" else 0.0)
        return float(np.max(np.hypot(far[:, 0], far[:, 2]))) / (corner + BEYOND * play)

    label = {
        "kind": kind,
        "count": count,
        "play": play,
        "friction": mu,
        "restitution": e,
        "gravity": g,
    }
    return Case(scene, 1.0, 5e-3, label, off if kind != "free" else None)


def axis(s: carom.Solution, b: int, body) -> np.ndarray:
    """Return where the origin of a compound has got to (T, 3)."""
    c = getattr(body.shape, "centroid", np.zeros(3))
    return s.position[:, b] - quaternion.rotate(s.orientation[:, b], c)


def ring(count: int, play: float, length: float, phase: float) -> list:
    """Return boxes whose faces are the sides of a polygon about the y axis, with places and attitudes."""
    inside, out = RADIUS + play, []
    shape = carom.Box(WALL, length, 2.0 * (inside + WALL) * np.tan(np.pi / count))
    for k in range(count):
        a = 2.0 * np.pi * k / count + phase
        place = (inside + 0.5 * WALL) * np.array([np.cos(a), 0.0, np.sin(a)])
        out.append((shape, tuple(place), carom.euler("y", -np.degrees(a))))
    return out


def arm(scene, kind: str, play: float, length: float, angle: float, spin: float, speed: float):
    """Add a pin along y, or a fork of two bars with a pin, at an angle [degrees] to the vertical."""
    pin, along = carom.Cylinder(RADIUS, length), carom.euler("x", 90)
    place, v, w = play * np.array([0.3, 0.0, -0.4]), np.array([speed, 0.0, 0.3 * speed]), spin * Y
    if kind == "pin":
        return scene.add_body(
            pin, mass=0.1, position=place, orientation=along, velocity=v, angular_velocity=w
        )
    a = np.radians(angle)
    d, bar, turn = np.array([np.sin(a), 0.0, -np.cos(a)]), carom.Box(0.01, 0.01, 0.2), -angle
    bars = [(bar, 0.1 * d + f * 0.03 * Y, carom.euler("y", turn)) for f in (1, -1)]
    fork = carom.Compound([(pin, (0, 0, 0), along), *bars])
    return scene.add_body(
        fork, mass=0.5, position=place + fork.centroid,
        velocity=v + np.cross(w, fork.centroid), angular_velocity=w,
    )  # fmt: skip
