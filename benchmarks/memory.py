"""Peak memory of a run, in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys

CODE = """
import resource
import carom
from common import die_scene, pendulum_scene
{more}
scene = {scene}
carom.simulate(scene, duration=0.01, step=1e-3)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
carom.simulate(scene, duration={steps} * 1e-3, step=1e-3, save_every={every})
after = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
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
