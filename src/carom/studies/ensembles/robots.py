"""Ensembles of robots: coordinates, velocities and controls of a model as names of values."""

from __future__ import annotations

import numpy as np

from carom import checks
from carom.control.live import place
from carom.results.robot import Robot
from carom.results.state import SystemState
from carom.scene.scene import Scene
from carom.studies.values import Target

#: names of all coordinates and velocities of a model, and what one hinge or slide has of them
PLACED = {"qpos": "coordinate", "qvel": "rate"}


def of_scene(scene: Scene, inputs: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return inputs with controls by the names of forces, and coordinates of joints within `qpos` and `qvel`.

    Raises
    ------
    ValueError
        If the scene has no model, arrays have a wrong shape, or a coordinate is given twice.
    """
    own = [name for name in inputs if name in (*PLACED, "ctrl") or _joint(scene, name)]
    if not own:
        return inputs
    robot = scene.robot
    if robot is None:
        raise ValueError(
            f"vary[{own[0]!r}] must be left out: only a scene of load_model has coordinates of a model"
        )
    made = {name: rows for name, rows in inputs.items() if name not in own}
    for name in PLACED:
        rows = _rows(robot, name, {one: inputs[one] for one in own})
        if rows is not None:
            made[name] = rows
    if "ctrl" in own:
        made |= _controls(robot, inputs, made)
    return made


def targets_of(values: dict[str, np.ndarray]) -> list[Target]:
    """Return the destination of coordinates and velocities of a model."""
    return [Target(name, "", name, -1, True) for name in PLACED if name in values]


def put(run, targets: list[Target], values: dict[str, np.ndarray]) -> None:
    """Move the bodies of a run before its first step to the coordinates of a model in the values of one run."""
    given = {target.name: values[target.name] for target in targets if target.field in PLACED}
    if given:
        place(run, SystemState(run), given.get("qpos"), given.get("qvel"))
        run.clock["saved"] = 0
        run.save_now()


def _joint(scene: Scene, name: str) -> str:
    """Return the name of the hinge or slide of a model of which this is the coordinate or the rate."""
    joint, _, what = name.rpartition(".")
    known = () if scene.robot is None else scene.robot.joints
    return joint if what in PLACED.values() and joint in known else ""


def _rows(robot: Robot, whole: str, given: dict[str, np.ndarray]) -> np.ndarray | None:
    """Return `qpos` or `qvel` (R, n) of all runs, None where nothing of it varies."""
    single = {name: rows for name, rows in given.items() if name.endswith(f".{PLACED[whole]}")}
    base = robot.start if whole == "qpos" else np.zeros(robot.nv)
    if whole in given:
        if single:
            raise ValueError(f"vary must have {whole!r} or {next(iter(single))!r}, got both")
        return _checked(whole, given[whole], (len(base),))
    if not single:
        return None
    runs = len(next(iter(single.values())))
    rows = np.repeat(base[None], runs, axis=0)
    for name, values in single.items():
        one = robot.joints[name.rpartition(".")[0]]
        at = one.position if whole == "qpos" else one.velocity
        rows[:, at] = _checked(name, values, ())
    return rows


def _controls(robot: Robot, inputs: dict, made: dict) -> dict[str, np.ndarray]:
    """Return the control of each force of an actuator, by its name."""
    rows = _checked("ctrl", inputs["ctrl"], (len(robot.motors),))
    found = {
        f"{part.name}.control": rows[:, k]
        for k, one in enumerate(robot.motors)
        for part in one.parts
    }
    twice = found.keys() & made.keys()
    if twice:
        raise ValueError(f"vary must have 'ctrl' or {min(twice)!r}, got both")
    return found


def _checked(name: str, rows, shape: tuple[int, ...]) -> np.ndarray:
    rows = checks.real_array(f"vary[{name!r}]", rows, str(("runs", *shape)))
    if rows.shape[1:] != shape:
        wanted = ", ".join(["runs", *map(str, shape)])
        raise ValueError(f"vary[{name!r}] must have shape ({wanted}), got {rows.shape}")
    if not np.all(np.isfinite(rows)):
        k = int(np.argwhere(~np.isfinite(rows))[0][0])
        raise ValueError(f"vary[{name!r}] must be finite, got {rows[k]} in run {k}")
    return rows
