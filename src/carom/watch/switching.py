"""Switches in a run: when they act, and what they do.

A switch acts between two steps, of which one ends at its time. From then on the run moves the same bodies with
the arrays of the scene without its parts, or with them (`carom.model.switched`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from carom.contact.depth import write_least_gaps
from carom.dynamics.project import project_start
from carom.dynamics.reactions import start_errors
from carom.model.placement import pose_of_child
from carom.model.records import OPENS, longer
from carom.model.switched import SWITCHED
from carom.results.instant import touches
from carom.results.joint_impulses import impulses_of
from carom.results.names import contact_names
from carom.scene.constraints import Constraint
from carom.scene.joints import Joint
from carom.scene.stops import Stop
from carom.scene.switch import Switch
from carom.scene.switches import check_on, is_off
from carom.watch.conditions import Condition, Observed, condition_of
from carom.watch.loads import Loads


def switches_of(scene) -> list[Condition]:
    """Return the conditions at which the switches of a scene act."""
    return [_condition(switch, scene) for switch in scene.switches if switch.at is not None]


def _condition(switch: Switch, scene) -> Condition:
    name = f"switch {switch.name!r}"
    if switch.limits:
        breaks = _Breaks(switch)
        return Condition(name, breaks, 0, 1.0, breaks.when, switch=switch, breaks=True)
    if switch.time is not None:
        time = switch.time
        return Condition(name, lambda look: look.t - time, 0, 1.0, lambda look: time, switch=switch)
    event = switch.event if switch.when is None else switch.when
    return condition_of(name, event, scene)._replace(terminal=0, switch=switch)


def changes(run, switch: Switch) -> list[Any]:
    """Return the parts that a switch would change now."""
    return [part for part in switch.parts if (part.name in run.stands.off) != switch.off]


class _Breaks:
    """Above 0 where a force, a torque or an impulse of a joint exceeds its limit, relative to this."""

    def __init__(self, switch: Switch):
        self.part, self.limits = switch.parts[0], switch.limits

    def __call__(self, look: Observed) -> float:
        most = -1.0 if self.when(look) is None else 1.0
        sizes = self.sizes(look)
        for name, size in sizes.items():
            if name in self.limits:
                most = max(most, size / self.limits[name] - 1.0)
        return most

    def sizes(self, look: Observed) -> dict[str, float]:
        """Return the sizes of force and torque."""
        part = self.part
        if isinstance(part, Stop):
            touch = touches(look.run)
            rows = touch["contact"] == len(look.run.pairs.body) + part.index
            return {"force": float(np.abs(np.sum(touch["force"][rows, 0])))}
        if Loads not in look.known:
            look.known[Loads] = Loads(look.run)
        force, torque = look.known[Loads].of(part, look)
        return {"force": float(np.linalg.norm(force)), "torque": float(np.linalg.norm(torque))}

    def when(self, look: Observed) -> float | None:
        """Return the time of the first impact in the step whose impulse exceeds the limit, or None."""
        limit = self.limits.get("impulse", math.inf)
        run = look.run
        if math.isinf(limit) or look.struck == int(run.clock["struck"][0]):
            return None
        times, sizes = impulses_of(run, look.struck, self.part)
        return next((t for t, size in zip(times, sizes) if size > limit), None)


def switch(run, part, on: bool, number: int = -1) -> bool:
    """Put a part into the motion, or take it out; return whether that changes anything.

    A joint takes its child as it stands, and a relation its coordinates; the velocities that they forbid vanish
    by the impulse that is the least in the kinetic metric. The state of the present time is saved anew.
    """
    if (part.name in run.stands.off) != on:
        return False
    before, known = run.clock[0].copy(), run.compiled.system.contacts["number"]
    points = run.active.points[: run.active.count[0]].copy()
    points["contact"] = known[points["contact"]]
    absent = [one for one in run.scene.constraints if is_off(run.stands.view(run.scene), one)]
    placed = pose_of_child(part, run.now) if on and isinstance(part, Joint) else np.zeros(7)
    run.stand_as(run.stands.after(part.name, on, placed))
    note_opened(run, points)
    entered: dict[Any, np.ndarray] = {part: placed}
    if on:
        view = run.stands.view(run.scene)
        entered |= enter(run, part, [one for one in absent if not is_off(view, one)])
        refuse_inside(run, known)
    save_again(run, before)
    for one, where in entered.items():
        note_switched(run, one, on, number, where)
    after = run.clock[0]
    given = after.kinetic + after.potential - before["kinetic"] - before["potential"]
    run.switched["energy"][-len(entered)] = given
    return True


def note_switched(run, part, on: bool, number: int, placed: np.ndarray) -> None:
    """Write that a part was switched."""
    row = np.zeros(1, SWITCHED)
    row["row"], row["time"] = run.clock["saved"], run.clock["now"]
    row["switch"], row["on"], row["placed"] = number, on, placed
    row["part"] = [one.name for one in run.scene].index(part.name)
    run.switched = np.append(run.switched, row)


def enter(run, part, relations: list[Constraint]) -> dict[Constraint, np.ndarray]:
    """Let a joint and relations that were put in begin as the bodies stand; take away what they forbid.

    Return the constant with which each relation begins.
    """
    system, placed = run.compiled.system, {}
    run.work.moment[0].time = run.reached
    for (joint, _), k in run.compiled.numbers.items():
        if isinstance(part, Joint) and joint == part.index:
            system.relations.memory.coordinates["reference"][k] = 0.0
    errors = np.zeros((2, len(system.joints), 6))
    if relations:
        start_errors(system, run.now, run.work, *errors)
    for one in relations:
        check_on(one)
        element = len(run.scene.joints) + one.index
        relation = system.relations.relations[system.joints["number"][element]]
        relation.constant += errors[0, element, 0]
        constant = np.zeros(7)
        constant[0] = relation.constant
        placed[one] = constant
        run.stands = run.stands.after(one.name, True, constant)
    if isinstance(part, Joint) or relations:
        project_start(system, run.now, run.work)
    return placed


def note_opened(run, points: np.ndarray) -> None:
    """Write to the events that the active points of contacts that are off have opened."""
    gone = points[~np.isin(points["contact"], run.compiled.system.contacts["number"])]
    if run.clock["event"][0] + len(gone) > len(run.records.event):
        run.records = longer(run.records, run.clock)
    clock = run.clock[0]
    for point in gone:
        own = point["contact"], point["feature"]
        run.records.event[clock.event] = (clock.now, OPENS, *own, clock.saved, clock.snapped, 0)
        clock.event += 1


def refuse_inside(run, known: np.ndarray) -> None:
    """Refuse to put in contacts and stops, beside those that are known, that are exceeded in this state."""
    contacts, stops = run.compiled.system.contacts, len(run.pairs.body)
    gaps, names = np.zeros(len(contacts)), contact_names(run.scene, run.pairs).name
    write_least_gaps(run.compiled.system, run.now, 0, run.work, gaps)
    for row in np.flatnonzero(~np.isin(contacts["number"], known)):
        if not gaps[row] >= -run.options.constraint_tolerance * contacts["extent"][row]:
            number = int(contacts["number"][row])
            raise ValueError(
                f"{str(names[number])!r} cannot be put into the motion where "
                f"{'it is exceeded' if number >= stops else 'its bodies are in each other'}, by "
                f"{-gaps[row]:.6g} m"
            )


def save_again(run, before) -> None:
    """Save the present state in the place of the same time, with what a switch has changed in the ledger."""
    clock, records = run.clock[0], run.records
    if records.series["t"][clock.saved - 1] == clock.now:
        clock.saved -= 1
        clock.touched = np.searchsorted(records.touch["saved"][: clock.touched], clock.saved)
    run.save_now()
    struck, stored = clock.kinetic - before["kinetic"], clock.potential - before["potential"]
    for line, given in (("impacts", struck), ("loads", stored)):
        clock[line] += given
        run.records.series[line][clock.saved - 1] += given
