"""Time to the first result in a fresh process: import, first simulate, cache warm and cold."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile

from common import report, spread

SCENES = {
    "free body": "scene = die_scene()",
    "joints (tree)": "scene = pendulum_scene()",
    "free body, method='paper'": "scene = die_scene()",
}
CODE = """
import time
begin = time.process_time()
import carom
imported = time.process_time() - begin
from common import die_scene, pendulum_scene
{scene}
begin = time.process_time()
carom.simulate(scene, duration=0.1, step=1e-2, method="{method}")
print(imported, time.process_time() - begin)
"""


def fresh(name: str, cache: str) -> tuple[float, float]:
    """Return the times of import and of the first simulate in a process of its own."""
    method = "paper" if "paper" in name else "rk4"
    environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
    here = os.path.dirname(os.path.abspath(__file__))
    environment["PYTHONPATH"] = os.pathsep.join([here, environment.get("PYTHONPATH", "")])
    code = CODE.format(scene=SCENES[name], method=method)
    done = subprocess.run(
        [sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    a, b = (float(word) for word in done.stdout.split())
    return a, b


def main() -> None:
    """Measure and report."""
    rows = []
    for name in SCENES:
        with tempfile.TemporaryDirectory() as cache:
            _, cold = fresh(name, cache)
            warm = [fresh(name, cache) for _ in range(5)]
        rows.append([
            name, spread([w[0] for w in warm]), spread([w[1] for w in warm]), f"{cold:.3g}",
        ])  # fmt: skip
    report(
        "startup", "First result in a fresh process",
        ["scene", "import carom [s]", "first simulate, warm [s]", "cold, once [s]"], rows,
        "Cold: an empty cache, all kernels of this kind of scene are compiled.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
