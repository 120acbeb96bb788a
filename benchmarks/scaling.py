"""How cost and memory grow: with bodies, contacts, steps, runs. A figure and a table, beside MuJoCo."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import carom
from carom.bench import measure
from carom.bench.measure import Spread, per_step, seconds, spread, stepper
from carom.bench.problems import chain, spatial_die, stack
from common import FEW, OUT, ROUNDS, decades, die_scene, peer, report
from heaps import poured
from memory import peak

FLOOR = 0.5  # MiB: less is drawn there
Curve = list[tuple[float, Spread]]


def some(*values: int) -> tuple[int, ...]:
    """Return all of them, or the first two to try the script out."""
    return values[:2] if FEW else values


def dice(count: int) -> carom.Scene:
    """Return dice in flight above a table, far from each other."""
    made = carom.Scene(gravity=(0, 0, -9.81))
    table = made.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(count):
        die = made.add_body(
            carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(k % 30, k // 30, 1e9),
            angular_velocity=(1, 2, 3),
        )  # fmt: skip
        made.add_contact(die, table, restitution=0.5, friction=0.2)
    return made


def blocks(count: int, *, stacked: bool, speed: float, friction: float = 0.01) -> carom.Scene:
    """Return blocks that slide without an end in sight, side by side or on each other, four points each."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for k in range(count):
        place = (0, 0, 0.05 + 0.1 * k) if stacked else (0, 0.2 * k, 0.05)
        scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=1.0, position=place, velocity=(speed, 0, 0))
    scene.set_contact_default(restitution=0.0, friction=friction)
    return scene


