"""What becomes of the models of others: each is loaded and dropped on a floor.

python benchmarks/corpus.py FOLDER [FOLDER ...] [--seconds 60]

Every MJCF and URDF file below the folders (of the packages gymnasium, dm_control, gymnasium_robotics,
example-robot-data, pybullet) is loaded and simulated for 1 s in a child process with a limit of processor time.
A model without a plane gets a floor 2 cm below it, and a URDF with one root a free one. A MJCF file that MuJoCo
itself does not compile is counted, but not listed (a part of another file). The table has the time to load, and
the processor time of a second run of the scene over the time that it covers. `differs` is the first time at
which a body of the model without contacts is off by 1e-6 of its extent from MuJoCo (Runge-Kutta, .1 ms, without
contacts, actuators and limits) within .2 s; soft constraints, tendons and what the report names differ.
"""

from __future__ import annotations

import argparse
import json
import math
import signal
import subprocess
import sys
import time
import warnings
from collections import Counter
from pathlib import Path

DURATION = 1.0  # [s]
BELOW = 0.02  # of the floor below the model [m]
WAITS = 20  # wall time that a model may take, by its processor time
BESIDE, STEP, NEAR = (
    0.2,
    1e-4,
    1e-6,
)  # MuJoCo beside carom: duration and step [s], error by the extent


def read(path: Path):
    """Return a specification of a model with a floor, the path of a URDF, None for what does not compile."""
    import mujoco
    import numpy as np

    if path.suffix == ".urdf":  # MuJoCo makes its root a part of the world
        return path
    try:
        spec = mujoco.MjSpec.from_file(str(path))
        m = spec.compile()
    except ValueError:
        return None
    if m.nv == 0:
        return None
    if not np.any(m.geom_type == mujoco.mjtGeom.mjGEOM_PLANE):
        d = mujoco.MjData(m)
        mujoco.mj_forward(m, d)
        low = np.min(d.geom_xpos[:, 2] - m.geom_rbound, initial=0.0)
        floor = spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1])
        floor.pos = [0, 0, low - BELOW]
    return spec


def one(path: Path, seconds: float, runs: bool) -> None:
    """Print a line of JSON for each stage that a model reaches within some seconds of processor time."""
    import resource

    import carom

    resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(seconds), math.ceil(seconds) + 1))
    warnings.simplefilter("ignore")
    spec = read(path)
    if spec is None:
        say(stage="no model")
        return
    say(stage="reads")
    begin, how = time.process_time(), {"restitution": 0.2, "free_root": path.suffix == ".urdf"}
    try:
        try:
            model = carom.load_model(spec, **how)
        except ValueError as error:
            if "free_root" not in str(error):
                raise
            model = carom.load_model(spec, **how | {"free_root": False})
    except Exception as error:
        say(stage="refused", message=f"{type(error).__name__}: {error}")
        return
    say(stage="loads", bodies=len(model.scene.bodies), load=time.process_time() - begin)
    if spec is path and not model.scene.half_spaces:
        low = min(
            (b.position[2] - b.shape.size for b in model.scene.bodies if b.shape), default=0.0
        )
        model.scene.add_half_space((0, 0, low - BELOW), (0, 0, 1))
    if not runs:
        return
    carom.simulate(model.scene, 1e-3, throw=False)  # compiles
    begin = time.process_time()
    solution = carom.simulate(model.scene, DURATION, throw=False)
    wall, reached = time.process_time() - begin, float(solution.t[-1])
    ratio = wall / reached if reached > 0.0 else float("inf")
    say(stage="runs", status=solution.status.name, reached=reached, ratio=ratio,
        message=solution.message)  # fmt: skip
    try:
        say(differs=beside(model.mujoco))
    except Exception as error:
        say(differs=f"{type(error).__name__}: {error}"[:60])


