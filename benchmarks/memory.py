"""Peak memory of a run, in a process of its own (Linux)."""

from __future__ import annotations

import os
import subprocess
import sys

CODE = """
import carom
from common import die_scene, pendulum_scene
{more}

def peak():  # of this process; what getrusage tells is that of its parent where that is larger
    with open("/proc/self/status") as told:
        return next(int(line.split()[1]) for line in told if line.startswith("VmHWM"))

scene = {scene}
carom.simulate(scene, duration=0.01, step=1e-3)
before = peak()
carom.simulate(scene, duration={steps} * 1e-3, step=1e-3, save_every={every})
after = peak()
print(before, after - before)
"""


def peak(scene: str, steps: int, every: int | None = None) -> tuple[int, int]:
    """Return peak memory before a run of 1 ms steps, and by how much the run raised it [KiB].

    `scene` is Python that makes it; each `every`-th step is saved (None: both ends).
    """
    here = os.path.dirname(os.path.abspath(__file__))
    environment = {**os.environ}
    environment["PYTHONPATH"] = os.pathsep.join([here, environment.get("PYTHONPATH", "")])
    more = "from scaling import dice" if "dice(" in scene else ""
    code = CODE.format(scene=scene, steps=steps, every=every or steps, more=more)
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    before, added = (int(word) for word in done.stdout.split())
    return before, added
