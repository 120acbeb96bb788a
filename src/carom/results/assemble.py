"""The arrays of a solution, made from the records of a run."""

from __future__ import annotations

from contextlib import contextmanager
from typing import NamedTuple

import numpy as np

from carom._compiled.record_arrays import Columns, copied
from carom.geometry import quaternion
from carom.impact.layout import AT_END, WEDGED
from carom.model import records as r
from carom.model.laws import law_of
from carom.results import small_deflections, stiff_forces, waves
from carom.results.accuracy import sentences
from carom.results.beyond_bounds import beyond_bounds
from carom.results.costs import busiest
from carom.results.dry_friction import with_dry_friction, with_forces
from carom.results.event_tables import (
    ContactTable,
    EventTable,
    ImpactTable,
    SwitchTable,
    contact_table,
)
from carom.results.impact_remarks import remarks
from carom.results.locks import locked
from carom.results.names import (
    arms,
    constrained,
    contact_name,
    contact_names,
    restitution_of,
    row_units,
)
from carom.results.ropes import tipped_strands
from carom.results.stiff_impacts import stiff_impacts
from carom.results.tipped_profiles import tipped
from carom.scene.forces import AppliedForce
from carom.scene.materials import IMPACT_LAWS
from carom.scene.restitution import Restitution
from carom.scene.switches import is_off
from carom.status import Status

#: attributes of contacts, and of their laws, that tables show (an ensemble changes them from run to run)
OF_CONTACTS = "number", "other", "first", "penetration", "width", "kind", "side", "axis_of"
OF_LAWS = "impact_law", "restitution", "friction"


class Written(NamedTuple):
    """Copies of the records of a run; a solution computes its columns from them on demand."""

    attitude: np.ndarray  # (T, N, 4) attitudes of the principal axes
    series: np.recarray  # (T,) SERIES
    impact: np.recarray  # (K,) IMPACTS, in the order of time
    event: np.recarray  # (E,) EVENT, in the order of time
    contacts: dict[str, np.ndarray]  # (C,) columns of CONTACT, and of LAW
    forces: tuple[AppliedForce, ...]  # of the scene during the run; more may be added later


def assemble(run, status: Status) -> dict:
    """Return the fields of a `Solution`."""
    rec, clock = r.written(run.records, run.clock), r.as_numbers(run.clock)
    state, series = rec.state, rec.series
    impact, event, (most, events) = _in_time(rec.impact), _in_time(rec.event), busiest(rec.event)
    return {
        "t": np.array(series["t"]),
        "position": np.array(state["x"]),
        "velocity": np.array(state["v"]),
        "angular_velocity": np.array(state["w"]),
        "held_residual": np.array(series["residual"]),
        "status": status,
        "warnings": (
            *sentences(run.watch[0], run.how.finer, run.scene, run.pairs),
            *remarks(impact, event, run),
            *waves.remarks(impact, run),
            *stiff_forces.remarks(run, series, state),
            *beyond_bounds(run, impact, rec.touch, series["t"]),
            *tipped_strands(run, rec.state, series["t"]),
            *small_deflections.remarks(run, rec.state, series["t"]),
        ),
        "stats": {
            "steps": clock["step"], "trial_steps": clock["trials"], "rejected": clock["rejected"],
            "cuts": clock["cuts"], "located": clock["located"], "impacts": clock["struck"],
            "holds": clock["holds"], "held_steps": clock["contact_steps"],
            "held_rounds": clock["rounds"], "whole_steps": clock["whole"],
            "explicit_steps": int(run.clock["fallen"][0]),
            "parts": int(run.clock["parts"][0]),
            "busiest_contact": contact_name(run.scene, run.pairs, most) if most >= 0 else "",
            "busiest_events": events,
        },
        "scene": run.scene,
        "settings": dict(run.settings),
        "pairs": run.pairs,
        "_run": run,
        "_reason": run.compiled.functions.reason or locked(run, status) or tipped(run, status),
        "_touch": copied(rec.touch),
        "_written": Written(
            np.array(state["Q"]), copied(series), impact, event,
            _columns(run.everything.system), run.scene.forces,
        ),
    }  # fmt: skip


