"""Simulated motion at the times of a recording, for one recording or for many in threads."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np

from carom import arguments, checks
from carom.options import Options
from carom.scene.scene import Scene
from carom.studies.identify.recording import Recording, checked_recordings


class RollOut(NamedTuple):
    """Simulated poses of the N recorded bodies at the n times of a recording."""

    position: np.ndarray  #: (n, N, 3) mass centres [m]
    orientation: np.ndarray  #: (n, N, 4) unit quaternions
    message: str  #: empty, or the reason why the run stopped early; poses then stay the last ones
    residual: float  #: largest energy that no entry of the ledger explains [J]
    speed: float  #: largest component of the velocities [m/s], [rad/s] at the last sample


def roll_out(
    scene: Scene, recording: Recording, *, step: float | None = None, options: Options | None = None
) -> RollOut:
    """Simulate a scene from the first to the last time of a recording.

    Parameters
    ----------
    scene : Scene
        A scene whose first N bodies are the recorded ones.
    recording : Recording
        The recorded motion, for its times and its initial state.
    step : float, optional
        Longest time step [s]; the steps between two samples are equal.
        Default: a quarter of the mean sampling time.
    options : Options, optional
        As for `simulate`.

    Returns
    -------
    RollOut
        The simulated motion. If the run fails, the bodies keep their last poses from there on, and `message`
        has the reason.
    """
    from carom.simulate import simulate

    checks.instance("scene", scene, (Scene,))
    checks.instance("recording", recording, (Recording,))
    if recording.position.shape[1] > len(scene.bodies):
        raise ValueError(
            f"scene must have the {recording.position.shape[1]} bodies of the recording, got {scene!r}"
        )
    if step is not None:
        step = checks.number("step", step, above=0.0, unit="s")
    since = recording.t - recording.t[0]
    n, length = since.size, float(since[-1])
    longest = 0.25 * length / (n - 1) if step is None else step
    checks.steps(length, longest, 1e12)
    solution = simulate(
        scene, length, step=longest, save_at=since, options=options, throw=False
    )  # fmt: skip
    count = recording.position.shape[1]
    # After the end of a run that failed: its last state.
    row = np.minimum(np.arange(n), len(solution.t) - 1)
    x, q = solution.position[row], solution.orientation[row]
    speed = max(
        np.max(np.abs(solution.velocity[-1])), np.max(np.abs(solution.angular_velocity[-1]))
    )
    return RollOut(
        x[:, :count], q[:, :count], "" if solution.success else solution.message,
        float(np.max(np.abs(solution.ledger.residual))), float(speed),
    )  # fmt: skip


@arguments.formerly(threads="workers")
def roll_outs(
    make: Callable[[Recording], Scene],
    recordings: Sequence[Recording],
    *,
    step: float | None = None,
    options: Options | None = None,
    workers: int | None = None,
) -> list[RollOut]:
    """Simulate a scene for each recording, in threads.

    Parameters
    ----------
    make : callable
        Function that returns the `Scene` of a `Recording`.
    recordings : sequence of Recording
        The recorded motions.
    step, options
        As for `roll_out`.
    workers : int, optional
        Number of threads. Default: the number of cores that the process may use. The compiled loop releases the
        lock of the interpreter, so threads run in parallel.
    """
    checks.function("make", make)
    recordings = checked_recordings(recordings)
    if workers is not None:
        workers = checks.integer("workers", workers, least=1)

    def one(recording: Recording) -> RollOut:
        scene = checks.call("make", make, recording)
        checks.instance("the result of make", scene, (Scene,))
        return roll_out(scene, recording, step=step, options=options)

    workers = cores() if workers is None else workers
    first = [one(recording) for recording in recordings[:1]]  # compiles all code, once
    if workers == 1 or len(recordings) < 3:
        return first + [one(recording) for recording in recordings[1:]]
    with ThreadPoolExecutor(workers) as pool:
        return first + list(pool.map(one, recordings[1:]))


def cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
