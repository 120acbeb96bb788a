"""Does memory grow with the number of steps? Resident memory after runs of growing length."""

from __future__ import annotations

from common import FEW, report
from memory import peak

CASES = {
    "die in flight": "die_scene(1e9)",
    "chain of 10": "pendulum_scene(10)",
}


def main() -> None:
    """Measure and report."""
    rows = []
    for name, scene in CASES.items():
        many = (1_000, 100_000, 1_000_000) + ((10_000_000,) if "die" in name else ())
        for steps in many[:2] if FEW else many:
            before, more = peak(scene, steps)
            rows.append([name, f"{steps:,}", f"{before / 1024:.0f}", f"{more}"])
    report(
        "allocation", "Memory against the number of steps (nothing saved but both ends)",
        ["scene", "steps", "peak before the run [MiB]", "more after it [KiB]"], rows,
    )  # fmt: skip


if __name__ == "__main__":
    main()
