"""``carom warmup``: compile everything once."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Annotated

import typer

from carom.cli import show

#: kinds of work that share compiled code: one process does them
TOGETHER = (
    ("free", "rest", "layer", "impact", "many contacts"),
    ("stack", "heap"),
    ("loops",),
    ("tree", "reports"),
)
#: folders of the modules with compiled units
ROOMS = (
    "geometry", "collision", "kinematics", "contact", "friction", "dynamics", "impact", "persistent",
    "stepping",
)  # fmt: skip


def run(
    workers: Annotated[
        int | None, typer.Option(min=1, metavar="N", show_default="all processors", help="Number of processes.")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print times as JSON.")] = False,
) -> int:  # fmt: skip
    """Compile everything once, so that later runs start immediately.

    Compiles the library for every kind of system (free bodies, trees of joints, loops of joints) and every
    method, and the persistent contact of bodies that come to rest or lie on each other for the default method.
    The compiled code is saved on disk, and later processes load it in a fraction of a second. This takes some
    minutes at the first time, and seconds after that.

    For example:
      carom warmup
      NUMBA_CACHE_DIR=/scratch/numba carom warmup      save compiled code in this folder
    """
    rows = compile_all(workers)
    if json:
        show.as_json(rows)
    else:
        show.table(
            ["scene", "method", "first run / s"],
            [(row["kind"], row["method"], f"{row['seconds']:.2f}") for row in rows], left=2,
        )  # fmt: skip
    return 0


def compile_all(workers: int | None = None) -> list[dict]:
    """Compile everything in several processes; return kind, method and seconds of each part."""
    import multiprocessing
    import os
    from concurrent.futures import ProcessPoolExecutor, as_completed

    from carom._compiled.ahead import do_without
    from carom._compiled.decorators import COMPILES

    workers = min(workers or os.cpu_count() or 1, len(TOGETHER))
    total, rows, asked = len(work()), [], set()
    with show.progress("compile") as bar:
        context = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(workers, mp_context=context, initializer=do_without) as pool:
            for done in as_completed([pool.submit(compile_kinds, kinds) for kinds in TOGETHER]):
                new, more = done.result()
                rows, asked = rows + new, asked | more
                bar(len(rows), total)
            known: set = set()
            asked |= asked_by_disk() if COMPILES else set()
            while asked - known:  # what no scene above has called
                parts = [sorted(asked - known, key=str)[k::workers] for k in range(workers)]
                known |= asked
                asked = asked.union(*pool.map(compile_units, parts))
    order = {kind: k for k, kind in enumerate(kind for kinds in TOGETHER for kind in kinds)}
    return sorted(rows, key=lambda row: order[row["kind"]])


def asked_by_disk() -> set:
    """Return all units that code on disk may call, because code compiled before does not request them."""
    import importlib
    import pkgutil

    import carom
    from carom._compiled.units import asked_before

    for room in ROOMS:
        place = importlib.import_module(f"carom.{room}")
        for module in pkgutil.walk_packages(place.__path__, f"{carom.__name__}.{room}."):
            importlib.import_module(module.name)
    return asked_before()


def compile_units(wanted: list) -> set:
    """Compile units by name and types of arguments; return all that compiled code of this process may call."""
    from carom._compiled.units import ASKED, compile_asked

    compile_asked(wanted)
    return set(ASKED)


def compile_kinds(kinds: tuple[str, ...]) -> tuple[list[dict], set]:
    """Compile some kinds of work in this process; return times, and all units that it may call."""
    rows = []
    for kind, method, do in work():
        if kind in kinds:
            begin = time.perf_counter()
            do()
            rows.append({"kind": kind, "method": method, "seconds": time.perf_counter() - begin})
    return rows, compile_units([])


def work() -> list[tuple[str, str, Callable[[], object]]]:
    """Return all parts to compile: kind of scene, method, and a function that compiles it."""
    import carom
    from carom.dynamics.methods import METHODS

    def simulating(scene, duration, method):
        return lambda: carom.simulate(scene, duration, step=5e-3, method=method, throw=False)

    W, u = [[1, 0, 0], [0, 3.5, 0], [0, 0, 3.5]], (-1, 0.5, 0.1)
    return [
        *((k, m, simulating(s, 0.05, m)) for k, s in scenes().items() for m in METHODS),
        *((k, "rk4", simulating(s, t, "rk4")) for k, (s, t) in contact_scenes().items()),
        ("reports", "", read_reports),
        ("layer", "", lambda: carom.impact_layer(W, u, 0.3, 0.5, penetration=0.2, width=1e-6)),
        ("impact", "", lambda: carom.resolve_impact(W, u, 0.3, 0.5)),
        ("many contacts", "", lambda: carom.solve_contacts(W, u, 0.3)),
    ]


def read_reports() -> tuple:
    """Return what forces exert, and motion and reactions of joints that may break, in a short run."""
    import carom

    scene = _linked(False, breaks_at=1e9)
    scene.add_force(carom.forces.JointSpring("joint1", 1.0), name="spring")
    s = carom.simulate(scene, 0.01, step=5e-3)
    return s["spring"].power, s["joint1"].coordinate, s["joint1"].force


def scenes() -> dict:
    """Return a small scene of each kind, with an impact within 0.05 s."""
    return {"free": _thrown(), "tree": _linked(False), "loops": _linked(True)}


def contact_scenes() -> dict:
    """Return scenes with persistent contact, and the duration of each [s]."""
    return {"rest": (_thrown(), 0.4), "stack": (_pile(2), 0.2), "heap": (_pile(14), 0.2)}


def _thrown():
    from carom.bench.problems import planar_die

    return planar_die.scene(0.03, spin=(10, 10, 0))


def _pile(count: int):
    """Return boxes above a floor with small gaps between them."""
    import carom

    scene = carom.Scene()
    scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    for k in range(count):
        place = (0.03 * (k % 2), 0.0, 0.011 + 0.021 * (k // 2 if count > 2 else k))
        scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.02, position=place)
    scene.set_contact_default(restitution=0.3, friction=0.5)
    return scene


def _linked(loop: bool, **breaks):
    """Return two balls on rods from the ground, one of which strikes it; joined by a rod for a loop."""
    import carom

    scene = carom.Scene()
    ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    balls = []
    for x in (0.0, 1.0):
        ball = scene.add_body(
            shape=carom.Sphere(0.1), mass=1.0, position=(x, 0, 0.105), velocity=(0, 0, -1.0),
            angular_velocity=(0, 1.0, 0),
        )  # fmt: skip
        joint = carom.joints.Revolute(anchor=(x - 1.0, 0, 0.105), axis=(0, 1, 0))
        scene.add_joint(joint, carom.GROUND, ball, **breaks)
        balls.append(ball)
    scene.add_contact(balls[0], ground, restitution=0.5, friction=0.2)
    if loop:
        scene.add_joint(carom.joints.Distance((0, 0, 0.105), (1, 0, 0.105)), *balls)
    return scene
