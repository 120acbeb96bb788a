"""Bodies that hold each other by their form: gears, cams, Geneva drives, ratchets; none may pass through.

Each case measures how far its run is from what plane geometry allows: at most 1 if nothing has passed through.
"""

from __future__ import annotations

import itertools

import numpy as np

import carom
from campaigns.case import Case
from carom import GROUND, constraints, forces, joints

#: of the motion that geometry allows: what the sampled positions and rigid contact may be off
MARGIN = 0.05
THICK, DENSITY = 0.01, 2700.0
Z = np.array([0.0, 0.0, 1.0])


def case(seed: int) -> Case:
    """Return case number `seed`: half are gears, the others cams, Geneva drives and ratchets in turn."""
    rng = np.random.default_rng([9, seed])
    make = (gears, cam, gears, geneva, gears, ratchet)[seed % 6]
    return make(rng)


def turned(points, angle: float) -> np.ndarray:
    """Return plane points turned by an angle."""
    c, s = np.cos(angle), np.sin(angle)
    return np.asarray(points) @ np.array([[c, s], [-s, c]])


def prism(outline, thick: float = THICK):
    """Return a convex prism over a plane outline and its place in the body."""
    low, high = -0.5 * thick, 0.5 * thick
    shape = carom.Convex([(x, y, z) for x, y in outline for z in (low, high)])
    return shape, tuple(shape.centroid)


def wheel(scene, pieces, radius: float, place=(0, 0, 0), **motion):
    """Add a body of massless pieces round a hub, with the inertia of a disc, on a hinge along z."""
    mass = DENSITY * np.pi * radius**2 * THICK
    spin = 0.5 * mass * radius**2
    body = scene.add_body(
        carom.Compound(pieces, masses=[1.0] + [1e-9] * (len(pieces) - 1)), mass=mass,
        inertia=(0.6 * spin, 0.6 * spin, spin), position=place, **motion,
    )  # fmt: skip
    return body, scene.add_joint(joints.Revolute(place, Z), GROUND, body), spin


def law(rng) -> dict:
    """Return restitution and friction."""
    e, mu = float(rng.choice([0.0, 0.2, 0.5])), float(rng.choice([0.0, 0.1, rng.uniform(0.0, 0.3)]))
    return {"restitution": e, "friction": mu}


def tooth(teeth: int, module: float, addendum: float, play: float) -> np.ndarray:
    """Return the outline of an involute tooth about the x axis, thinner by `play` [m] at the pitch circle."""
    pressure = np.radians(20.0)
    pitch = 0.5 * teeth * module
    base = pitch * np.cos(pressure)
    radii = np.linspace(pitch - 1.25 * addendum, pitch + addendum, 6)
    across = np.arccos(np.clip(base / radii, 0.0, 1.0))
    rolled = np.tan(across) - across - (np.tan(pressure) - pressure)
    half = (0.25 * np.pi * module - 0.5 * play) / pitch - rolled
    x, y = radii * np.cos(half), radii * np.sin(half)
    return np.concatenate([np.stack([x, y], axis=1), np.stack([x, -y], axis=1)[::-1]])


def overlap(a: np.ndarray, b: np.ndarray) -> bool:
    """Return whether two convex polygons overlap (separating axes)."""
    for p in (a, b):
        edge = np.roll(p, -1, axis=0) - p
        normal = np.stack([edge[:, 1], -edge[:, 0]], axis=1)
        s, t = a @ normal.T, b @ normal.T
        if np.any((s.max(0) <= t.min(0)) | (t.max(0) <= s.min(0))):
            return False
    return True


def free(a: float, b: float, one, two, counts, far: float) -> bool:
    """Return whether the gears at angles a, b have no teeth that overlap."""
    near = []
    for outline, angle, count, toward in ((one, a, counts[0], 0.0), (two, b, counts[1], np.pi)):
        pitch = 2.0 * np.pi / count
        first = round((toward - angle) / pitch)
        near.append([turned(outline, angle + (first + k) * pitch) for k in (-2, -1, 0, 1, 2)])
    shift = np.array([far, 0.0])
    return not any(overlap(p, q + shift) for p, q in itertools.product(*near))


def play_of(one, two, counts, far: float):
    """Return the least and greatest turn of the second gear beside its ratio, None if they jam."""
    low, high, pitch = 0.0, 0.0, 2.0 * np.pi / counts[1]
    for a in np.arange(12) / 12 * 2.0 * np.pi / counts[0]:
        b = np.pi + np.pi / counts[1] - a * counts[0] / counts[1]
        if not free(a, b, one, two, counts, far):
            return None
        for sign in (-1.0, 1.0):
            inside, outside = 0.0, 0.5 * pitch
            for _ in range(9):
                middle = 0.5 * (inside + outside)
                if free(a, b + sign * middle, one, two, counts, far):
                    inside = middle
                else:
                    outside = middle
            low, high = min(low, sign * outside), max(high, sign * outside)
    return low, high


