"""Build a wheel for this platform that carries the compiled units, so that a first run compiles nothing.

    python tools/build_wheel.py [--out out/wheel]

Takes the wheel that has sources only, compiles everything in a copy of it (``carom warmup``), and packs both
under the tag of this Python and platform. Compiled code is that of the baseline (`carom._compiled.target`)
and of the Numba that is installed; with another Numba it is compiled again, as from sources. Needs `build` and
`wheel`.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]


def python(*arguments, **more) -> None:
    """Run a module of this Python."""
    subprocess.run([sys.executable, *map(str, arguments)], check=True, **more)


def build(out: Path) -> Path:
    """Return the path of the wheel that was built."""
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as place:
        python("-m", "build", "--wheel", "--outdir", place, ROOT, stdout=subprocess.DEVNULL)
        (plain,) = Path(place).glob("*.whl")
        python("-m", "wheel", "unpack", "--dest", place, plain, stdout=subprocess.DEVNULL)
        (tree,) = (path for path in Path(place).iterdir() if path.is_dir())
        plain.unlink()
        environment = {
            k: v for k, v in os.environ.items() if not k.startswith(("NUMBA_", "CAROM_"))
        }
        environment["PYTHONPATH"] = str(tree)
        python("-m", "carom.cli", "warmup", env=environment, cwd=place)
        (tree / "carom" / "_compiled" / "shipped").touch()
        for code in tree.rglob("*.pyc"):
            code.unlink()
        compiled = len(list(tree.rglob("*.nbc")))
        python("-m", "wheel", "pack", "--dest-dir", place, tree, stdout=subprocess.DEVNULL)
        tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
        platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
        python(
            "-m", "wheel", "tags", "--python-tag", tag, "--abi-tag", tag, "--platform-tag", platform,
            "--remove", plain, stdout=subprocess.DEVNULL,
        )  # fmt: skip
        (made,) = Path(place).glob("*.whl")
        for old in out.glob("*.whl"):
            old.unlink()
        result = Path(shutil.move(made, out / made.name))
    print(f"{result}: {compiled} files of compiled code, {result.stat().st_size / 1e6:.1f} MB")
    return result


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "wheel")
    build(parser.parse_args().out)
