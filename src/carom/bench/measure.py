"""Timing: processor time of calls and of steps, medians with quartiles, and a description of the machine."""

from __future__ import annotations

import datetime
import importlib
import math
import os
import platform
import statistics
import time
from collections.abc import Callable, Sequence
from importlib import metadata
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

ROUNDS = 5
PATIENCE = 10  # greatest number of rounds, relative to the requested number
PEERS = ("mujoco", "pybullet")

#: Processor time, because the measured code runs in one thread, and other programs may use the machine too.
clock = time.process_time


class Spread(NamedTuple):
    """Median and quartiles of some values."""

    median: float
    low: float
    high: float
    count: int

    def text(self, unit: float = 1.0, digits: int = 3) -> str:
        """Return ``median (quartile to quartile)``, in units of `unit`."""
        if math.isnan(self.median):
            return "lost in noise"
        mid, low, high = (value / unit for value in self[:3])
        return f"{mid:.{digits}g} ({low:.{digits}g} to {high:.{digits}g})"


def spread(values: Sequence[float]) -> Spread:
    """Return median and quartiles of some values."""
    if len(values) < 2:
        return Spread(values[0], values[0], values[0], len(values))
    low, mid, high = statistics.quantiles(values, n=4, method="inclusive")
    return Spread(mid, low, high, len(values))


def seconds(
    function: Callable[[], Any], rounds: int = ROUNDS, timer: Callable[[], float] = clock
) -> list[float]:
    """Return the times of `rounds` calls, after one call that is not measured."""
    function()
    times = []
    for _ in range(rounds):
        begin = timer()
        function()
        times.append(timer() - begin)
    return times


def per_step(run: Callable[[int], Any], few: int, many: int, rounds: int = ROUNDS) -> list[float]:
    """Return the time [s] of one step in each round, from the difference of ``run(many)`` and ``run(few)``.

    Other costs of a call (preparation, results) cancel. If the lower quartile is not above 0, there are up to
    `PATIENCE` times as many rounds; if it is still not above 0, the result is nan.
    """
    run(few)
    slopes = []
    while len(slopes) < rounds or (
        len(slopes) < PATIENCE * rounds and not spread(slopes).low > 0.0
    ):
        times = []
        for steps in (few, many):
            begin = clock()
            run(steps)
            times.append(clock() - begin)
        slopes.append((times[1] - times[0]) / (many - few))
    return slopes if spread(slopes).low > 0.0 else [math.nan] * len(slopes)


def stepper(scene, step: float, **how) -> Callable[[int], Any]:
    """Return ``run(steps)`` of a scene, which saves only the first and the last state."""
    import carom

    def run(steps: int):
        return carom.simulate(scene, duration=steps * step, step=step, save_every=steps, **how)

    return run


TOLERANCE = "tolerance"  # in place of a method: the given step is `rtol`


def saving(step: float, method: str, duration: float, saves: int = 1) -> dict[str, Any]:
    """Return the settings of a run with a step or a tolerance that saves the start and so many states."""
    if method == TOLERANCE:
        return {"rtol": step, "save_at": duration / saves}
    return {"step": step, "method": method, "save_every": max(1, round(duration / saves / step))}


def peer(name: str) -> ModuleType | None:
    """Return the module of another tool, or None if it cannot be imported."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


def machine() -> dict[str, Any]:
    """Return processor, cores, load, system, versions, date."""
    import carom

    model = platform.processor() or platform.machine()
    about = Path("/proc/cpuinfo")
    if about.exists():
        names = [s for s in about.read_text().splitlines() if s.startswith("model name")]
        model = names[0].split(":")[1].strip() if names else model
    versions = {"carom": carom.__version__, "python": platform.python_version()}
    for name in ("numpy", "numba", "scipy", *PEERS):
        try:
            versions[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return {
        "date": datetime.date.today().isoformat(), "processor": model, "cores": os.cpu_count(),
        "load": os.getloadavg()[0] if hasattr(os, "getloadavg") else None,
        "system": platform.system(), "versions": versions,
    }  # fmt: skip


def machine_line() -> str:
    """Return the machine in one line."""
    facts = machine()
    versions = ", ".join(f"{name} {version}" for name, version in facts["versions"].items())
    load = "" if facts["load"] is None else f", load {facts['load']:.1f}"
    return f"{facts['date']}; {facts['processor']}, {facts['cores']} cores{load}; {facts['system']}; {versions}"
