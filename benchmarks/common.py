"""What all benchmarks share: timing, what the machine is, tables."""

from __future__ import annotations

import datetime
import importlib
import os
import platform
import statistics
import time
from importlib import metadata
from pathlib import Path

import numpy as np

import carom

OUT = Path("out") / "benchmarks"
ROUNDS = 5

#: Processor time: what is measured runs in one thread, and others use the machine too.
clock = time.process_time


def peer(name: str):
    """Return the module of another tool, or None (and say so) where it cannot be imported."""
    try:
        return importlib.import_module(name)
    except ImportError:
        print(f"({name} is not installed in this interpreter: its rows are left out)")
        return None


def seconds(function, rounds: int = ROUNDS) -> list[float]:
    """Return the times of `rounds` calls, after one that is not counted."""
    function()
    times = []
    for _ in range(rounds):
        begin = clock()
        function()
        times.append(clock() - begin)
    return times


def stepper(scene, step: float):
    """Return ``run(steps)`` of a scene, nothing saved but both ends."""

    def run(steps):
        carom.simulate(scene, duration=steps * step, step=step, save_every=steps)

    return run


def per_step(run, few: int, many: int, rounds: int = ROUNDS) -> list[float]:
    """Return the time [s] of one more step: ``run(many)`` against ``run(few)``, each round anew.

    What a call costs besides its steps (setting up, handing back) cancels.
    """
    run(few)
    slopes = []
    for _ in range(rounds):
        times = []
        for steps in (few, many):
            begin = clock()
            run(steps)
            times.append(clock() - begin)
        slopes.append((times[1] - times[0]) / (many - few))
    return slopes


def spread(values: list[float], unit: float = 1.0, digits: int = 3) -> str:
    """Return ``median (least to greatest)``."""
    low, mid, high = (f(values) / unit for f in (min, statistics.median, max))
    return f"{mid:.{digits}g} ({low:.{digits}g} to {high:.{digits}g})"


def machine() -> str:
    """Return one line: processor, cores, system, versions, date."""
    model = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text().splitlines():
            if line.startswith("model name"):
                model = line.split(":")[1].strip()
                break
    names = ("numpy", "numba", "scipy", "mujoco", "pybullet")
    versions = [f"carom {carom.__version__}", f"Python {platform.python_version()}"]
    for name in names:
        try:
            versions.append(f"{name} {metadata.version(name)}")
        except metadata.PackageNotFoundError:
            continue
    load = os.getloadavg()[0]
    return (
        f"{datetime.date.today()}; {model}, {os.cpu_count()} cores, load {load:.1f} at the end; "
        f"{platform.system()}; {', '.join(versions)}; "
        f"processor time, medians of {ROUNDS} rounds (least to greatest)"
    )


def report(name: str, title: str, head: list[str], rows: list[list[str]], notes: str = "") -> None:
    """Print a Markdown table and write it to ``out/benchmarks/<name>.md``."""
    lines = [f"## {title}", "", machine(), ""]
    lines += ["| " + " | ".join(head) + " |", "| " + " | ".join("---" for _ in head) + " |"]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    lines += ["", notes.strip(), ""] if notes else [""]
    text = "\n".join(lines)
    print(text)
    OUT.mkdir(parents=True, exist_ok=True)
    (OUT / f"{name}.md").write_text(text, encoding="utf-8")


def die_scene(
    height: float = 0.3, velocity=(0.5, 0, -0.5), spin=(0, 10, 0), *, friction=0.2,
    restitution=0.5, inertia=None, gravity=9.81, law="newton",
) -> carom.Scene:  # fmt: skip
    """Return the die of the paper above a table."""
    scene = carom.Scene(gravity=(0, 0, -gravity))
    ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    die = scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016, inertia=inertia, position=(0, 0, height),
        velocity=velocity, angular_velocity=spin,
    )  # fmt: skip
    scene.add_contact(die, ground, restitution=restitution, friction=friction, impact_law=law)
    return scene


def pendulum_scene(links: int = 1) -> carom.Scene:
    """Return a chain of rods (1 m, 1 kg) with hinges along y, horizontal and at rest."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    above = carom.GROUND
    inertia = np.array([1e-4, 1.0 / 12.0, 1.0 / 12.0])
    for k in range(links):
        rod = scene.add_body(mass=1.0, inertia=inertia, position=(k + 0.5, 0, 0))
        scene.add_joint(carom.joints.Revolute((k, 0, 0), (0, 1, 0)), above, rod)
        above = rod
    return scene