def gears(rng) -> Case:
    """Return two gears of 6 to 60 teeth; the first is driven, friction in the hinge loads the second."""
    counts = [int(n) for n in np.round(np.exp(rng.uniform(np.log(6), np.log(60), 2)))]
    module, part = float(rng.choice([1e-3, 2e-3, 4e-3, 8e-3])), 1.0
    play = float(rng.choice([0.02, 0.05, 0.1, 0.3])) * module
    far, bounds = 0.5 * sum(counts) * module, None
    while bounds is None:  # few teeth need lower ones
        outlines = [tooth(n, module, part * module, play) for n in counts]
        bounds, part = play_of(*outlines, counts, far), 0.9 * part
    scene = carom.Scene(gravity=(0, 0, 0))
    speed = float(10.0 ** rng.uniform(-0.3, 1.3))
    hinges, starts = [], (0.0, np.pi + np.pi / counts[1])
    for k in range(2):
        radius = 0.5 * counts[k] * module
        pieces = [(carom.Cylinder(radius - 1.25 * part * module, THICK), (0, 0, 0))]
        for i in range(counts[k]):
            pieces.append(prism(turned(outlines[k], starts[k] + 2.0 * np.pi * i / counts[k])))
        spin = (0, 0, speed if k == 0 else 0.0)
        hinges.append(wheel(scene, pieces, radius, (far * k, 0, 0), angular_velocity=spin))
    (first, drive, _), (second, driven, inertia) = hinges
    scene.add_constraint(constraints.Driver(drive, rate=speed))
    ratio = counts[0] / counts[1]
    load = float(10.0 ** rng.uniform(-1.0, 2.0)) * inertia * (ratio * speed) ** 2
    scene.add_force(forces.JointFriction(driven, load))
    contact = law(rng)
    scene.add_contact(first, second, **contact)
    duration = 4.0 * 2.0 * np.pi / counts[0] / speed
    allowed = max(bounds[1], -bounds[0]) + MARGIN * 2.0 * np.pi / counts[1]

    def off(s: carom.Solution) -> float:
        angle = s.joint_coordinates(driven.name)[0][:, 0] + ratio * speed * s.t
        return float(np.max(np.abs(angle))) / allowed

    label = {
        "kind": "gears", "teeth": counts, "module": module, "play": play, "speed": speed,
        "load": load, **contact,
    }  # fmt: skip
    return Case(scene, duration, duration / 200, label, off)


def cam(rng) -> Case:
    """Return a driven cam of one to four lobes below a flat follower on a slider, which a spring presses."""
    scene, base = carom.Scene(gravity=(0, 0, 0)), float(rng.uniform(0.02, 0.04))
    speed, lobes = float(10.0 ** rng.uniform(0.0, 1.5)), int(rng.integers(1, 5))
    pieces, corners = [(carom.Cylinder(base, THICK), (0, 0, 0))], []
    for k in range(lobes):
        tip, wide = base * rng.uniform(1.1, 1.6), 0.9 * base
        outline = np.array([(0, -wide), (tip, -0.2 * base), (tip, 0.2 * base), (0, wide)])
        corners.append(turned(outline, 2.0 * np.pi * (k + 0.5) / lobes))
        pieces.append(prism(corners[-1]))
    body, drive, _ = wheel(scene, pieces, base, angular_velocity=(0, 0, speed))
    scene.add_constraint(constraints.Driver(drive, rate=speed))
    start = float(np.max(np.concatenate([*corners, [[0, base]]])[:, 1])) + 0.01 + 1e-6
    follower = scene.add_body(carom.Box(4.0 * base, 0.02, THICK), mass=0.1, position=(0, start, 0))
    slide = scene.add_joint(joints.Prismatic((0, 1, 0)), GROUND, follower)
    stiffness = 0.1 * speed**2 * float(10.0 ** rng.uniform(-1.0, 2.0))
    scene.add_force(forces.JointSpring(slide, stiffness, rest=-2.0 * base, damping=0.0))
    contact = law(rng)
    scene.add_contact(follower, body, **contact)
    duration = 2.0 * 2.0 * np.pi / lobes / speed

    def off(s: carom.Solution) -> float:
        """Return how far the follower is below the highest point of the cam, by MARGIN of the base."""
        below = 0.0
        for t, y in zip(s.t, s.position[:, 1, 1]):
            highest = max(base, *(turned(c, speed * t)[:, 1].max() for c in corners))
            below = max(below, highest - (y - 0.01))
        return below / (MARGIN * base)

    label = {"kind": "cam", "lobes": lobes, "speed": speed, "stiffness": stiffness, **contact}
    return Case(scene, duration, duration / 200, label, off)


