"""Reactions where dry friction acts in joints: a run does not save its forces.

While a joint slips, the force is its bound against the motion, by a law that at its rate. While it sticks, the
force is that of a motor at rest in the place of the friction; where this exceeds the bound of stick, the joint
is about to slip, and has the force of slip. A bound by load follows the reactions.
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
from carom.scene.joint_friction import Drive, DryFriction
from carom.scene.switches import is_off

STILL = 1e-9  # of the speeds of the joint: below it the rate is round-off, and the joint sticks
ABOVE = 1.0 + 1e-9  # of the bound: a force up to this sticks
LOAD_TURNS, CHANGE = 100, 1e-13  # until friction by load and its loads agree


def with_dry_friction(run, states, touch, solve) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """Return the reactions (T, E, 6), on the children, and the values (T,) of dry frictions by index.

    Friction by load and the reactions that are its load follow each other in rounds, as in a step.

    Parameters
    ----------
    run : the run, with its scene, options and compiled scene
    states : the solution, or the state
    touch : active points at these times
    solve : ``solve(compiled, touch)`` returns reactions on the children
    """
    dry = dry_of(run.scene)
    if not dry:
        return solve(run.compiled, touch), {}
    joints = _DryJoints(run, states, touch, solve, dry)
    bears, step, before = joints.loads(None, None), np.zeros(1), np.zeros(1)
    for turn in range(LOAD_TURNS):
        out, value = joints.solve_under(bears)
        found = joints.loads(out, value)
        error = found - bears
        if np.all(np.abs(error) <= CHANGE * found):
            break
        # by the secant of each, since friction may lower its own load by more than itself (`joint_load`)
        with np.errstate(divide="ignore", invalid="ignore"):
            part = step / (before - error) if turn > 0 else np.ones(error.shape)
        part = np.where(np.isfinite(part) & (part > 0.0) & (bears + part * error >= 0.0), part, 1.0)
        step, before = part * error, error
        bears = bears + step
    else:  # times at which they do not agree have no values
        lost = np.any(~(np.abs(error) <= STILL * found), axis=1)
        out[lost], value[lost] = np.nan, np.nan
    return out, {force.index: value[:, k] for k, force in enumerate(dry)}


def dry_of(scene) -> list[Any]:
    """Return the dry frictions of a scene that are not switched off."""
    return [force for force in scene.forces if rubs(force) and not is_off(scene, force)]


class _DryJoints:
    """The n dry frictions of a run at T saved states."""

    def __init__(self, run, states, touch, solve, dry: list):
        self.run, self.states, self.touch, self.solve, self.dry = run, states, touch, solve, dry
        saved, reports = states._saved, states._reports
        self.laws: list[Any] = [force.definition for force in dry]
        read = [reports.motion(d.joint, saved, d.coordinate) for d in self.laws]
        q, rate = (np.hstack([one[name] for one in read]) for name in ("value", "rate"))
        rate = rate - np.column_stack([_goal(d, saved.series["t"]) for d in self.laws])
        self.turns = np.round(q / TURN)
        self.sticks = np.abs(rate) <= STILL * np.array([_speed(d, saved.state) for d in self.laws])
        self.arm = np.array([d.load["arm"] for d in self.laws])
        self.most = self.arm * np.array([bound_of(d.law) for d in self.laws])
        rows = np.cumsum([0] + [len(bodies_of(force)) for force in dry])[:-1]  # the first of each
        found = reports.exerted(dry, saved, ((0, len(q)),), {}).value[:, rows]
        self.slip = self.arm * found  # under a load of 1
        self.made: dict[bytes, Any] = {}  # scenes in which some joints are held

    def loads(self, out: np.ndarray | None, value: np.ndarray | None) -> np.ndarray:
        """Return what bears on each friction (T, n): 1, or the load by the reactions and values found."""
        bears = np.ones(self.slip.shape)
        by_load = [k for k, d in enumerate(self.laws) if d.by_load]
        if out is None or value is None:
            bears[:, by_load] = 0.0
        elif by_load:
            found = self.states._reports.loads(self.states._saved, out, self.dry, value / self.arm)
            bears[:, by_load] = found[:, by_load]
        return bears

    def solve_under(self, bears: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return reactions (T, E, 6) and values (T, n) of frictions under what bears on them."""
        sticks, slip, most = self.sticks, self.slip * bears, self.most * bears
        value = np.where(sticks, 0.0, slip)
        while True:
            values = {force.index: value[:, k] for k, force in enumerate(self.dry)}
            full = with_forces(self.states, values, self.touch)
            out = self.solve(self.run.compiled, full)
            alike = np.hstack([sticks, np.where(sticks, self.turns, 0.0)])
            for each in np.unique(alike[np.any(sticks, axis=1)], axis=0):
                held, first = each[: len(self.dry)] == 1.0, self.rows_before
                rows = np.flatnonzero(np.all(alike == each, axis=1))
                found = self.solve(self.held(each), full)[rows]
                out[rows, :first] = found[:, :first]
                value[np.ix_(rows, np.flatnonzero(held))] = found[:, first : first + held.sum(), 0]
            beyond = sticks & (np.abs(value) > ABOVE * most)
            if not beyond.any():
                return out, value
            about = np.abs(slip) * np.sign(value)
            value = np.where(sticks & ~beyond, 0.0, np.where(beyond, about, value))
            sticks = sticks & ~beyond

    @property
    def rows_before(self) -> int:
        """Number of joints and constraints of the scene, before those that hold joints."""
        return len(self.run.scene.joints) + len(self.run.scene.constraints)

    def held(self, each: np.ndarray):
        """Return the compiled scene in which motors hold joints, with their whole turns."""
        count, key = len(self.dry), each.tobytes()
        held = each[:count] == 1.0
        if key not in self.made:
            made = self.run.scene.copy()
            for k in np.flatnonzero(held):
                made.add_constraint(_held(self.laws[k]))
            self.made[key] = compile_scene(made, self.run.options)
        _turned(self.made[key].system, TURN * each[count:][held])
        return self.made[key]


def _goal(d: DryFriction, t: np.ndarray) -> np.ndarray:
    """Return the rate (T,) against which friction acts: that of a drive, else 0."""
    return d.rates(t) if isinstance(d, Drive) else np.zeros(len(t))


def _held(d: DryFriction) -> Driver | Coupling:
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


def _speed(d: DryFriction, states) -> float:
    """Return the greatest speed of the child [rad/s or m/s], or if greater what the friction gives it.

    The work of the bound over a radian, or over the radius of gyration r, is about that of the speed.
    """
    child, turns = d.joint.child, kind_of(d.joint, d.coordinate) == "turn"
    moves = states["w" if turns else "v"]
    moment = float(np.trace(child.inertia))  # about m r^2
    bound = 0.0 if d.by_load else bound_of(d.bound)  # a load is that of the motion
    given = bound / moment if turns else bound * np.sqrt(moment / child.mass) / child.mass
    return max(np.sqrt(given), np.max(np.linalg.norm(moves[:, child.index], axis=-1)))


def with_forces(states, values: dict[int, np.ndarray], touch) -> np.recarray:
    """Return active points, and the values (T,) of dry frictions as such points, in the order of time."""
    dry = dry_of(states._scene)
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