def _columns(system) -> dict[str, np.ndarray]:
    """Return copies of the columns of contacts and of their laws in impacts."""
    of_contacts = {name: np.array(system.contacts[name]) for name in OF_CONTACTS}
    laws = law_of(system, system.contacts)
    return of_contacts | {name: np.array(laws[name]) for name in OF_LAWS}


def _in_time(rows: np.recarray) -> np.recarray:
    """Return rows in the order of time, because the islands of a step write theirs one after the other."""
    if len(rows) < 2:
        return copied(rows)
    return rows[rows["time"].argsort(kind="stable")].view(Columns)


def orientation(solution) -> np.ndarray:
    """Return the attitudes (T, N, 4) of the scene's body axes."""
    return to_scene_axes(solution._written.attitude, solution._run.compiled.to_principal)


def event_table(solution) -> EventTable:
    """Return the events in the order of time."""
    event = solution._written.event
    names = np.array(r.EVENTS)[event["kind"]]
    return EventTable(np.array(event["time"]), names, np.array(event["contact"]))


def intervals(solution) -> ContactTable:
    """Return the intervals of persistent contact."""
    written = solution._written
    end = float(solution.t[-1])
    return contact_table(written.event, r.EVENTS, first_vertices(written.contacts), end)


def switch_table(solution) -> SwitchTable:
    """Return the switches that acted in a run, one row for each part that they changed."""
    rows, scene = solution._run.switched, solution.scene
    parts = np.array([part.name for part in scene], dtype=str)
    names = np.array([*(one.name for one in scene.switches), ""], dtype=str)
    return SwitchTable(
        time=np.array(rows["time"]), part=parts[rows["part"]], on=rows["on"] == 1,
        energy=np.array(rows["energy"]), switch=names[rows["switch"]],
    )  # fmt: skip


def to_scene_axes(Q: np.ndarray, to_principal: np.ndarray) -> np.ndarray:
    """Return attitudes (T, N, 4) of the scene's body axes, from those of the principal axes.

    `to_principal` has a row for each body, or one for each body and state.
    """
    same = np.all(to_principal == np.array([1.0, 0.0, 0.0, 0.0]), axis=-1, keepdims=True)
    if np.all(same):
        return Q.copy()
    return np.where(same, Q, quaternion.multiply(Q, quaternion.conjugate(to_principal)))


def first_vertices(contacts) -> np.ndarray:
    """Return the first vertex of each contact of the scene with a half-space, 0 for two bodies."""
    _, row = np.unique(contacts["number"], return_index=True)
    return np.where(contacts["other"] < 0, contacts["first"], 0)[row]


def impact_table(solution) -> ImpactTable:
    """Return the table of impacts, with names and laws of their contacts from the scene."""
    rows, contacts = solution._written.impact, solution._written.contacts
    number, first = np.unique(contacts["number"], return_index=True)
    place = np.searchsorted(number, rows.contact)
    c = first[place]
    arm = arms(contacts)[c]
    e = _restitutions(rows, contacts["restitution"][c], arm, solution)
    mu = np.where(_not_one_mu(contacts, first)[place], np.nan, contacts["friction"][c])
    law = np.array(IMPACT_LAWS)[contacts["impact_law"][c]]
    peak, duration = stiff_impacts(solution, rows, arm, (mu, e, law))
    return ImpactTable(
        relative_velocity_before=rows.before / arm[:, None],
        relative_velocity_after=rows.after / arm[:, None],
        penetration=contacts["penetration"][c] * contacts["width"][c] / arm,
        law=law,
        peak_force=peak,
        duration=duration,
        layer_duration=np.array(rows.duration),
        inverse_mass=rows.W / arm[:, None, None] ** 2,
        impulse=rows.impulse * arm[:, None],
        restitution=np.where(_differs(contacts["restitution"], first)[place], np.nan, e),
        friction=mu,
        wedged=(rows.phases & WEDGED) // WEDGED,
        located=1 - (rows.phases & AT_END) // AT_END,
        **named(rows.contact, solution.scene, solution.pairs),
        **{
            name: np.array(rows[name])
            for name in (
                "time", "contact", "point", "normal", "energy_change",
                "compression_work", "restitution_work", "friction_loss", "together",
            )
        },
    )  # fmt: skip


