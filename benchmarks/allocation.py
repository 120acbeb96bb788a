"""Does memory grow with the number of steps? Resident memory after runs of growing length."""

from __future__ import annotations

import os
import subprocess
import sys

from common import report

CODE = """
import resource
import carom
from common import die_scene, pendulum_scene
scene = {scene}
carom.simulate(scene, duration=0.01, step=1e-3)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
carom.simulate(scene, duration={steps} * 1e-3, step=1e-3, save_every={steps})
after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
print(before, after - before)
"""
CASES = {
    "die in flight": "die_scene(1e9)",
    "chain of 10": "pendulum_scene(10)",
}


def grown(scene: str, steps: int) -> tuple[int, int]:
    """Return peak memory before a run, and by how much the run raised it [KiB]."""
    here = os.path.dirname(os.path.abspath(__file__))
    environment = {**os.environ}
    environment["PYTHONPATH"] = os.pathsep.join([here, environment.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, "-c", CODE.format(scene=scene, steps=steps)],
        env=environment, capture_output=True, text=True, check=True,
    )  # fmt: skip
    before, more = (int(word) for word in done.stdout.split())
    return before, more


def main() -> None:
    """Measure and report."""
    rows = []
    for name, scene in CASES.items():
        for steps in (1_000, 100_000, 1_000_000) + ((10_000_000,) if "die" in name else ()):
            before, more = grown(scene, steps)
            rows.append([name, f"{steps:,}", f"{before / 1024:.0f}", f"{more}"])
    report(
        "allocation", "Memory against the number of steps (nothing saved but both ends)",
        ["scene", "steps", "peak before the run [MiB]", "more after it [KiB]"], rows,
    )  # fmt: skip


if __name__ == "__main__":
    main()