def step_of(make: Callable[[int], Callable[[int], object]], sizes, work: int) -> Curve:
    """Return the time of a step [us] for each size; `work` steps for size 1, fewer for larger ones."""
    found = []
    for size in sizes:
        many = max(100, work // size)
        found.append(
            (size, spread([1e6 * t for t in per_step(make(size), max(2, many // 10), many)]))
        )
    return found


def bodies(mujoco) -> dict[str, Curve]:
    """Return the time of a step against the number of bodies."""
    links = some(1, 3, 10, 30, 100, 300, 1000)
    found = {
        "chain": step_of(lambda n: stepper(chain.scene(n), 2e-4), links, 20000),
        "dice in flight": step_of(lambda n: stepper(dice(n), 1e-3), some(1, 10, 100, 1000), 400000),
    }
    if mujoco:

        def theirs(n: int):
            return chain.mujoco(mujoco, 2e-4, n).steps

        found["chain, MuJoCo RK4"] = step_of(theirs, [n for n in links if n <= 300], 20000)
    return found


def contacts(mujoco) -> dict[str, Curve]:
    """Return the time of a step against the number of points that are held; they slide all the time."""
    counts = some(1, 4, 16, 64)
    apart = step_of(lambda n: stepper(blocks(n, stacked=False, speed=5.0), 1e-3), counts, 400)
    piled = step_of(lambda n: stack.ours(1e-3, boxes=n).steps, some(8, 16, 32, 45), 3000)
    found = {"blocks side by side": apart, "a stack": piled}
    landing = [
        (n, spread([1e6 * t for t in per_step(stepper(poured(n, 0.0), 1e-3), 150, 170)]))
        for n in some(30, 60, 125, 250)
    ]
    found = {name: [(4 * n, t) for n, t in curve] for name, curve in found.items()}
    found["spheres that land (spheres)"] = landing
    if mujoco:
        theirs = step_of(lambda n: stack.mujoco(mujoco, 1e-3, n).steps, some(8, 16, 32, 45), 1600)
        found["a stack, MuJoCo"] = [(4 * n, t) for n, t in theirs]
    return found


def steps() -> dict[str, Curve]:
    """Return the time of a run [ms] against its number of steps."""
    found = {}
    for name, scene in (("die in flight", die_scene(1e9)), ("chain of 10", chain.scene(10))):
        run = stepper(scene, 1e-4)
        counts = some(100, 1000, 10_000, 100_000)
        found[name] = [
            (n, spread([1e3 * t for t in seconds(lambda n=n, run=run: run(n))])) for n in counts
        ]
    return found


def runs() -> dict[str, Curve]:
    """Return the wall time of an ensemble [ms] against its number of runs."""
    found = {}
    for workers in (1, 2):
        found[f"throws, {workers} thread{'s' * (workers > 1)}"] = [
            (n, spread([1e3 * n / spatial_die.rate(n, k, workers, step=2e-3) for k in range(3)]))
            for n in some(10, 30, 100, 300)
        ]
    return found


def memory() -> dict[str, Curve]:
    """Return what a run adds to the peak of memory [MiB], against bodies and against saved steps."""
    cases = {
        "bodies (100 saved steps)": ("dice({n})", 100, 1, some(1, 10, 100, 1000)),
        "saved steps (one die)": ("die_scene(1e9)", None, 1, some(1000, 10_000, 100_000, 1_000_000)),
        "steps, ends saved (one die)": ("die_scene(1e9)", None, 10**9, some(1000, 10_000, 100_000, 1_000_000)),
    }  # fmt: skip
    found: dict[str, Curve] = {}
    for name, (scene, count, every, sizes) in cases.items():
        found[name] = []
        for n in sizes:
            _, more = peak(scene.format(n=n), count or n, every)
            found[name].append((n, Spread(more / 1024, more / 1024, more / 1024, 1)))
    return found


PANELS = (
    ("bodies", "bodies", "a step [us]"), ("contacts", "points of contact", "a step [us]"),
    ("steps", "steps", "the run [ms]"), ("runs", "runs", "the ensemble, wall time [ms]"),
    ("memory", "see each line", "more memory [MiB] (0 as 0.5)"),
)  # fmt: skip


def draw(results: dict[str, dict[str, Curve]]) -> None:
    """Draw one small picture for each of what grows; dotted: proportional."""
    from carom.visual.plots import style as look

    colours = (look.BLUE, look.GREEN, look.ORANGE)
    with look.style():
        figure, axes = look.new(look.PAGE, 4.4, 2, 3)
        axes[1, 2].axis("off")
        for ax, (name, across, up) in zip(axes.flat, PANELS):
            ours, floor = iter(colours), FLOOR if name == "memory" else 0.0
            for label, curve in results[name].items():
                colour = look.RED if "MuJoCo" in label else next(ours)
                size, time = (np.array(v, dtype=float) for v in zip(*((n, t[0]) for n, t in curve)))
                ax.loglog(size, np.maximum(time, floor), "o-", color=colour, label=label, lw=1)
            size, time = next(iter(results[name].values()))[-1]
            guide = size * np.array([1e-1, 1.0])
            ax.loglog(guide, 0.4 * max(time.median, floor) * guide / size, ":", color=look.GREY)
            ax.set(xlabel=across, ylabel=up, title=f"{name}")
            ax.set_ylim(top=10.0 * ax.get_ylim()[1])  # for the legend
            decades(ax)
            ax.legend(fontsize=5.5)
            ax.grid(alpha=0.25, lw=0.4)
        axes[1, 2].text(
            0, 0.9, "\n".join(measure.machine_line().split("; ")).replace(", numpy", "\nnumpy"),
            va="top", fontsize=6, color=look.GREY,
        )  # fmt: skip
        OUT.mkdir(parents=True, exist_ok=True)
        figure.savefig(OUT / "scaling.png", dpi=220)


def main() -> None:
    """Measure, draw and report."""
    mujoco = peer("mujoco")
    results = {
        "bodies": bodies(mujoco), "contacts": contacts(mujoco), "steps": steps(), "runs": runs(),
        "memory": memory(),
    }  # fmt: skip
    rows = [
        [name, label, f"{size:,}", time.text() if time.count > 1 else f"{time.median:.3g}"]
        for name, curves in results.items()
        for label, curve in curves.items()
        for size, time in curve
    ]
    units = "; ".join(f"{name}: {up}" for name, _, up in PANELS)
    report(
        "scaling", "How cost and memory grow", ["with", "what", "how many", "cost"], rows,
        f"Cost of {units}. Medians of {ROUNDS} rounds (ensembles: 3; memory: one).",
    )  # fmt: skip
    draw(results)


if __name__ == "__main__":
    main()
