"""The first state of a run: refused if it violates joints, constraints, stops, or the ends of a curve."""

from __future__ import annotations

import numpy as np

from carom.contact.depth import write_least_gaps
from carom.dynamics.reactions import start_errors, start_speeds
from carom.kinematics.thresholds import END_MARGIN
from carom.model.arrays import ON_CURVE
from carom.model.thresholds import LEAST_SPEED
from carom.options import Options
from carom.scene.joints import Joint
from carom.scene.scene import Scene
from carom.scene.switches import is_off


def check_stops(scene: Scene, compiled, start, work, options: Options) -> None:
    """Refuse a joint that exceeds its stop at the start."""
    stops = [stop for stop in scene.stops if not is_off(scene, stop)]
    if not stops or scene._chart is not None:  # in coordinates gaps have sizes of their own
        return
    system = compiled.system
    gaps, first = np.zeros(len(stops)), len(system.contacts) - len(stops)
    write_least_gaps(system, start, first, work, gaps)
    for row, (stop, gap) in enumerate(zip(stops, gaps), start=first):
        extent = system.contacts.extent[row]
        if not gap >= -options.constraint_tolerance * extent:
            if stop.joint.can_be_left:
                raise ValueError(
                    f"position violates {stop.joint.name!r}: its point must be on the free side of the rail, "
                    f"got a gap of {gap:g} m"
                )
            side = "lower" if stop.side > 0.0 else "upper"
            unit = "rad" if stop.turns else "m"
            place = round(stop.end + gap / system.contacts.side[row], 9)
            raise ValueError(
                f"stop {stop.name!r} of {stop.joint.name!r} must not be exceeded at the start, where the "
                f"coordinate is {place + 0.0:g}, got {side}={stop.end:g} {unit}"
            )


def check_ends(scene: Scene, compiled) -> None:
    """Refuse a point beyond an end of its curve, which is open, at the start."""
    relations = compiled.system.relations
    for (j, _), k in compiled.numbers.items():
        c = relations.coordinates[k]
        if c.kind not in ON_CURVE:
            continue
        one, s = relations.curves[c.number], float(relations.memory.coordinates[k].reference)
        margin = END_MARGIN * (one.high - one.low)
        if one.period == 0.0 and not one.low - margin <= s <= one.high + margin:
            raise ValueError(
                f"position violates {scene.joints[j].name!r}: its point must be on the curve, between "
                f"{one.low:g} m and {one.high:g} m from the anchor, got {s:g} m"
            )


def check_joints(scene: Scene, compiled, start, work, options: Options) -> None:
    """Refuse an initial state that violates a joint or a constraint; the message has its name and error."""
    system, elements = compiled.system, (*scene.joints, *scene.constraints)
    if not elements:
        return
    errors = np.zeros((2, len(system.joints), 6))
    work.moment[0].time = 0.0
    start_errors(system, start, work, *errors)
    if compiled.functions.failed is not None:
        raise compiled.functions.failed
    check_ends(scene, compiled)
    size = system.bodies.extent
    speed = np.max(np.abs(start.v)) + np.max(np.abs(start.w) * size[:, None])
    speed += np.max(np.abs(start_speeds(system, start, work)), initial=0.0)
    for j, element in enumerate(elements):
        # angular rows come after the linear ones where there are any: as a speed at the body's size
        weight = max(1.0, size[system.joints.child[j]])
        off, rate = (float(np.max(np.abs(e[j]))) for e in errors)
        what = f"{element.name!r} ({element.kind})"
        fits = "give an initial state that satisfies it, or use Options(project_start=True)"
        if not off <= options.constraint_tolerance * weight:
            raise ValueError(
                f"position violates {what}: its error must be 0, got {off:.6g}; {fits}"
            )
        if rate * weight <= options.constraint_tolerance * speed + LEAST_SPEED:
            continue
        if isinstance(element, Joint):
            raise ValueError(
                f"velocity of {element.child.name!r} violates joint {what}: the velocity that the joint "
                f"forbids must be 0, got {rate:.6g}; give velocity and angular_velocity of all joined "
                "bodies that satisfy their joints, or use Options(project_start=True)"
            )
        raise ValueError(
            f"velocity violates {what}: it differs from the prescribed value by {rate:.6g}; {fits}"
        )
