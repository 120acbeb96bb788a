"""``carom doctor``: check an installation."""

from __future__ import annotations

import os
import platform
import sys
import time
from importlib import metadata
from pathlib import Path

_ABOUT = """\
Say which versions are installed and where compiled code is kept, and run a bouncing sphere against
its closed form. Exit code 1 if something is wrong."""
_NEEDED = ("numpy", "scipy", "numba")
_OPTIONAL = ("matplotlib", "tqdm")


def add(commands) -> None:
    """Add the command to the parser."""
    this = commands.add_parser("doctor", help="check this installation", description=_ABOUT)
    this.set_defaults(run=run)


def run(given) -> int:
    """Check versions, cache and a run; name what is wrong and what to do."""
    import carom

    print(f"carom {carom.__version__} at {Path(carom.__file__).parent}")
    print(f"python {platform.python_version()} at {sys.executable}, {platform.machine()}")
    trouble = []
    for name in (*_NEEDED, *_OPTIONAL):
        try:
            print(f"{name} {metadata.version(name)}")
        except metadata.PackageNotFoundError:
            print(f"{name} is not installed")
            if name in _NEEDED:
                trouble.append(f"{name} is missing: pip install {name}")
    trouble += _cache()
    trouble += _smoke()
    for line in trouble:
        print(f"carom doctor: {line}", file=sys.stderr)
    print("all well" if not trouble else f"{len(trouble)} found wrong")
    return int(bool(trouble))


def _cache() -> list[str]:
    if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0"):
        return ["NUMBA_DISABLE_JIT is set: everything runs uncompiled, a thousand times slower"]
    from carom import march

    cache = getattr(march.run, "_cache", None)
    folder = getattr(cache, "cache_path", None)
    if not folder:
        return ["no place for compiled code: set NUMBA_CACHE_DIR to a folder that can be written"]
    size = sum(file.stat().st_size for file in Path(folder).glob("*.nb*"))
    print(f"compiled code in {folder} ({size / 1e6:.1f} MB)")
    if not os.access(folder, os.W_OK):
        return [f"{folder} cannot be written: set NUMBA_CACHE_DIR to a folder that can"]
    return []


def _smoke() -> list[str]:
    """Run a sphere dropped from 0.4 m; t1 = sqrt(2 h / g) and the speed e g t1."""
    import carom

    scene = carom.Scene(gravity=(0, 0, -9.81))
    ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    ball = scene.add_body(shape=carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5))
    scene.add_contact(ball, ground, restitution=0.8, friction=0.0)
    spent = []
    for _ in range(2):
        start = time.perf_counter()
        run = carom.simulate(scene, 0.4, step=1e-3)
        spent.append(time.perf_counter() - start)
    first = (2 * 0.4 / 9.81) ** 0.5
    impacts = run.impacts
    error = abs(impacts.time[0] - first) if len(impacts) else float("inf")
    error += abs(impacts.relative_velocity_after[0, 0] - 0.8 * 9.81 * first) if len(impacts) else 0
    print(f"bouncing sphere: error {error:.1e}, first run {spent[0]:.2f} s, next {spent[1]:.4f} s")
    if not error < 1e-10:
        return [f"the bouncing sphere is wrong by {error:.1e}: please report this installation"]
    return []
