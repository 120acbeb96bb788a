"""Build a wheel for this platform that contains the compiled code, so that a first run compiles nothing.

    python tools/build_wheel.py [--out out/wheel] [--no-install]

Takes the wheel that has sources only, compiles everything in a copy of it (``carom warmup``), and packs both
under the tag of this Python and platform. Then installs the wheel in an empty environment, throws a die there,
and checks that nothing was compiled. Compiled code is that of the baseline (`carom._compiled.target`) and of
the installed version of Numba; with another version it is compiled again, as from sources. Needs `build`,
`wheel` and the package index.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from email import message_from_string
from importlib.metadata import distribution
from pathlib import Path

ROOT = Path(__file__).parents[1]
#: a die that falls, bounces and comes to rest; prints the functions that were compiled
FIRST_RUN = """
import gc, time, carom
scene = carom.Scene(gravity=(0, 0, -9.81))
ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
die = scene.add_body(
    shape=carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.3),
    velocity=(0.5, 0, -0.5), angular_velocity=(0, 10, 0),
)
scene.add_contact(die, ground, restitution=0.5, friction=0.2)
begin = time.perf_counter()
solution = carom.simulate(scene, duration=2.0)
spent = time.perf_counter() - begin
from carom._compiled.target import Dispatcher
used = [f for f in gc.get_objects() if type(f) is Dispatcher and f.overloads]
compiled = [f.py_func.__qualname__ for f in used if sum(f.stats.cache_misses.values())]
where = carom.__file__
print(f"{where}: {len(solution.impacts)} impacts, first run {spent:.2f} s, {len(used)} functions loaded")
print("compiled:", *compiled or ["nothing"])
raise SystemExit(len(compiled) > 0 or not used)
"""


def python(*arguments, **more) -> None:
    """Run a module of this Python."""
    subprocess.run([sys.executable, *map(str, arguments)], check=True, **more)


def platform_tag() -> str:
    """Return the platforms on which the compiled code works: those of the installed wheel of Numba.

    The tag is set here because auditwheel cannot find it: it examines ELF files, and the wheel has none. The
    object code in the files of Numba's cache is linked by llvmlite in the running process, by names of symbols
    without versions. So it needs no version of the C library by itself, but works only where Numba works.
    """
    tags = message_from_string(distribution("numba").read_text("WHEEL") or "").get_all("Tag", [])
    return ".".join(sorted({tag.rsplit("-", 1)[1] for tag in tags}))


def build(out: Path) -> Path:
    """Return the path of the wheel that was built."""
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as place:
        python("-m", "build", "--wheel", "--outdir", place, ROOT, stdout=subprocess.DEVNULL)
        (plain,) = Path(place).glob("*.whl")
        python("-m", "wheel", "unpack", "--dest", place, plain, stdout=subprocess.DEVNULL)
        (tree,) = (path for path in Path(place).iterdir() if path.is_dir())
        plain.unlink()
        python("-m", "carom.cli", "warmup", env=environment(PYTHONPATH=str(tree)), cwd=place)
        (tree / "carom" / "_compiled" / "shipped").touch()
        for code in tree.rglob("*.pyc"):
            code.unlink()
        (about,) = tree.glob("*.dist-info/WHEEL")
        text = about.read_text("utf-8")
        about.write_text(text.replace("Purelib: true", "Purelib: false"), "utf-8")
        compiled = len(list(tree.rglob("*.nbc")))
        python("-m", "wheel", "pack", "--dest-dir", place, tree, stdout=subprocess.DEVNULL)
        tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
        python(
            "-m", "wheel", "tags", "--python-tag", tag, "--abi-tag", tag,
            "--platform-tag", platform_tag(), "--remove", plain, stdout=subprocess.DEVNULL,
        )  # fmt: skip
        (made,) = Path(place).glob("*.whl")
        for old in out.glob("*.whl"):
            old.unlink()
        result = Path(shutil.move(made, out / made.name))
    print(f"{result}: {compiled} files of compiled code, {result.stat().st_size / 1e6:.1f} MB")
    return result


def environment(**more: str) -> dict[str, str]:
    """Return the variables of this process without those that change compiled code, and with others."""
    kept = {k: v for k, v in os.environ.items() if not k.startswith(("NUMBA_", "CAROM_", "PYTHON"))}
    return kept | more


def use(wheel: Path) -> int:
    """Install the wheel in an empty environment and throw a die; return 1 if that compiles anything."""
    with tempfile.TemporaryDirectory() as place:
        python("-m", "venv", Path(place) / "venv")
        own = Path(place) / "venv" / ("Scripts" if os.name == "nt" else "bin") / "python"
        numba = f"numba=={distribution('numba').version}"
        install = [own, "-m", "pip", "install", "--quiet", "--only-binary", ":all:"]
        subprocess.run([*install, wheel.resolve(), numba], check=True, env=environment())
        # -I: no module of the folder or of a variable comes before those of the environment
        first = subprocess.run([own, "-I", "-c", FIRST_RUN], cwd=place, env=environment())
    return first.returncode


def main() -> int:
    """Build, install and run; the exit code is 1 if the first run of a die compiles anything."""
    this = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    this.add_argument("--out", type=Path, default=ROOT / "out" / "wheel")
    this.add_argument("--no-install", action="store_true", help="only build")
    given = this.parse_args()
    wheel = build(given.out)
    return 0 if given.no_install else use(wheel)


if __name__ == "__main__":
    raise SystemExit(main())
