"""Profiles that touch profiles: involute gears, trains of them, lobes thrown on lobes, toothed wheels."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import cKDTree

import carom
from campaigns import draw
from campaigns.case import Case
from carom import GROUND, constraints, forces, joints

KINDS = ("gears", "train", "lobes", "hill", "wheels")
#: depth that is wrong, by the size of the smaller profile; times that are looked at, and points of a curve
INSIDE, LOOKS, POINTS = 1e-6, 12, 6000


def case(seed: int) -> Case:
    """Return gears number `seed`: kinds and steps in turn."""
    rng = np.random.default_rng([55, seed])
    kind, step = KINDS[seed % len(KINDS)], draw.STEPS[seed // len(KINDS) % 3]
    law = {
        "restitution": float(rng.choice([0.0, 0.0, 1.0, rng.uniform(0.0, 1.0)])),
        "friction": float(rng.choice([0.0, 0.1, rng.uniform(0.0, 1.0)])),
        "impact_law": str(rng.choice(draw.LAWS)),
    }
    scene = carom.Scene(gravity=(0, -9.81, 0))
    made = {"gears": _gears, "train": _gears, "wheels": _wheels}.get(kind, _thrown)
    duration = made(scene, kind, law, rng)
    label = {"kind": kind, "step": step, **law}
    return Case(scene, duration, step, label, deepest)


def deepest(s: carom.Solution) -> float:
    """Return how deep points of the curves are in each other, by what is allowed."""
    worst, scene = 0.0, s.scene
    parts = [(b, s.position[:, k], s.orientation[:, k]) for k, b in enumerate(scene.bodies)]
    still = np.ones((len(s.t), 1))
    parts += [(one, still * one.position, still * one.orientation) for one in scene.statics]
    own = [one for one in parts if isinstance(one[0].shape, carom.Profile)]
    clouds = [one[0].shape.points(POINTS) for one in own]
    for k in np.unique(np.linspace(0, len(s.t) - 1, LOOKS).astype(int)):
        placed = [_placed(c, x[k], q[k]) for c, (_, x, q) in zip(clouds, own)]
        for i, (one, _, _) in enumerate(own):
            for j, (two, _, _) in enumerate(own):
                if i != j:
                    size = min(one.shape.size, two.shape.size)
                    worst = max(worst, _depth(placed[i], placed[j]) / size)
    return worst / INSIDE


def _placed(points: np.ndarray, x: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Return points of a curve in the world; bodies turn about z."""
    angle = 2.0 * math.atan2(q[3], q[0])
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, s], [-s, c]]) + x[:2]


def _depth(points: np.ndarray, polygon: np.ndarray) -> float:
    """Return the greatest distance of points within a polygon from its sides."""
    near, which = cKDTree(polygon).query(points)
    sizes = np.linalg.norm(np.roll(polygon, -1, axis=0) - polygon, axis=1)
    best = np.argsort(near)[:200]  # only those that are near can be inside, but for deep overlaps
    best = np.union1d(best, np.arange(0, len(points), 50))
    p, inside = points[best], np.zeros(len(best), dtype=bool)
    a, b = polygon, np.roll(polygon, -1, axis=0)
    for n, (x, y) in enumerate(p.tolist()):
        up = (a[:, 1] > y) != (b[:, 1] > y)
        u, v = a[up], b[up]
        inside[n] = (
            np.sum(u[:, 0] + (y - u[:, 1]) / (v[:, 1] - u[:, 1]) * (v[:, 0] - u[:, 0]) > x) % 2
        )
    worst = 0.0
    for n in np.flatnonzero(inside):
        most = math.inf
        for k in range(which[best[n]] - 2, which[best[n]] + 2):
            u, d = polygon[k % len(polygon)], sizes[k % len(polygon)]
            e = (polygon[(k + 1) % len(polygon)] - u) / d
            t = min(max(float((p[n] - u) @ e), 0.0), d)
            most = min(most, float(np.linalg.norm(p[n] - u - t * e)))
        worst = max(worst, most)
    return worst


