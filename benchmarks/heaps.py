"""Spheres poured to rest. The time of a step while they land is in `scaling.py`."""

from __future__ import annotations

import time

import numpy as np

import carom
from common import report

STEP, RADIUS = 1e-3, 0.01


def poured(count: int, turning: float) -> carom.Scene:
    """Return spheres over a box whose width goes with the cube root of their number."""
    scene, rng = carom.Scene(gravity=(0, 0, -9.81)), np.random.default_rng(0)
    row = max(3, round((0.7 * count) ** (1 / 3)))
    side = 2.4 * RADIUS * row
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(2):
        for x, sign in ((0.0, 1.0), (side, -1.0)):
            point, normal = np.zeros(3), np.zeros(3)
            point[k], normal[k] = x, sign
            scene.add_half_space(point, normal)
    for i in range(count):
        cell = np.array([i % row + 0.5, i // row % row + 0.5, i // row**2 + 0.9])
        scene.add_body(
            carom.Sphere(RADIUS * rng.uniform(0.9, 1.1)), mass=0.004,
            position=2.4 * RADIUS * cell + rng.uniform(-1, 1, 3) * 0.08 * RADIUS,
            velocity=rng.normal(size=3) * 0.05,
        )  # fmt: skip
    scene.set_contact_default(
        restitution=0.3, friction=0.4, rolling_friction=turning, pivoting_friction=turning
    )
    return scene


def to_rest(count: int, duration: float) -> list[str]:
    """Pour once; return what is to be told."""
    scene = poured(count, 1e-4)
    begin = time.process_time()
    s = carom.simulate(scene, duration, step=STEP, save_every=10)
    spent = time.process_time() - begin
    speed = np.max(np.abs(s.velocity), axis=(1, 2))
    rests = s.t[np.flatnonzero(speed > 0.0)[-1] + 1] if speed[-1] == 0.0 else np.nan
    held = int(np.sum(s.forces.saved == len(s.t) - 1))
    lost = s.total_energy[0] - s.total_energy[-1]
    return [
        str(count), str(len(s.impacts)), str(held), f"{rests:.2f}", f"{spent:.0f}",
        f"{np.max(s.held_residual):.0e}", f"{np.max(np.abs(s.ledger.residual)) / lost:.0e}",
    ]  # fmt: skip


def main() -> None:
    """Measure and report."""
    report(
        "heaps_rest", "Spheres poured to rest, rolling and pivoting friction .1 mm",
        ["spheres", "impacts", "held points", "at rest after / s", "processor time / s",
         "greatest residual / m/s", "ledger's residual"],
        [to_rest(60, 2.0), to_rest(500, 2.0)],
    )  # fmt: skip


if __name__ == "__main__":
    main()
