"""Size of an installation: packages that pip brings, and their files; MuJoCo beside it.

`python benchmarks/installed.py` makes an environment for each and needs the package index.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from common import report

ROOT = Path(__file__).parents[1]
WANTED = {
    "carom": f"{ROOT}",
    "carom[command]": f"{ROOT}[command]",
    "carom[all]": f"{ROOT}[all]",
    "MuJoCo": "mujoco",
}  # fmt: skip
TOOLS = ("pip", "setuptools", "wheel")  # of the environment itself
MIB, BLOCK = 2.0**20, 512


def installed(wanted: str, place: Path) -> tuple[int, float, float]:
    """Return the number of packages, and what their files take on disk without and with bytecode [MiB]."""
    subprocess.run([sys.executable, "-m", "venv", place], check=True)
    python = place / "bin" / "python"
    pip = [python, "-m", "pip", "--disable-pip-version-check"]
    subprocess.run([*pip, "install", "--quiet", wanted], check=True)
    listed = subprocess.run([*pip, "list", "--format=json"], check=True, capture_output=True)
    names = [one["name"] for one in json.loads(listed.stdout) if one["name"] not in TOOLS]
    subprocess.run([*pip, "uninstall", "--quiet", "--yes", "setuptools", "pip"], check=True)
    files = [file for file in (place / "lib").rglob("*") if file.is_file()]
    sizes = [(file.suffix != ".pyc", file.stat().st_blocks * BLOCK) for file in files]
    plain = sum(size for source, size in sizes if source)
    return len(names), plain / MIB, sum(size for _, size in sizes) / MIB


def main() -> None:
    """Measure and report."""
    rows = []
    for name, wanted in WANTED.items():
        place = Path(tempfile.mkdtemp())
        try:
            count, plain, whole = installed(wanted, place)
        except subprocess.CalledProcessError as error:
            print(f"({name} cannot be installed here: {error})")
            continue
        finally:
            shutil.rmtree(place)
        rows.append([name, str(count), f"{plain:.0f}", f"{whole:.0f}"])
    report(
        "installed", "Size of an installation", ["", "packages", "size / MiB", "with bytecode / MiB"], rows,
        "On disk, as `du` counts: all packages that pip installs with it and itself, without pip's own. "
        "Bytecode: what Python writes beside the sources.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