def geneva(rng) -> Case:
    """Return a Geneva drive of 4 to 8 slots: the pin of a crank enters a slot, turns the wheel, and leaves."""
    slots, arm = int(rng.integers(4, 9)), float(rng.uniform(0.02, 0.06))
    half, pin = np.pi / slots, float(rng.uniform(0.04, 0.08)) * arm
    gap, far = float(rng.choice([0.05, 0.1, 0.3])) * pin, arm / np.sin(half)
    radius, wide = far * np.cos(half), pin + gap  # of the wheel, of a slot (half)
    speed, start = float(10.0 ** rng.uniform(-0.3, 1.3)), half - 0.5 * np.pi - 0.15
    inner, end = wide / np.sin(half), np.sqrt(radius**2 - wide**2)
    middle = turned([radius, 0.0], half)
    sector = [turned([inner, 0.0], half), (end, wide), middle, turned([end, -wide], 2.0 * half)]
    scene, (c, s) = carom.Scene(gravity=(0, 0, 0)), (np.cos(start), np.sin(start))
    crank = scene.add_body(
        carom.Cylinder(pin, THICK), mass=0.1, position=(arm * c, arm * s, 0),
        velocity=(-arm * s * speed, arm * c * speed, 0), angular_velocity=(0, 0, speed),
    )  # fmt: skip
    drive = scene.add_joint(joints.Revolute((0, 0, 0), Z), GROUND, crank)
    scene.add_constraint(constraints.Driver(drive, rate=speed))
    hub = (carom.Cylinder(0.5 * inner, 0.3 * THICK), (0, 0, 0))  # smaller than what the pin reaches
    first = np.pi + half  # a slot, when the pin enters
    pieces = [hub, *(prism(turned(sector, first + 2.0 * half * k)) for k in range(slots))]
    body, driven, inertia = wheel(scene, pieces, radius, (far, 0, 0))
    load = float(10.0 ** rng.uniform(0.5, 2.0)) * inertia * speed**2
    scene.add_force(forces.JointFriction(driven, load))
    contact = law(rng)
    scene.add_contact(crank, body, **contact)
    duration = 2.0 * abs(start) / speed

    def off(s: carom.Solution) -> float:
        """Return how far the pin is beside the middle of its slot, by the gap; infinite if it has left it."""
        x, y = s.position[:, 0, 0] - far, s.position[:, 0, 1]
        angle = np.arctan2(y, x) - first - s.joint_coordinates(driven.name)[0][:, 0]
        inside = np.hypot(x, y) < radius - 2.0 * wide
        slot = np.round(angle / (2.0 * half))
        beside = np.abs(np.hypot(x, y) * np.sin(angle - 2.0 * half * slot))[inside]
        if len(np.unique(slot[inside] % slots)) > 1:
            return np.inf
        return float(np.max(beside, initial=0.0)) / (gap + MARGIN * pin)

    label = {"kind": "geneva", "slots": slots, "gap": gap, "speed": speed, "load": load, **contact}
    return Case(scene, duration, duration / 200, label, off)


def ratchet(rng) -> Case:
    """Return a wheel of saw teeth that is thrown forward and pulled back, against a pawl on a spring."""
    count, root = int(rng.integers(8, 31)), float(rng.uniform(0.02, 0.05))
    pitch = 2.0 * np.pi / count
    tip = root * (1.0 + 0.4 * pitch)
    saw = np.array([(root, 0.0), (tip, 0.0), turned([root, 0.0], pitch)])
    pieces = [(carom.Cylinder(0.98 * root * np.cos(0.5 * pitch), THICK), (0, 0, 0))]
    pieces += [prism(turned(saw, 0.5 * np.pi + (k + 0.3) * pitch)) for k in range(count)]
    scene, speed = carom.Scene(gravity=(0, 0, 0)), float(10.0 ** rng.uniform(0.0, 1.5))
    body, hinge, inertia = wheel(scene, pieces, root, angular_velocity=(0, 0, speed))
    turns, long, height = float(rng.uniform(1.0, 6.0)) * pitch, 1.5 * root, tip + 1e-4
    pull = inertia * speed**2 / (2.0 * turns)
    scene.add_force(forces.JointForce(hinge, -pull))
    over = 0.2 * long  # the pivot is above the tip: a push closes the pawl
    outline = [
        (0, height),
        (0, height + 0.1 * long),
        (long, height + over + 0.1 * long),
        (long, height + over),
    ]
    shape, centre = prism(outline)
    mass = float(DENSITY * shape.volume)
    pawl = scene.add_body(shape, mass=mass, position=centre)
    pivot = scene.add_joint(joints.Revolute((long, height + over, 0), Z), GROUND, pawl)
    needed = 2.0 * (tip - root) / long * (speed / pitch) ** 2 * mass * long**2 / 3.0
    torque = float(10.0 ** rng.uniform(0.0, 1.5)) * needed
    scene.add_force(forces.JointSpring(pivot, torque, rest=1.0, damping=0.0))
    contact = law(rng)
    scene.add_contact(pawl, body, **contact)
    duration = 8.0 * turns / speed

    def off(s: carom.Solution) -> float:
        """Return how far the wheel has gone back, by a pitch and what the pawl moves back as it drops."""
        angle = s.joint_coordinates(hinge.name)[0][:, 0]
        back = np.max(np.maximum.accumulate(angle) - angle)
        drop = np.max(np.abs(s.joint_coordinates(pivot.name)[0]))
        return float(back) / ((1.0 + MARGIN) * pitch + float(drop) * over / root)

    label = {"kind": "ratchet", "teeth": count, "speed": speed, "torque": torque, **contact}
    return Case(scene, duration, duration / 200, label, off)
