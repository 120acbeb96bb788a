"""Build wheel and sdist, look at what is in them, install the wheel in an empty environment and run it.

    python tools/check_release.py [--out out/release] [--no-install] [--python python3.12 python3.13]

Needs `build` and the package index. The install compiles everything from nothing: some minutes, with each of
the interpreters (default: that which runs this).
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tarfile
import time
import zipfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
CACHES = (
    "__pycache__",
    ".nbi",
    ".nbc",
    ".pyc",
    ".pytest_cache",
    ".hypothesis",
    ".ruff_cache",
    ".venv",
)
NEEDED_IN_SDIST = (
    "pyproject.toml",
    "README.md",
    "LICENSE",
    "CITATION.cff",
    "CHANGELOG.md",
    "docs/conf.py",
)


def sources(root: Path = ROOT) -> set[str]:
    """Return what the package consists of: all of src/carom but what Python and Numba leave there."""
    files = (path for path in (root / "src" / "carom").rglob("*") if path.is_file())
    names = (path.relative_to(root / "src").as_posix() for path in files)
    return {name for name in names if not any(cache in name for cache in CACHES)}


def wheel_faults(names: set[str], package: set[str]) -> list[str]:
    """Return what is wrong with the files of a wheel, in sentences."""
    faults = [f"{name} is missing in the wheel" for name in sorted(package - names)]
    for name in sorted(names - package):
        if not (name.startswith("carom-") and ".dist-info/" in name):
            faults.append(f"{name} does not belong in the wheel")
    for ending in ("METADATA", "entry_points.txt", "licenses/LICENSE"):
        if not any(name.endswith(f".dist-info/{ending}") for name in names):
            faults.append(f"{ending} is missing in the wheel")
    licences = {name.rsplit("/", 1)[1] for name in package if "/LICENSE." in name}
    for licence in licences:
        if not any(name.endswith(licence) and ".dist-info/" in name for name in names):
            faults.append(f"{licence} is missing among the licences of the wheel")
    return faults + cache_faults(names)


def sdist_faults(names: set[str], package: set[str]) -> list[str]:
    """Return what is wrong with the files of an sdist, without the folder that holds them."""
    needed = {f"src/{name}" for name in package} | set(NEEDED_IN_SDIST)
    faults = [f"{name} is missing in the sdist" for name in sorted(needed - names)]
    faults += [f"{name} is an output, not a source" for name in names if name.startswith("out/")]
    return faults + cache_faults(names)


def cache_faults(names: set[str]) -> list[str]:
    """Return a sentence for each file that Python, Numba or a tool has left."""
    return [f"{name} is a cache" for name in sorted(names) if any(c in name for c in CACHES)]


def build(out: Path) -> tuple[Path, Path]:
    """Build both, the wheel from the sdist, and return their paths (wheel, sdist)."""
    for old in (*out.glob("*.whl"), *out.glob("*.tar.gz")):
        old.unlink()
    subprocess.run([sys.executable, "-m", "build", "--outdir", out, ROOT], check=True)
    (wheel,), (sdist,) = out.glob("*.whl"), out.glob("*.tar.gz")
    return wheel, sdist


def look(wheel: Path, sdist: Path) -> list[str]:
    """Return what is wrong with the files of both."""
    package = sources()
    with zipfile.ZipFile(wheel) as archive:
        faults = wheel_faults(set(archive.namelist()), package)
    with tarfile.open(sdist) as archive:
        names = {member.name.split("/", 1)[1] for member in archive if member.isfile()}
    for path in (wheel, sdist):
        print(f"{path.name}: {path.stat().st_size / 1024:.0f} KiB")
    return faults + sdist_faults(names, package)


def use(wheel: Path, out: Path, interpreter: str) -> None:
    """Install the wheel with carom[paper] alone, from wheels only, and run the command."""
    place = out / "environment"
    subprocess.run([interpreter, "-m", "venv", "--clear", place], check=True)
    python, carom = place / "bin" / "python", place / "bin" / "carom"
    install = [
        python,
        "-m",
        "pip",
        "install",
        "--quiet",
        "--only-binary",
        ":all:",
        f"{wheel}[paper]",
    ]
    leave = ("PYTHONPATH", "NUMBA_CACHE_DIR", "NUMBA_DISABLE_JIT")
    clean = {name: value for name, value in os.environ.items() if name not in leave}
    for command in (
        install,
        [carom, "doctor"],
        [carom, "paper", "--figure", "fig3a", "--out", out / "paper"],
    ):
        start = time.perf_counter()
        subprocess.run(command, check=True, cwd=out, env=clean)
        print(f"{' '.join(map(str, command[:4]))}: {time.perf_counter() - start:.0f} s", flush=True)


def main() -> int:
    """Check a release; the exit code is 1 if something is wrong."""
    this = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    this.add_argument("--out", type=Path, default=ROOT / "out" / "release")
    this.add_argument("--no-install", action="store_true", help="only build and look")
    this.add_argument("--python", nargs="+", default=[sys.executable], help="interpreters to try")
    given = this.parse_args()
    out = given.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    wheel, sdist = build(out)
    faults = look(wheel, sdist)
    for fault in faults:
        print(fault, file=sys.stderr)
    for interpreter in () if faults or given.no_install else given.python:
        print(f"with {interpreter}:", flush=True)
        use(wheel, out, interpreter)
    print("all well" if not faults else f"{len(faults)} found wrong")
    return int(bool(faults))


if __name__ == "__main__":
    raise SystemExit(main())