def _gears(scene, kind, law, rng) -> float:
    """Involute wheels on axles, at distances that leave some play, driven, loaded or thrown."""
    module, angle = 10.0 ** rng.uniform(-3, -2), math.radians(rng.choice([20.0, 20.0, 25.0]))
    play = module * float(rng.choice([0.02, 0.1]))
    x, last, turn = 0.0, 0, 0.0
    for k in range(2 if kind == "gears" else 3):
        teeth = int(rng.integers(17, 45))
        shape = carom.Profile.involute(
            teeth, module, 5 * module, pressure_angle=angle, backlash=play
        )
        if k > 0:
            x += 0.5 * module * (teeth + last) + module * float(rng.choice([0.0, 0.02]))
            # its gap is where a tooth of the one before is, on the line of axles
            turn = math.pi + math.pi / teeth - turn * last / teeth
        spin = float(rng.normal()) * 10.0 if k == 0 else 0.0
        wheel = scene.add_body(
            shape, density=1000.0, position=(x, 0, 0), orientation=carom.euler("z", np.degrees(turn)),
            angular_velocity=(0, 0, spin), name=f"wheel{k}",
        )  # fmt: skip
        axle = scene.add_joint(joints.Revolute((x, 0, 0), (0, 0, 1)), GROUND, wheel)
        inertia = float(wheel.inertia[2, 2])
        if k == 0 and rng.random() < 0.4:
            scene.add_constraint(constraints.Driver(axle, rate=spin))
        elif rng.random() < 0.6:
            scene.add_force(forces.Torque((0, 0, 50.0 * inertia * float(rng.normal()))), wheel)
        if rng.random() < 0.4:
            scene.add_force(forces.JointSpring(axle, damping=inertia * 10.0 ** rng.uniform(-1, 1)))
        if k > 0:
            scene.add_contact(f"wheel{k - 1}", wheel, **law)
        last = teeth
    return 0.3


def _lobed(rng, size: float, depth: float) -> carom.Profile:
    """Return a profile with some lobes."""
    count, phase = rng.integers(2, 7, 2), rng.uniform(0, 6, 2)
    parts = depth * rng.uniform(-1, 1, 2) / (1.0 + count)
    return carom.Profile(
        lambda a: size * (1.0 + float(np.sum(parts * np.cos(count * a + phase)))), 0.02
    )


def _thrown(scene, kind, law, rng) -> float:
    """Lobes in a plane that fall on a hill, or strike each other without weight."""
    if kind == "hill":
        scene.add_static(_lobed(rng, 0.2, 0.3), name="hill")
    else:
        scene.gravity = (0, 0, 0)
    for k in range(2 if kind == "lobes" else 3):
        shape = _lobed(rng, 10.0 ** rng.uniform(-1.6, -1.1), 0.6)
        place = (0.1 * rng.normal(), 0.4 + 0.2 * k, 0) if kind == "hill" else (0.3 * k, 0, 0)
        toward = (0, 0, 0) if kind == "hill" else ((1.0 - 2.0 * k), 0.2 * rng.normal(), 0)
        body = scene.add_body(
            shape, mass=10.0 ** rng.uniform(-1, 1), position=place, velocity=toward,
            orientation=carom.euler("z", rng.uniform(0, 360)), angular_velocity=(0, 0, 5.0 * rng.normal()),
        )  # fmt: skip
        scene.add_joint(joints.Planar((0, 0, 1)), GROUND, body)
    scene.set_contact_default(**law)
    return 0.6


def _wheels(scene, kind, law, rng) -> float:
    """Two wheels with straight teeth on axles, which strike each other."""
    far = 0.0
    for k in range(2):
        count, size = int(rng.integers(6, 14)), 10.0 ** rng.uniform(-1.4, -1.0)
        turns = 2.0 * math.pi / count * np.arange(count)
        slant = rng.uniform(0.1, 0.9) * 2.0 * math.pi / count
        teeth = [
            (r * size * math.cos(a), r * size * math.sin(a))
            for t in turns for r, a in ((0.75, t), (1.0, t + slant))
        ]  # fmt: skip
        shape = carom.Profile(teeth, 0.02, corners="all")
        place = (0.0, 0, 0) if k == 0 else (far + size, 0, 0)
        far += size * (0.95 if k == 0 else 0.0)
        turn = 0.0
        if k == 1:  # turned until it is free
            first = scene.bodies[0]
            for turn in rng.uniform(0, 360, 200):
                here = (np.array(place), carom.euler("z", turn))
                one = (first.position, first.orientation)
                gap = carom.collision.api.nearest_points(first.shape, one, shape, here).gap
                if gap > 1e-4 * size:
                    break
        body = scene.add_body(
            shape, density=1000.0, position=place, orientation=carom.euler("z", turn),
            angular_velocity=(0, 0, 8.0 * rng.normal()), name=f"wheel{k}",
        )  # fmt: skip
        axle = scene.add_joint(joints.Revolute(place, (0, 0, 1)), GROUND, body)
        if rng.random() < 0.5:
            inertia = float(body.inertia[2, 2])
            scene.add_force(forces.JointSpring(axle, damping=inertia * 10.0 ** rng.uniform(-1, 1)))
    scene.add_contact("wheel0", "wheel1", **law)
    return 0.5