def beside(m) -> float | None:
    """Return the first time at which carom and MuJoCo are apart without contacts, limits and motors; None."""
    import mujoco
    import numpy as np

    import carom

    off = mujoco.mjtDisableBit
    m.opt.disableflags |= int(off.mjDSBL_CONTACT | off.mjDSBL_ACTUATION | off.mjDSBL_LIMIT)
    m.opt.integrator, m.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, STEP
    model, d = carom.load_model(m, contacts=False), mujoco.MjData(m)
    d.qpos[:] = model.qpos(carom.simulate(model.scene, 1e-6, throw=False))[0]
    solution = carom.simulate(model.scene, BESIDE, save_at=10 * STEP, throw=False)
    q, place = model.qpos(solution), mujoco.MjData(m)
    for k, t in enumerate(solution.t):
        while d.time < t - 0.5 * STEP:
            mujoco.mj_step(m, d)
        place.qpos[:] = q[k]
        for one in (d, place):
            mujoco.mj_kinematics(m, one)
            mujoco.mj_comPos(m, one)
        if not np.max(np.abs(place.xipos - d.xipos)) <= NEAR * m.stat.extent:
            return float(t)
    return None


def say(**row) -> None:
    """Print a line that the parent process reads."""
    print(json.dumps(row), flush=True)


def outcome(path: Path, seconds: float, runs: bool) -> dict:
    """Return what a child process printed, and how it ended."""
    child = [sys.executable, __file__, "--one", str(path), "--seconds", str(seconds)]
    child += [] if runs else ["--loads"]
    row: dict = {"stage": "hangs", "ratio": float("inf")}
    try:
        done = subprocess.run(child, capture_output=True, text=True, timeout=WAITS * seconds)
        text = done.stdout
        row["stage"] = (
            "hangs" if done.returncode == -signal.SIGXCPU else f"died ({done.returncode})"
        )
        row["message"] = done.stderr.strip().rpartition("\n")[2]
    except subprocess.TimeoutExpired as error:
        text = error.stdout.decode() if isinstance(error.stdout, bytes) else error.stdout or ""
    for line in text.splitlines():
        if line.startswith("{"):
            found = json.loads(line)
            ended = found.get("stage") in ("no model", "refused", "runs")
            ended = ended or (not runs and found.get("stage") == "loads")
            row |= found if ended else {k: v for k, v in found.items() if k != "stage"}
    return row


def main() -> None:
    """Run all models and print the table, the slowest first."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument(
        "--rows", type=Path, help="file to which the rows are added as lines of JSON"
    )
    parser.add_argument("--seconds", type=float, default=60.0, help="processor time of each model")
    parser.add_argument("--loads", action="store_true", help="load the models only")
    parser.add_argument("--one", action="store_true", help="a single file, in this process")
    given = parser.parse_args()
    if given.one:
        one(given.folders[0], given.seconds, not given.loads)
        return
    rows, counts = [], Counter()
    for folder in given.folders:
        for path in sorted({*folder.rglob("*.xml"), *folder.rglob("*.urdf")}):
            row = {
                "model": str(path.relative_to(folder.parent)),
                **outcome(path, given.seconds, not given.loads),
            }
            counts[row.get("status", row["stage"])] += 1
            if row["stage"] != "no model":
                rows.append(row)
                print(line_of(row), file=sys.stderr, flush=True)
                if given.rows:
                    with given.rows.open("a") as file:
                        file.write(json.dumps(row) + "\n")
    rows.sort(key=lambda row: -row.get("ratio", -1.0))
    print(
        f"| {'model':50} | bodies | load [s] | outcome | reached [s] | wall/real | differs [s] |  |"
    )
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    print("\n".join(map(line_of, rows)))
    print(dict(counts))


def line_of(row: dict) -> str:
    """Return a line of the table."""
    ratio = f"{row['ratio']:.3g}" if "ratio" in row else ""
    result, message = row.get("status", row["stage"]), str(row.get("message", ""))[:110]
    message = message if result != "SUCCESS" else ""
    reached = f"{row['reached']:.3g}" if "reached" in row else ""
    load = f"{row['load']:.2g}" if "load" in row else ""
    differs = "" if "differs" not in row else "no" if row["differs"] is None else row["differs"]
    return (
        f"| {row['model']:50} | {row.get('bodies', '')} | {load} | {result} | {reached} | {ratio} | "
        f"{differs} | {message} |"
    )


if __name__ == "__main__":
    main()