def _differs(values: np.ndarray, first: np.ndarray) -> np.ndarray:
    """Return for each contact whether its rows, which are those from `first` on, have different values."""
    return np.minimum.reduceat(values, first) < np.maximum.reduceat(values, first)


def _not_one_mu(contacts, first: np.ndarray) -> np.ndarray:
    """Return for each contact whether it has several coefficients of friction: of parts, or of directions."""
    return _differs(contacts["friction"], first) | np.maximum.reduceat(
        contacts["axis_of"] > 0, first
    )


def _restitutions(rows, e: np.ndarray, arm: np.ndarray, solution) -> np.ndarray:
    """Return e (K,) of impacts: the number of their contact, or what its law says at the speed of approach."""
    approach = np.maximum(-rows.before[:, 0] / arm, 0.0)
    for number in np.unique(rows.contact[np.isnan(e)]).tolist():
        law, own = restitution_of(solution.scene, solution.pairs, number), rows.contact == number
        assert isinstance(law, Restitution)
        e[own] = law(approach[own])
    return e


def named(contact: np.ndarray, scene, pairs) -> dict[str, np.ndarray]:
    """Return the names (K,) of contacts and of their two parts, by the number of the contact."""
    return {name: part[contact] for name, part in contact_names(scene, pairs)._asdict().items()}


class Nodes(NamedTuple):
    """Nodes of the interpolation of one body: saved states, and states at its events."""

    time: np.ndarray  # (M,)
    pose: np.ndarray  # (M, 7)
    before: np.ndarray  # (M, 6) velocities
    after: np.ndarray  # (M, 6)


def nodes(run) -> list[Nodes]:
    """Return the nodes of each body, in the order of time."""
    rec = r.trimmed(run.records, run.clock)
    state, shot = rec.state, rec.snapshot
    events = rec.event[shot.event].view(Columns)
    # an event comes after the saved rows that were written before it
    place = np.arange(1.0, len(state) + 1)
    by_body = np.argsort(shot.body, kind="stable")
    ends = np.searchsorted(shot.body[by_body], np.arange(state.shape[1] + 1))
    out = []
    for b in range(state.shape[1]):
        own = by_body[ends[b] : ends[b + 1]]
        here, event = state[:, b].view(Columns), shot[own].view(Columns)
        order = np.argsort(np.concatenate([place, events.saved[own] + 0.5]), kind="stable")
        speed = np.hstack([here.v, here.w])
        columns = (
            (rec.series.t, events.time[own]),
            (np.hstack([here.x, here.Q]), np.hstack([event.x, event.Q])),
            (speed, np.hstack([event.v0, event.w0])),
            (speed, np.hstack([event.v1, event.w1])),
        )
        out.append(Nodes(*(np.concatenate(pair)[order] for pair in columns)))
    return out


