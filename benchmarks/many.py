"""Many bodies that touch, throws, and the first run of a process: carom beside MuJoCo, in turn.

Ratios are of runs one after the other, so that the load of the machine cancels. A run of more than `LONG`
seconds is not repeated.
"""

from __future__ import annotations

import os
import subprocess
import sys
import warnings
from collections.abc import Callable
from functools import partial
from types import ModuleType

import carom
from carom.bench.many import ALL, STEP, Many
from carom.bench.problems import spatial_die
from common import FEW, ROUNDS, clock, peer, report, spread

LONG = 10.0
THROWS, THEIR_THROWS = (10, 2) if FEW else (100, 10)
HOW = ({}, {"rtol": 1e-4}, {"step": STEP})
SCENES = [make() for make in ALL]
if FEW:
    SCENES = [one._replace(duration=0.02) for one in SCENES]
Row = list[str]

#: first results of a process: each prints the processor time of all of it
STARTS = {
    "a die thrown to rest": """
import carom
scene = carom.Scene()
scene.add_half_space((0, 0, 0), (0, 0, 1))
scene.set_contact_default(restitution=0.5, friction=0.3)
scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.01, position=(0, 0, 0.3), angular_velocity=(3, 5, 7))
carom.simulate(scene, 3.0)
""",
    "a pendulum, 2 s": """
import carom
scene = carom.Scene()
rod = scene.add_body(carom.Box(1, 0.02, 0.02), mass=1, position=(0.5, 0, 0))
scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, rod)
carom.simulate(scene, 2.0)
""",
}
THEIR_START = """
import mujoco
model = mujoco.MjModel.from_xml_string('''<mujoco><option timestep="0.001"/><worldbody>
<geom type="plane" size="1 1 1"/><body pos="0 0 .3"><freejoint/><geom type="box" size=".01 .01 .01" mass=".01"/>
</body></worldbody></mujoco>''')
data = mujoco.MjData(model)
mujoco.mj_step(model, data, nstep=1000)
"""


def seconds(run: Callable[[], object]) -> float:
    """Return the processor time of one run."""
    begin = clock()
    run()
    return clock() - begin


def in_turn(ours: Callable[[], float], theirs: Callable[[], float] | None, rounds: int) -> Row:
    """Return the cells of both times and of their ratio: medians and quartiles of rounds."""
    times: list[tuple[float, float]] = []
    while len(times) < rounds and not (times and times[-1][0] > LONG):
        times.append((ours(), theirs() if theirs is not None else float("nan")))
    both = [spread([one[k] for one in times]) for k in (0, 1)]
    ratio = spread([a / b for a, b in times])
    return [*both, ratio] if theirs is not None else [both[0], "-", "-"]


def named(how: dict) -> str:
    """Return a step or a tolerance in words."""
    return f"{1e3 * how['step']:g} ms" if "step" in how else f"rtol {how.get('rtol', 1e-8):.0e}"


def of_many(many: Many, mujoco: ModuleType | None) -> list[Row]:
    """Return the rows of a scene: one for each setting."""
    theirs = None if mujoco is None else partial(seconds, partial(many.run_mujoco, mujoco))
    carom.simulate(many.scene(), 2 * STEP, throw=False)  # loads compiled code
    rows = []
    for how in HOW:
        found = []

        def run(how: dict = how, found: list = found):
            found[:] = [carom.simulate(many.scene(), many.duration, throw=False, **how)]

        cells = in_turn(partial(seconds, run), theirs, 3 if FEW else ROUNDS)
        stats = found[0].stats
        steps = f"{stats['trial_steps']} trial, {stats['whole_steps']} time-stepping"
        rows.append([many.title, named(how), *cells, steps])
    return rows


def of_throws(mujoco: ModuleType | None) -> list[Row]:
    """Return the rows of throws of a die."""
    rows, rounds = [], range(3 if FEW else ROUNDS)
    for rtol in (1e-4, 1e-8):
        ours = iter([partial(spatial_die.rate, THROWS, k, timer=clock, rtol=rtol) for k in rounds])
        theirs = iter([
            partial(spatial_die.mujoco_rate, mujoco, STEP, THEIR_THROWS, k, clock) for k in rounds
        ])  # fmt: skip
        spatial_die.throws(10, rtol=rtol)
        cells = in_turn(
            lambda ours=ours: 1.0 / next(ours)(),
            None if mujoco is None else lambda theirs=theirs: 1.0 / next(theirs)(), len(rounds),
        )  # fmt: skip
        rows.append(["a throw of a die to rest, 2 s", named({"rtol": rtol}), *cells, ""])
    return rows


def fresh(code: str) -> float:
    """Return the processor time of a process up to the end of its code."""
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": ""}  # installed packages have bytecode
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\nimport time\nprint(time.process_time())"],
        env=environment, capture_output=True, text=True, check=True,
    )  # fmt: skip
    return float(done.stdout)


def of_starts(mujoco: ModuleType | None) -> list[Row]:
    """Return the rows of first results in a process, with everything on disk."""
    theirs = None if mujoco is None else partial(fresh, THEIR_START)
    rows = []
    for name, code in STARTS.items():
        fresh(code)
        cells = in_turn(partial(fresh, code), theirs, 3 if FEW else 2 * ROUNDS + 1)
        rows.append([f"first result of a process: {name}", named({}), *cells, ""])
    return rows


def main() -> None:
    """Measure and report."""
    warnings.simplefilter("ignore")
    mujoco = peer("mujoco")
    rows = [row for many in SCENES for row in of_many(many, mujoco)]
    rows += [*of_throws(mujoco), *of_starts(mujoco)]
    report(
        "many", "Many bodies that touch, beside MuJoCo",
        ["what", "carom by", "carom [s]", "MuJoCo, 1 ms [s]", "times MuJoCo's", "steps of carom"],
        [[cell if isinstance(cell, str) else cell.text() for cell in row] for row in rows],
        f"Runs in turn; ratios of each turn. A run of more than {LONG:g} s was made once. A first result is "
        "timed from the start of the process, with imports; MuJoCo's has 1000 steps.",
    )  # fmt: skip


if __name__ == "__main__":
    main()
