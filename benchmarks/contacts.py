"""Cost of a step against the number of contacts: blocks side by side, a stack, and both asleep."""

from __future__ import annotations

import carom
from common import per_step, report, spread, stepper

STEP = 1e-3
MICRO = 1e-6


def blocks(count: int, *, stacked: bool, speed: float, friction: float = 0.01) -> carom.Scene:
    """Return blocks that slide without an end in sight, side by side or on each other, four points each."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(count):
        place = (0, 0, 0.05 + 0.1 * k) if stacked else (0, 0.2 * k, 0.05)
        scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=1.0, position=place, velocity=(speed, 0, 0))
    scene.set_contact_default(restitution=0.0, friction=friction)
    return scene


def main() -> None:
    """Measure and report."""
    rows = []
    for count in (1, 4, 16, 64):
        case = blocks(count, stacked=False, speed=5.0)
        rest = blocks(count, stacked=False, speed=0.0)
        stack = stepper(blocks(count, stacked=True, speed=5.0), STEP)
        tall = spread(per_step(stack, 5, 25), MICRO) if count <= 4 else "-"
        rows.append(
            [
                str(4 * count), spread(per_step(stepper(case, STEP), 10, 60), MICRO), tall,
                spread(per_step(stepper(rest, STEP), 10, 1010), MICRO),
            ]
        )  # fmt: skip
    report(
        "contacts", "A step with held contacts / microseconds",
        ["points", "blocks that slide side by side", "a stack that slides", "blocks at rest"], rows,
    )  # fmt: skip


if __name__ == "__main__":
    main()
