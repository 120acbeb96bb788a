"""Impacts of masses far apart, at random: ratios from 1 to 1e12, light on heavy and heavy on light.

    python benchmarks/mass_ratios.py all 50                 50 seeds of each kind
    python benchmarks/mass_ratios.py balls 1000 --most 1e8  one kind, ratios up to 1e8
    python benchmarks/mass_ratios.py rod 1 --first 17       one again

What must be without a word in `warnings`: the run ends; after an impact no contact approaches faster than 1e-9
of the greatest speed in it, and the round-off of its own impulse, 1e-15 W_nn P (a light body between heavy ones
gets the difference of two great impulses); an impact adds no energy, and takes none if e = 1 and mu = 0, at
1e-9 of the largest energy exchanged; e = 1 without friction keeps the total energy (1e-9 for free bodies, 1e-6
with joints); momentum is kept where nothing holds the bodies (1e-12). A line names a run that breaks one of
these: "said" if it has a warning or is no success, otherwise "silent".
"""

from __future__ import annotations

import argparse
import warnings
from collections import Counter

import numpy as np

import carom
from carom import GROUND, joints

LEFT, ROUND_OFF, KEPT, KEPT_JOINED, MOMENTUM = 1e-9, 1e-15, 1e-9, 1e-6, 1e-12
SIZE, LIGHT, G = 0.1, 0.06, 9.81


def masses(rng, count: int, most: float) -> np.ndarray:
    """Return masses whose greatest ratio is uniform in the logarithm, from the bottom to the top."""
    spread = np.r_[0.0, 1.0, rng.uniform(size=count - 2)]
    rng.shuffle(spread)
    return LIGHT * 10.0 ** (rng.uniform(0.0, np.log10(most)) * spread)


def scene_with(rng, floor=True, gravity=G):
    """Return a scene, its restitution and its friction: e = 0, 1 or between, friction in half of the scenes."""
    scene = carom.Scene(gravity=(0, 0, -gravity))
    if floor:
        scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    e = float(rng.choice([0.0, 1.0, rng.uniform(0.05, 0.95)]))
    mu = float(rng.choice([0.0, rng.uniform(0.05, 0.8)]))
    law = str(rng.choice(["poisson", "stronge"] if mu > 0.0 else ["newton", "poisson", "stronge"]))
    scene.set_contact_default(restitution=e, friction=mu, impact_law=law)
    return scene, e, mu


def balls(rng, most):
    """Drop a stack of two to four balls that touch."""
    scene, e, mu = scene_with(rng)
    height = rng.uniform(0.1, 1.0)
    for i, mass in enumerate(masses(rng, int(rng.integers(2, 5)), most)):
        scene.add_body(carom.Sphere(SIZE), mass=mass, position=(0, 0, height + (2 * i + 1) * SIZE))
    return scene, e, mu


def boxes(rng, most):
    """Drop two boxes, one flat on the other, or lay them down."""
    scene, e, mu = scene_with(rng)
    height = float(rng.choice([0.0, rng.uniform(0.05, 0.5)]))
    for i, mass in enumerate(masses(rng, 2, most)):
        scene.add_body(
            carom.Box(2 * SIZE, 2 * SIZE, 2 * SIZE), mass=mass,
            position=(0.3 * SIZE * i, 0, height + (2 * i + 1) * SIZE),
        )  # fmt: skip
    return scene, e, mu


def ball_on_box(rng, most):
    """Drop a box with a ball on it, not in its middle."""
    scene, e, mu = scene_with(rng)
    low, high = masses(rng, 2, most)
    height = rng.uniform(0.05, 0.5)
    scene.add_body(carom.Box(0.4, 0.4, 0.2), mass=low, position=(0, 0, height + 0.1))
    scene.add_body(carom.Sphere(SIZE), mass=high, position=(0.05, 0.02, height + 0.2 + SIZE))
    return scene, e, mu


def row(rng, most):
    """Strike a row of balls in free space."""
    scene, e, mu = scene_with(rng, floor=False, gravity=0.0)
    for i, mass in enumerate(masses(rng, int(rng.integers(2, 5)), most)):
        start = (-0.05, 0, 0) if i == 0 else (0, 0, 0)
        speed = (1.0 if i == 0 else 0.0, 0, 0)
        scene.add_body(
            carom.Sphere(SIZE),
            mass=mass,
            position=np.add(start, (2 * i * SIZE, 0, 0)),
            velocity=speed,
        )
    return scene, e, mu


