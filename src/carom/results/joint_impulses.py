"""Impulses of joints in impacts: what a bearing takes when something strikes.

A run keeps the velocities of the bodies before and after each impact, and the impulses P of its contacts. With
the rows A of joints and constraints at that position

    M (v+ - v-) = G^T P + R + A^T L,

where R are the impulses of inertias along joint coordinates, -I (q'+ - q'-) along each. The multipliers L are
those of least norm, where each row is weighted by its diagonal entry of A M^-1 A^T, as for reactions of joints.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import copied, table
from carom.dynamics.mobility import mass_matrix
from carom.dynamics.reactions import write_rows
from carom.geometry import quaternion
from carom.geometry.frames import contact_axes, pair_axes, turned_axes, upright
from carom.model import records as r
from carom.model.arrays import CURVE_ON_POINT, STATE
from carom.model.compile import attitudes, compile_scene
from carom.model.relations import is_inertia
from carom.model.switched import stands_of
from carom.results.dense_output import curves
from carom.results.event_tables import JointImpulse, JointImpulseTable
from carom.results.reports import at_once
from carom.scene.bodies import Body, HalfSpace
from carom.scene.coordinates import BodyTurn, Bush, Length, kind_of, terms_of
from carom.scene.more_forces import JointInertia
from carom.scene.stops import Stop
from carom.scene.surfaces import SurfaceDefinition
from carom.scene.switches import is_off
from carom.status import Status

TIMES_AT_ONCE = 256  # times at which states are computed in one go
SMALLEST = 1e-10  # singular value, relative to the greatest, below which rows depend on each other


def impulses_of(run, struck: int, part) -> tuple[np.ndarray, np.ndarray]:
    """Return times and sizes of the impulses of a joint, or of a stop, in the impacts from `struck` on."""
    rows = run.records.impact[struck : int(run.clock["struck"][0])]
    if isinstance(part, Stop):
        rows = rows[rows["contact"] == len(run.pairs.body) + part.index]
        order = np.argsort(rows["time"], kind="stable")
        return rows["time"][order], np.abs(rows["impulse"][order, 0])
    from carom.results.solution import Solution

    solution = Solution._from_run(run, Status.SUCCESS)
    within = np.nextafter(rows["time"].min(), -math.inf), math.inf
    view = run.stands.view(run.scene)
    found = [row for row in _Mechanism(solution, view, within).rows() if row[2] == part.index]
    times, sizes = np.array([row[0] for row in found]), [np.linalg.norm(row[3]) for row in found]
    return times, np.array(sizes)


def world_impulses(solution) -> np.ndarray:
    """Return the impulse of each impact on the body (K, 3), world axes [N s]; 0 at stops of coordinates."""
    impacts, pairs = solution.impacts, solution.pairs
    out = np.zeros((len(impacts), 3))
    for k in np.flatnonzero(impacts.contact < len(pairs.body)):  # stops come after contacts
        out[k] = impacts.impulse[k] @ _axes(
            solution.scene, pairs.plane[impacts.contact[k]], impacts.normal[k]
        )
    for k in np.flatnonzero(impacts.contact >= len(pairs.body)):
        joint = solution.scene.stops[impacts.contact[k] - len(pairs.body)].joint
        if isinstance(joint, Bush):
            n, a, parent = impacts.normal[k], joint.axis, joint.parent
            if isinstance(parent, Body):
                now = solution.evaluate(impacts.time[k])[1][parent.index]
                a = quaternion.rotate(now, quaternion.rotate_back(parent.orientation, a))
            out[k] = impacts.impulse[k] @ (n, np.cross(a, n), a)
        if joint.can_be_left:
            n, reports = impacts.normal[k], solution._reports
            x, Q, v, w = solution.evaluate(impacts.time[k])
            here = table(STATE, len(x))
            here["x"], here["v"], here["w"] = x, v, w
            here["Q"] = attitudes(Q, reports.compiled.to_principal)
            along = reports.motion(joint, at_once(here, impacts.time[k])).along[0, 0]
            out[k] = impacts.impulse[k] @ (n, along, np.cross(n, along))
    return out


def _axes(scene, plane: int, normal: np.ndarray) -> np.ndarray:
    """Return the axes of a contact with a fixed part, by its place in `Scene.fixed`, or of two bodies (-1)."""
    if plane < 0 or not isinstance(fixed := scene.fixed[plane], HalfSpace):
        if plane >= 0 and isinstance(fixed.shape, SurfaceDefinition):
            return turned_axes(normal, upright(scene.gravity))
        return pair_axes(normal)
    return contact_axes(normal)


def joint_impulses(solution) -> JointImpulseTable:
    """Return the table of a solution."""
    scene, rows = solution.scene, []
    if scene.joints and len(solution.impacts):
        known = solution._run
        stands = stands_of(scene, known.switched)
        ends = [*(float(solution.t[row - 1]) for row, _ in stands[1:]), math.inf]
        begins = [-math.inf, *ends[:-1]]
        for (_, stand), begin, end in zip(stands, begins, ends):
            rows += _Mechanism(solution, stand.view(scene), (begin, end)).rows()
    shapes = {"impulse": (-1, 3), "angular_impulse": (-1, 3)}
    columns = {
        name: np.array([row[k] for row in rows], np.int64 if name in ("impact", "joint") else float)
        for k, name in enumerate(JointImpulse._fields[:-1])
    }
    made = {name: np.reshape(column, shapes.get(name, -1)) for name, column in columns.items()}
    return of_joints(scene, made)


def of_joints(scene, columns: dict[str, np.ndarray]) -> JointImpulseTable:
    """Return a table of columns without names, whose joints are of a scene.

    Raises
    ------
    ValueError
        If the scene does not have a joint.
    """
    names, joint = np.array([one.name for one in scene.joints], dtype=str), columns["joint"]
    if len(joint) and not (joint.min() >= 0 and joint.max() < len(names)):
        raise ValueError(f"joints must be below {len(names)}, got {joint.max()}")
    table = JointImpulseTable(**columns, name=names[joint])
    return table._by_name({name: k for k, name in enumerate(names.tolist())}.copy)


class _Rows(NamedTuple):
    """The rows of some components: row k of a side is that of an element and a body."""

    bodies: np.ndarray  # (B,) of these components
    side: np.ndarray  # (S,) side of the solver, and its row
    of_side: np.ndarray
    row: np.ndarray  # (S,) row among all rows, and place among `bodies`
    place: np.ndarray
    count: int  # of all rows
    joints: list[tuple[int, slice, int]]  # index, rows, place of the child


class _Mechanism:
    """The joints and constraints of a scene, and the impacts of a run."""

    def __init__(self, solution, scene, within: tuple[float, float]):
        run = solution._run
        self.solution, self.scene, self.push = solution, scene, world_impulses(solution)
        self.within = within  # times after the first, up to the second
        compiled = compile_scene(scene, run.options, loops=True)  # no joint is flipped
        self.system, self.work = compiled.system, r.new_work(compiled.system, 1)
        self.functions, self.reports = compiled.functions, solution._reports
        self.children = [joint.child.index for joint in self.scene.joints]
        self.rotors = [
            force.definition for force in self.scene.forces
            if isinstance(force.definition, JointInertia) and not is_off(scene, force)
        ]  # fmt: skip
        self.mass, self.records = mass_matrix(self.system), r.trimmed(run.records, run.clock)
        self.label, self.known = _components(self.system), {}

    def rows(self):
        """Yield the rows of all impacts; those of one time are taken together."""
        event, shots, impacts = self.records.event, self.records.snapshot, self.solution.impacts
        shots = shots[np.isin(event["kind"], (r.IMPACT, r.JAMS))[shots["event"]]]
        at = event["time"][shots["event"]]
        shots, at = shots[np.argsort(at, kind="stable")], np.sort(at)
        begin, end = self.within
        inside = (impacts.time > begin) & (impacts.time <= end)
        located = np.flatnonzero((impacts.located == 1) & inside)
        times, first = np.unique(impacts.time[located], return_index=True)
        ends = np.append(first, len(located)).tolist()
        low, high = (np.searchsorted(at, times, side=side).tolist() for side in ("left", "right"))
        for begin in range(0, len(times), TIMES_AT_ONCE):
            part = times[begin : begin + TIMES_AT_ONCE]
            x, Q, v, w, _ = curves(self.solution, part, "right")
            for n, t in enumerate(part.tolist()):
                k = begin + n
                here = table(STATE, len(self.mass))
                here["x"], here["Q"], here["v"], here["w"] = x[n], Q[n], v[n], w[n]
                own = located[ends[k] : ends[k + 1]].tolist()
                yield from self.of_time(t, own, here, shots[low[k] : high[k]])

    def of_time(self, t: float, mine: list[int], state, shots):
        """Yield the rows of the impacts of one time, from the states of their bodies before and after."""
        b = np.asarray(shots["body"])
        x, Q, *ends = (np.asarray(shots[name]) for name in ("x", "Q", "v0", "w0", "v1", "w1"))
        (v0, w0, v1, w1), mass = ends, self.mass[b]
        state["x"][b], state["Q"][b] = x, Q
        change = np.zeros((len(state), 6))  # of the momenta about the mass centres, world axes
        spin = quaternion.rotate(Q, mass[:, 3:] * quaternion.rotate_back(Q, w1 - w0))
        np.add.at(change, b, np.hstack([mass[:, :3] * (v1 - v0), spin]))
        moved = np.unique(self.label[b[np.any(change[b] != 0.0, axis=1)]])
        moved = moved[np.isin(moved, self.label[self.system.solver.sides["body"]])]  # by joints
        if not len(moved):
            return
        for i in mine:
            self.add_contact(i, state, change)
        if self.rotors:
            before, after = copied(state), copied(state)
            for one, (speed, turn) in ((before, (v0[::-1], w0[::-1])), (after, (v1, w1))):
                order = b if one is after else b[::-1]  # of several impacts the first, or the last
                one["v"][order], one["w"][order] = speed, turn
            for d in self.rotors:
                rates = [
                    self.reports.motion(d.joint, at_once(one, t), d.coordinate).rate[0, 0]
                    for one in (before, after)
                ]
                self.take_along(
                    d.joint, d.coordinate, d.inertia * (rates[0] - rates[1]), state, change
                )
        yield from self.solved(t, mine[0], moved, state, change)

    def add_contact(self, i: int, state: np.recarray, rest: np.ndarray) -> None:
        """Take the impulse of impact i from the momenta of its bodies."""
        impacts, pairs = self.solution.impacts, self.solution.pairs
        number = int(impacts.contact[i])
        if number >= len(pairs.body):
            stop = self.scene.stops[number - len(pairs.body)]
            if stop.joint.can_be_left:
                self.take(stop.joint, self.push[i], state, rest)
                return
            if isinstance(stop.joint, Bush):
                self.take_at(i, stop.joint.child.index, stop.joint.parent.index, state, rest)
                return
            along = stop.side * impacts.impulse[i, 0]
            for one, k, factor in terms_of(stop.joint, stop.coordinate):
                if isinstance(one, BodyTurn):
                    rest[one.child.index, 3:] -= factor * along * one.axis
                elif isinstance(one, Length):
                    self.take_between(one, factor * along, state, rest)
                else:
                    self.take_along(one, k, factor * along, state, rest)
            return
        self.take_at(i, pairs.body[number], pairs.other[number], state, rest)

    def take_at(self, i: int, body: int, other: int, state: np.recarray, rest: np.ndarray) -> None:
        """Take the impulse of impact i at its point from both bodies, -1 for the ground."""
        for b, sign in ((body, -1.0), (other, 1.0)):
            if b >= 0:
                arm = self.solution.impacts.point[i] - state["x"][b]
                rest[b] += sign * np.append(self.push[i], np.cross(arm, self.push[i]))

    def take_between(self, length: Length, amount: float, state: np.recarray, rest: np.ndarray):
        """Take the impulse of a tether from both ends."""
        axis = amount * self.reports.motion(length, at_once(state, 0.0), 0).along[0, 0]
        number = self.reports.compiled.numbers[length.index, 0]
        row = self.reports.compiled.system.relations.coordinates[number]
        for body, anchor, sign in (
            (int(row.child), row.child_anchor, -1.0), (int(row.parent), row.parent_anchor, 1.0),
        ):  # fmt: skip
            if body >= 0:
                arm = quaternion.rotate(state["Q"][body], anchor)
                rest[body] += sign * np.append(axis, np.cross(arm, axis))

    def take_along(
        self, joint, k: int | str, amount: float, state: np.recarray, rest: np.ndarray
    ) -> None:
        """Take an impulse along a coordinate from the child, and the opposite one from the parent."""
        axis = amount * self.reports.motion(joint, at_once(state, 0.0), k).along[0, 0]
        self.take(joint, axis, state, rest, kind_of(joint, k) == "turn")

    def take(self, joint, axis: np.ndarray, state, rest: np.ndarray, turns: bool = False):
        """Take an impulse at the anchor, or about an axis, from the child, the opposite one from the parent."""
        anchor = state["x"][joint.child.index] + self.arm(joint.index, state)
        for body, sign in ((joint.child.index, -1.0), (joint.parent.index, 1.0)):
            if body >= 0 and turns:
                rest[body, 3:] += sign * axis
            elif body >= 0:
                arm = anchor - state["x"][body]
                rest[body] += sign * np.append(axis, np.cross(arm, axis))

    def arm(self, j: int, state: np.recarray) -> np.ndarray:
        """Return the arm of the child to where a joint acts: its anchor, or that of the parent on its curve."""
        one = self.system.joints[j]
        c, p = int(one.child), int(one.parent)
        if one.kind != CURVE_ON_POINT:
            return quaternion.rotate(state["Q"][c], one.child_anchor)
        if p < 0:
            return one.parent_anchor - state["x"][c]
        return state["x"][p] + quaternion.rotate(state["Q"][p], one.parent_anchor) - state["x"][c]

    def solved(self, t: float, impact: int, moved, state: np.recarray, rest: np.ndarray):
        """Yield the rows of the joints of some components, from the momenta that they have given."""
        key = tuple(moved.tolist())
        rows = self.known[key] if key in self.known else self.rows_of(moved)
        self.known[key] = rows
        self.work.moment[0].time = t
        write_rows(self.system, state, self.work)
        if self.functions.failed is not None:
            raise self.functions.failed
        A = np.zeros((rows.count, len(rows.bodies), 6))
        A[rows.row, rows.place] = np.asarray(self.system.solver.sides["A"])[rows.side, rows.of_side]
        Q, half = np.asarray(state["Q"])[rows.bodies], np.sqrt(self.mass[rows.bodies])
        scaled, own = A.copy(), rest[rows.bodies]
        scaled[..., 3:] = quaternion.rotate_back(Q, A[..., 3:])
        own[:, 3:] = quaternion.rotate_back(Q, own[:, 3:])
        scaled = (scaled / half).reshape(len(A), 6 * len(rows.bodies))
        weight = np.linalg.norm(scaled, axis=1)  # the square root of the diagonal of A M^-1 A^T
        weight[weight == 0.0] = 1.0
        share = np.linalg.lstsq((scaled / weight[:, None]).T, (own / half).ravel(), SMALLEST)[0]
        share /= weight
        for j, part, child in rows.joints:
            wrench = share[part] @ A[part, child]
            turned = np.cross(self.arm(j, state), wrench[:3])
            yield t, impact, j, wrench[:3], wrench[3:] - turned

    def rows_of(self, moved: np.ndarray) -> _Rows:
        """Return the rows of all elements in some components."""
        joints, sides = self.system.joints, self.system.solver.sides
        element, body = np.asarray(sides["element"]), np.asarray(sides["body"])
        chosen = ~is_inertia(joints)[element] & np.isin(self.label[body], moved)
        own, bodies = np.unique(element[chosen]), np.flatnonzero(np.isin(self.label, moved))
        count = joints.rows[own]
        first = np.zeros(len(joints), dtype=np.int64)
        first[own] = np.cumsum(count) - count
        side = np.repeat(np.flatnonzero(chosen), joints.rows[element[chosen]])
        of_side = np.concatenate([np.arange(n) for n in joints.rows[element[chosen]]])
        found = []
        for j in own[own < len(self.children)].tolist():
            part = slice(int(first[j]), int(first[j] + joints.rows[j]))
            found.append((j, part, int(np.searchsorted(bodies, self.children[j]))))
        row, place = first[element[side]] + of_side, np.searchsorted(bodies, body[side])
        return _Rows(bodies, side, of_side, row, place, int(count.sum()), found)


def _components(system) -> np.ndarray:
    """Return a label (N,) for each body, the same for those that joints and constraints connect."""
    label, sides = np.arange(len(system.bodies)), system.solver.sides
    while True:
        least = np.full(len(system.joints), len(label))
        np.minimum.at(least, sides["element"], label[sides["body"]])
        new = label.copy()
        np.minimum.at(new, sides["body"], least[sides["element"]])
        if np.array_equal(new, label):
            return label
        label = new