def contact_sums(touch: np.recarray, saved: int, contacts: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the largest mode (T, C) and the total force (T, C, 3) of the active points of each contact."""
    mode = np.zeros((saved, contacts), dtype=np.int64)
    force = np.zeros((saved, contacts, 3))
    np.maximum.at(mode, (touch.saved, touch.contact), touch.mode)
    np.add.at(force, (touch.saved, touch.contact), touch.force)
    return mode, force


@contextmanager
def _kept_turns(system):
    """Restore the whole turns of angles at the end; the reports count them along the saved states."""
    reference = system.relations.memory.coordinates["reference"]
    kept = reference.copy()
    yield
    reference[:] = kept


def ranges_of(run, compiled, saved: int):
    """Return the ranges of saved rows in which the forces stay as they are: a `carom.Run` may have set them."""
    return run.rows_of_forces(compiled, saved) if hasattr(run, "rows_of_forces") else [(0, saved)]


def accelerations(solution) -> np.ndarray:
    """Return the accelerations (T, N, 6) of all bodies at saved times, linear and angular, world axes.

    At the time of an impact they are those after it.
    """
    from carom.dynamics.reactions import reactions

    run = solution._run
    system, rec = run.compiled.system, r.trimmed(run.records, run.clock)
    touch = with_forces(solution, solution._solved[1], rec.touch)
    found = np.zeros((len(rec.state), len(system.bodies), 6))
    out, work = np.zeros((len(found), system.joints.size, 6)), r.new_work(system, run.method.b.size)
    augment = run.options.augmentation
    with _kept_turns(system):
        for first, last in ranges_of(run, run.compiled, len(found)):
            for k in range(first, last):
                rec = rec._replace(touch=touch[np.searchsorted(touch["saved"], k) :])
                reactions(system, augment, rec, (k, k + 1), work, out)
                found[k] = work.body["motion"]
    return found


def element_reactions(solution) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """Return the reactions of joints on their children, then the multipliers of each constraint (T, E, 6).

    The second result are the values (T,) of dry frictions in joints, by the index of the force.
    """
    from carom.dynamics.reactions import reactions

    run = solution._run
    rec, stages = r.trimmed(run.records, run.clock), run.method.b.size

    def solve(compiled, touch) -> np.ndarray:
        system = compiled.system
        out, work = np.zeros((len(rec.state), system.joints.size, 6)), r.new_work(system, stages)
        with _kept_turns(system):
            for rows in ranges_of(run, compiled, len(out)):
                part = rec._replace(touch=touch[np.searchsorted(touch["saved"], rows[0]) :])
                reactions(system, run.options.augmentation, part, rows, work, out)
        return on_children(compiled, rec.state, out)

    return with_dry_friction(run, solution, rec.touch, solve)


def multipliers(scene, reactions: np.ndarray) -> np.ndarray:
    """Return the multipliers (T, K) of the rows of all constraints beyond joints."""
    out = reactions[:, len(scene.joints) :]
    rows = [out[:, k, : c.rows] for k, c in enumerate(scene.constraints)]
    return np.concatenate([np.zeros((len(out), 0)), *rows], axis=1)


def on_children(compiled, state, out: np.ndarray) -> np.ndarray:
    """Return the reactions (T, J, 6) of the solver at states (T, N) as those on the children of the scene."""
    for j in np.flatnonzero(compiled.flipped):  # in the tree parent and child are exchanged
        out[:, j] *= -1.0
        joint = compiled.system.joints[j]
        anchors = [
            state.x[:, b] + quaternion.rotate(state.Q[:, b], anchor)
            for b, anchor in (
                (joint.parent, joint.parent_anchor),
                (joint.child, joint.child_anchor),
            )
        ]
        out[:, j, 3:] += np.cross(anchors[1] - anchors[0], out[:, j, :3])  # for slides
    return out


def constraint_errors(solution) -> tuple[np.ndarray, np.ndarray]:
    """Return the errors of position and velocity (T, R) of all rows at saved times."""
    from carom.dynamics.reactions import row_errors

    run = solution._run
    system, rec = run.compiled.system, r.trimmed(run.records, run.clock)
    work = r.new_work(system, run.method.b.size)
    position, velocity = np.zeros((2, len(rec.state), system.joints.size, 6))
    with _kept_turns(system):
        row_errors(system, rec, work, position, velocity)
    counts = [len(row_units(part.definition)) for part in constrained(run.scene)]
    rows = np.arange(6) < np.array(counts, dtype=np.int64).reshape(-1, 1)
    for k, part in enumerate(constrained(run.scene)):
        if is_off(run.scene, part):
            position[:, k] = velocity[:, k] = np.nan
    position, velocity = (np.abs(e[:, : len(counts)][:, rows]) for e in (position, velocity))
    return position, velocity
