"""Trees of bodies under constant loads that come to rest on stops or on the ground: rest does no work."""

from __future__ import annotations

import numpy as np

import carom
from campaigns.case import Case, exchanged
from carom import GROUND, forces, joints

#: speeds that are rest [m/s, rad/s]; work of loads at rest, by the energy exchanged
REST, WORK = 1e-8, 1e-9


def case(seed: int) -> Case:
    """Return case number `seed`: one or two trees of one to four capsules, most on a floor."""
    rng = np.random.default_rng([10, seed])
    scene, floor = carom.Scene(), rng.random() < 0.6
    if floor:
        scene.add_half_space(point=(0, 0, rng.uniform(-2.2, -1.6)), normal=(0, 0, 1), name="floor")
    for c in range(int(rng.integers(1, 3))):
        links, tips = [GROUND], [np.array([0.0, 3.0 * c, 0.0])]
        for _ in range(int(rng.integers(1, 5))):
            i = int(rng.integers(len(links))) if rng.random() < 0.3 else len(links) - 1
            body, tip = link(scene, links[i], tips[i], rng)
            links.append(body)
            tips.append(tip)
            if floor:
                e, mu = float(rng.choice([0.0, 0.3, 0.6])), float(rng.choice([0.0, 0.3, 0.8]))
                scene.add_contact(body, "floor", restitution=e, friction=mu)

    def off(s: carom.Solution) -> float:
        late = s.t > 0.75 * s.t[-1]
        speeds = np.abs(s.velocity[late]).max(), np.abs(s.angular_velocity[late]).max()
        work = float(np.ptp(s.ledger.loads[late]))
        moves = s.velocity.any() or s.angular_velocity.any()  # else it is round-off of round-off
        return work / (WORK * exchanged(s, 1e-3)) if moves and max(speeds) < REST else 0.0

    return Case(scene, 3.0, 2e-3, {"kind": "floor" if floor else "stops"}, off)


def link(scene, parent, place, rng):
    """Add a capsule on a hinge or slider between two stops, with loads; return it and its end."""
    d = rng.normal(size=3) * (1.0, rng.random() < 0.4, 0.3)
    d /= np.linalg.norm(d)
    length, turn = float(rng.uniform(0.2, 0.5)), np.array([1.0 + d[2], -d[1], d[0], 0.0])
    body = scene.add_body(
        carom.Capsule(0.03, length - 0.06), mass=float(rng.uniform(0.2, 3.0)),
        position=place + 0.5 * length * d, orientation=turn / np.linalg.norm(turn),
    )  # fmt: skip
    axis = np.array([0.0, 1.0, 0.0]) if rng.random() < 0.6 else rng.normal(size=3)
    hinged = rng.random() < 0.85
    kind = joints.Revolute(place, axis) if hinged else joints.Prismatic(axis)
    joint = scene.add_joint(kind, parent, body)
    for end in ("lower", "upper"):
        room = float(rng.uniform(0.1, 1.5) if hinged else rng.uniform(0.02, 0.2))
        e = float(rng.choice([0.0, 0.3, 0.6]))
        scene.add_stop(joint, restitution=e, **{end: room if end == "upper" else -room})
    if rng.random() < 0.4:
        scene.add_force(forces.JointFriction(joint, float(rng.uniform(0.05, 1.0))))
    if rng.random() < 0.3:
        scene.add_force(forces.JointSpring(joint, damping=float(rng.uniform(0.01, 1.0))))
    if rng.random() < 0.6:
        scene.add_force(forces.Torque(2.0 * rng.normal(size=3), follow=rng.random() < 0.2), body)
    if rng.random() < 0.6:
        anchor = place + length * d if rng.random() < 0.5 else None
        scene.add_force(forces.Force(5.0 * rng.normal(size=3), anchor), body)
    return body, place + length * d
