"""``carom doctor``: check an installation."""

from __future__ import annotations

import os
import platform
import sys
import time
from pathlib import Path
from typing import Annotated, Any

import typer

from carom.cli import FAILED, show
from carom.cli.extras import requirements, version
from carom.cli.outcome import warn

#: said before the run, because a first one waits for the compiler
RUNS = (
    "running a sphere that bounces on a floor; the time loop, free flight, the search of contacts, the impact "
    "and rest are compiled first where they are not on disk, once, in a minute or more ..."
)


def run(
    warm: Annotated[
        bool, typer.Option("--warm", help="Compile everything first, like 'carom warmup'.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print the report as JSON.")] = False,
) -> int:
    """Check this installation.

    Prints the versions of all packages, the missing extras with the commands that install them, and the folder
    of the compiled code. Compares a bouncing sphere with its closed-form solution. The exit code is 1 if
    something is wrong; a missing extra is not an error.

    For example:
      carom doctor
      carom doctor --warm            compile everything, then check
      carom doctor --json > installation.json
    """
    from carom.cli import warmup

    if warm:
        warmup.compile_all()
    found = installation()
    if not json:
        _print_installation(found)
        print(RUNS, flush=True)
    check_code(found)
    if json:
        show.as_json(found)
    else:
        _print_code(found)
    for line in found["wrong"]:
        warn("doctor", line)
    return FAILED if found["wrong"] else 0


def installation() -> dict[str, Any]:
    """Return versions, extras, and a list of errors; nothing is compiled for it."""
    import carom

    wrong: list[str] = []
    wanted = requirements()
    needed = {name: version(name) for name in wanted.pop("")}
    wrong += [f"{n} is missing: pip install {n}" for n, v in needed.items() if v is None]
    extras = {extra: {name: version(name) for name in names} for extra, names in wanted.items()}
    return {
        "carom": carom.__version__, "at": str(Path(carom.__file__).parent),
        "python": platform.python_version(), "executable": sys.executable,
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} processors",
        "packages": needed,
        "extras": {
            extra: {
                "packages": names, "complete": None not in names.values(),
                "install": f'pip install "carom[{extra}]"',
            }
            for extra, names in extras.items()
        },
        "wrong": wrong,
    }  # fmt: skip


def check_code(found: dict[str, Any]) -> None:
    """Add the cache and the result of a run, which may have to be compiled, and their errors."""
    found["cache"], trouble = _cache()
    found["sphere"], wrong = _smoke()
    found["wrong"] = found.pop("wrong") + trouble + wrong


def _cache() -> tuple[dict[str, Any], list[str]]:
    from carom._compiled.decorators import COMPILES

    if not COMPILES:
        reason = "NUMBA_DISABLE_JIT is set, or carom does not know this version of Numba"
        why = f"{reason}: everything runs uncompiled, hundreds of times slower"
        return {"folder": None, "megabytes": 0.0}, [why]
    from carom.stepping import time_loop

    folder = time_loop.run.dispatcher._cache.cache_path
    if not folder:
        why = "no folder for compiled code: set NUMBA_CACHE_DIR to a writable folder"
        return {"folder": None, "megabytes": 0.0}, [why]
    top = Path(folder)
    package = Path(time_loop.__file__).parents[1]
    if top.is_relative_to(package):  # beside the source
        top = package
    size = sum(file.stat().st_size for file in top.rglob("*.nbc"))
    found = {"folder": str(folder), "megabytes": size / 1e6}
    if not os.access(folder, os.W_OK):
        return found, [f"{folder} is not writable: set NUMBA_CACHE_DIR to a writable folder"]
    return found, []


def _smoke() -> tuple[dict[str, float], list[str]]:
    """Run a ball that bounces once or more, twice; compare its height with the closed form."""
    from carom.bench.problems import sphere

    task, spent = sphere.ours(1e-3, duration=1.0), []
    for _ in range(2):
        start = time.perf_counter()
        task.run()
        spent.append(time.perf_counter() - start)
    error = task.error()
    found = {"error": error, "first_run_seconds": spent[0], "next_run_seconds": spent[1]}
    if not error < 1e-10:
        return found, [
            f"the bouncing sphere has an error of {error:.1e}: please report this installation"
        ]
    return found, []


def _print_installation(found: dict[str, Any]) -> None:
    print(f"carom {found['carom']} at {found['at']}")
    print(f"python {found['python']} at {found['executable']}, {found['machine']}")
    show.table(
        ["needed", "version"], [(n, v or "missing") for n, v in found["packages"].items()], left=2
    )
    rows = [
        (
            extra, "yes" if facts["complete"] else facts["install"],
            ", ".join(f"{n} {v or '(missing)'}" for n, v in facts["packages"].items()),
        )
        for extra, facts in found["extras"].items()
    ]  # fmt: skip
    print()
    show.table(["extra", "there?", "packages"], rows, left=3)
    print()


def _print_code(found: dict[str, Any]) -> None:
    cache, sphere = found["cache"], found["sphere"]
    if cache["folder"]:
        print(f"compiled code in {cache['folder']} ({cache['megabytes']:.0f} MB)")
    print(
        f"bouncing sphere: error {sphere['error']:.1e}, first run {sphere['first_run_seconds']:.2f} s, "
        f"next {sphere['next_run_seconds']:.4f} s"
    )
    print("no errors" if not found["wrong"] else f"errors: {len(found['wrong'])}")
