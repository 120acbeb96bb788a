"""Reactions where dry friction acts in joints: a run does not save its forces.

While a joint slips, the force is its bound against the motion, by a law that at its rate. While it sticks, the
force is that of a motor at rest in the place of the friction; where this exceeds the bound of stick, the joint
is about to slip, and has the force of slip.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from carom._compiled.record_arrays import Columns, table
from carom.kinematics.coordinates.turns import TURN
from carom.model.arrays import RELATION
from carom.model.compile import compile_scene
from carom.model.records import TOUCH
from carom.results.exerted import bodies_of, rubs
from carom.scene.constraints import Coupling, Driver
from carom.scene.coordinates import Combination, coordinate_kind, kind_of, terms_of
from carom.scene.friction import bound_of
from carom.scene.more_forces import Drive, JointFriction

STILL = 1e-9  # of the speeds of the joint: below it the rate is round-off, and the joint sticks
ABOVE = 1.0 + 1e-9  # of the bound: a force up to this sticks


def with_dry_friction(run, states, touch, solve) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """Return the reactions (T, E, 6), on the children, and the values (T,) of dry frictions by index.

    Parameters
    ----------
    run : the run, with its scene, options and compiled scene
    states : the solution, or the state
    touch : active points at these times
    solve : ``solve(compiled, touch)`` returns reactions on the children
    """
    scene, saved = run.scene, states._saved
    dry = [force for force in scene.forces if rubs(force)]
    if not dry:
        return solve(run.compiled, touch), {}
    laws: list[Any] = [force.definition for force in dry]
    read = [states._reports.motion(d.joint, saved, d.coordinate) for d in laws]
    q, rate = (np.hstack([one[name] for one in read]) for name in ("value", "rate"))
    rate = rate - np.column_stack([_goal(d, saved.series["t"]) for d in laws])
    turns = np.round(q / TURN)
    sticks = np.abs(rate) <= STILL * np.array([_speed(d, saved.state) for d in laws])
    most = np.array([bound_of(d.bound) for d in laws])
    rows = np.cumsum([0] + [len(bodies_of(force)) for force in dry])[:-1]  # the first of each
    slip = states._reports.exerted(dry, saved, ((0, len(q)),), {}).value[:, rows]
    bound, value = np.abs(slip), np.where(sticks, 0.0, slip)
    while True:
        values = {force.index: value[:, k] for k, force in enumerate(dry)}
        full = with_forces(states, values, touch)
        out = solve(run.compiled, full)
        alike = np.hstack([sticks, np.where(sticks, turns, 0.0)])
        for each in np.unique(alike[np.any(sticks, axis=1)], axis=0):
            held = each[: len(laws)] == 1.0
            made = scene.copy()
            for k in np.flatnonzero(held):
                made.add_constraint(_held(laws[k]))
            rows = np.flatnonzero(np.all(alike == each, axis=1))
            first = len(scene.joints) + len(scene.constraints)
            compiled = compile_scene(made, run.options)
            _turned(compiled.system, TURN * each[len(laws) :][held])
            found = solve(compiled, full)[rows]
            out[rows, :first] = found[:, :first]
            value[np.ix_(rows, np.flatnonzero(held))] = found[:, first : first + held.sum(), 0]
        beyond = sticks & (np.abs(value) > ABOVE * most)
        if not beyond.any():
            return out, {force.index: value[:, k] for k, force in enumerate(dry)}
        value = np.where(sticks & ~beyond, 0.0, np.where(beyond, bound * np.sign(value), value))
        sticks = sticks & ~beyond


def _goal(d: JointFriction, t: np.ndarray) -> np.ndarray:
    """Return the rate (T,) against which friction acts: that of a drive, else 0."""
    return d.rates(t) if isinstance(d, Drive) else np.zeros(len(t))


def _held(d: JointFriction) -> Driver | Coupling:
    """Return the motor in the place of a friction: at rest, or with the accelerations of a drive."""
    if isinstance(d.joint, Combination):
        return Coupling({(joint.name, k): factor for joint, k, factor in d.joint.terms})
    if isinstance(d, Drive) and d.motion is not None:
        return Driver(d.joint.name, motion=d.motion, coordinate=d.coordinate)
    return Driver(d.joint.name, rate=0.0, coordinate=d.coordinate)


def _turned(system, angles: np.ndarray) -> None:
    """Let the motors that were added last hold these angles: whole turns are counted from them."""
    own = system.joints["number"][system.joints["kind"] == RELATION]
    system.relations.relations["constant"][np.sort(own)[-len(angles) :]] = angles


def _speed(d: JointFriction, states) -> float:
    """Return the greatest speed of the child [rad/s or m/s], or if greater what the friction gives it.

    The work of the bound over a radian, or over the radius of gyration r, is about that of the speed.
    """
    child, turns = d.joint.child, kind_of(d.joint, d.coordinate) == "turn"
    moves = states["w" if turns else "v"]
    moment = float(np.trace(child.inertia))  # about m r^2
    bound = bound_of(d.bound)
    given = bound / moment if turns else bound * np.sqrt(moment / child.mass) / child.mass
    return max(np.sqrt(given), np.max(np.linalg.norm(moves[:, child.index], axis=-1)))


def with_forces(states, values: dict[int, np.ndarray], touch) -> np.recarray:
    """Return active points, and the values (T,) of dry frictions as such points, in the order of time."""
    dry = [force for force in states._scene.forces if rubs(force)]
    points = [
        _touches(joint, k, factor * values[force.index], states)
        for force in dry
        for joint, k, factor in terms_of(force.definition.joint, force.definition.coordinate)
    ]
    full = np.concatenate([touch, *points])
    return full[np.argsort(full["saved"], kind="stable")].view(Columns)


def _touches(joint: Any, k: Any, value: np.ndarray, states) -> np.ndarray:
    """Return forces along a coordinate as active points, one for each time."""
    child, parent = joint.child.index, joint.parent.index
    motion, x = states._reports.motion(joint, states._saved, k), states._saved.state["x"]
    axis, arm = motion.along[:, 0] * value[:, None], motion.arm[:, 0]
    rows = table(TOUCH, len(value))
    rows["saved"], rows["body"], rows["other"] = range(len(value)), child, parent
    if coordinate_kind(joint, k) == "turn":
        rows["moment"], rows["other_moment"] = axis, -axis
        return rows
    beside = arm + x[:, child] - (x[:, parent] if parent >= 0 else 0.0)
    rows["push"], rows["moment"] = axis, np.cross(arm, axis)
    rows["other_moment"] = -np.cross(beside, axis)
    return rows
