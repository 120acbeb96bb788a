"""Throws of the die of the paper to rest: how many a second, on one thread and on all, beside MuJoCo."""

from __future__ import annotations

import os
import time

import numpy as np

import carom
from common import die_scene, peer, report

COUNT, ROUNDS = 400, 3
DURATION = 2.0  # [s]


def carom_rate(step: float, workers: int) -> tuple[list[float], object]:
    """Return throws a second (wall time) of each round, and the last ensemble."""
    scene, found = die_scene(), []
    names = f"{scene.bodies[0].name}.orientation"
    vary = {names: carom.UniformOrientation()}
    carom.ensemble(scene, DURATION, step=step, vary=vary, runs=30)
    for seed in range(ROUNDS):
        begin = time.perf_counter()
        thrown = carom.ensemble(
            scene, DURATION, step=step, vary=vary, runs=COUNT, seed=seed, workers=workers, chunk=25
        )
        found.append(COUNT / (time.perf_counter() - begin))
    return found, thrown


def mujoco_rate(mujoco, step: float) -> list[float]:
    """Return the same of MuJoCo on one thread: contact as a spring and damper, 500 rad/s, of about e = 0.5."""
    frequency, ratio = 500.0, 0.2155
    model = mujoco.MjModel.from_xml_string(f"""
    <mujoco><option timestep="{step}" integrator="implicitfast" cone="elliptic" impratio="10">
    <flag refsafe="disable"/></option><default><geom condim="3" friction=".2 0 0" solimp=".999 .999 .001"
    solref="{-(frequency**2)} {-2 * ratio * frequency}"/></default>
    <worldbody><geom type="plane" size="0 0 1"/><body pos="0 0 .3"><freejoint/>
    <geom type="box" size=".01 .01 .01" mass=".016"/></body></worldbody></mujoco>""")
    data, found = mujoco.MjData(model), []
    for seed in range(ROUNDS):
        turns = np.random.default_rng(seed).normal(size=(COUNT // 10, 4))
        begin = time.perf_counter()
        for turn in turns / np.linalg.norm(turns, axis=1, keepdims=True):
            mujoco.mj_resetData(model, data)
            data.qpos[:] = [0, 0, 0.3, *turn]
            data.qvel[:3] = [0.5, 0, -0.5]
            data.qvel[3:] = [0, 10, 0]
            mujoco.mj_step(model, data, nstep=round(DURATION / step))
        found.append(len(turns) / (time.perf_counter() - begin))
    return found


def row(name: str, step: float, workers: int, rates: list[float], note: str) -> list[str]:
    """Return a row of the table."""
    low, mid, high = np.min(rates), np.median(rates), np.max(rates)
    return [name, f"{1e3 * step:g} ms", str(workers), f"{mid:.0f} ({low:.0f} to {high:.0f})", note]


def main() -> None:
    """Measure and report."""
    rows = []
    cores = os.cpu_count() or 1
    for step in (1e-3, 2e-3, 5e-3):
        for workers in (1, cores):
            rates, thrown = carom_rate(step, workers)
            rest = np.sum(np.isfinite(thrown.rest_time))
            note = f"{thrown.impacts.mean():.0f} impacts, {100 * rest / len(thrown):.0f} % at rest"
            rows.append(row("carom", step, workers, rates, note))
    mujoco = peer("mujoco")
    if mujoco:
        rows.append(row("MuJoCo", 1e-3, 1, mujoco_rate(mujoco, 1e-3), "springs and dampers"))
    report(
        "ensembles", f"Throws of a die, {DURATION:g} s each, a second",
        ["tool", "step", "threads", "throws a second of wall time", "of a throw"], rows,
        f"Orientation uniformly random; medians of {ROUNDS} rounds (least to greatest).",
    )  # fmt: skip


if __name__ == "__main__":
    main()