def pendulum(rng, most):
    """Swing a double pendulum of two balls against the floor."""
    scene, e, mu = scene_with(rng)
    parent, place = GROUND, np.array([0.0, 0.0, 0.85])
    for mass, angle in zip(masses(rng, 2, most), (1.2, rng.uniform(0.0, 1.2))):
        hinge, place = place, place + 0.4 * np.array([np.sin(angle), 0, -np.cos(angle)])
        ball = scene.add_body(carom.Sphere(SIZE), mass=mass, position=place)
        scene.add_joint(joints.Revolute(hinge, axis=(0, 1, 0)), parent, ball)
        parent = ball
    return scene, e, mu


def rod(rng, most):
    """Let a rod on a hinge, with another one on it, fall into its stop."""
    scene, e, _ = scene_with(rng, floor=False)
    first, second = masses(rng, 2, most)
    arm = scene.add_body(carom.Box(0.4, 0.02, 0.02), mass=first, position=(0.2, 0, 0))
    end = scene.add_body(carom.Box(0.4, 0.02, 0.02), mass=second, position=(0.6, 0, 0))
    shoulder = scene.add_joint(joints.Revolute((0, 0, 0), axis=(0, 1, 0)), GROUND, arm)
    elbow = scene.add_joint(joints.Revolute((0.4, 0, 0), axis=(0, 1, 0)), arm, end)
    scene.add_stop(shoulder, upper=rng.uniform(0.2, 1.0), restitution=e)
    scene.add_stop(elbow, lower=-0.3, restitution=e)
    scene.add_stop(elbow, upper=0.3, restitution=e)
    return scene, e, 0.0


KINDS = {
    "balls": (balls, 0.8), "boxes": (boxes, 0.5), "ball on box": (ball_on_box, 0.5), "row": (row, 0.3),
    "pendulum": (pendulum, 0.8), "rod": (rod, 0.8),
}  # fmt: skip


def faults(kind: str, s: carom.Solution, e: float, mu: float) -> list[str]:
    """Return what the run breaks, with the amount."""
    found = [] if s.success else [s.status.name]
    impacts, m = s.impacts, np.array([body.mass for body in s.scene.bodies])
    exchanged = max(np.ptp(s.potential_energy), s.kinetic_energy.max(), 1e-300)  # at rest: nothing
    elastic = e == 1.0 and mu == 0.0
    for time in np.unique(impacts.time):
        own = impacts.time == time
        before, after = impacts.relative_velocity_before[own], impacts.relative_velocity_after[own]
        known = ROUND_OFF * impacts.inverse_mass[own, 0, 0] * impacts.impulse[own, 0]
        left = (-after[:, 0] - known).max() / np.abs(np.r_[before, after]).max()
        change = impacts.energy_change[own].sum() / exchanged
        found += [f"approach left {left:.0e}"] if left > LEFT else []
        found += [f"impact adds {change:.0e}"] if change > KEPT else []
        found += [f"impact takes {-change:.0e}"] if elastic and change < -KEPT else []
    drift = np.ptp(s.total_energy) / exchanged
    allowed = KEPT_JOINED if kind in ("pendulum", "rod") else KEPT
    found += [f"energy not kept {drift:.0e}"] if elastic and drift > allowed else []
    gain = (s.total_energy.max() - s.total_energy[0]) / exchanged
    found += [f"energy gained {gain:.0e}"] if not elastic and gain > allowed else []
    if kind == "row":
        momentum = s.velocity[:, :, 0] @ m
        off = np.abs(momentum / momentum[0] - 1.0).max()
        found += [f"momentum {off:.0e}"] if off > MOMENTUM else []
    return found


def main() -> int:
    """Run; return 1 if a fault is silent."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("kind", choices=[*KINDS, "all"])
    parser.add_argument("count", nargs="?", type=int, default=20)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--most", type=float, default=1e12, help="greatest ratio of masses")
    given = parser.parse_args()
    silent = 0
    for kind in KINDS if given.kind == "all" else [given.kind]:
        make, duration = KINDS[kind]
        count = Counter()
        for seed in range(given.first, given.first + given.count):
            scene, e, mu = make(
                np.random.default_rng([43, list(KINDS).index(kind), seed]), given.most
            )
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                s = carom.simulate(scene, duration, throw=False)
            found = faults(kind, s, e, mu)
            said = "said" if s.warnings or not s.success else "silent"
            count[said if found else "right"] += 1
            if found:
                m = [body.mass for body in scene.bodies]
                print(
                    f"{kind} {seed}: {said}: m = {np.array(m)} e = {e:.2g} mu = {mu:.2g}",
                    Counter(f.rsplit(" ", 1)[0] for f in found),
                    max(found, key=len),
                )
        silent += count["silent"]
        print(f"## {kind}: {given.count} runs, {dict(count)}", flush=True)
    return int(silent > 0)


if __name__ == "__main__":
    raise SystemExit(main())
