"""Reactions of joints in a run that stands between two steps, by the forces that its last step has found."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom._compiled.record_arrays import table
from carom.model.compile import Compiled, compiled_once
from carom.model.forces import settable
from carom.model.records import TOUCH, new_clock, new_work, one_row
from carom.results.assemble import on_children
from carom.results.dry_friction import dry_of
from carom.scene.joints import Joint
from carom.stepping.load_limits import LIMIT_CLOCK, LOAD_LIMIT, LoadLimits, find_loads


def arrays_of_loads(run: Any, count: int) -> tuple[Compiled, LoadLimits]:
    """Return the scene as it stands with arrays of its own, and rows for the limits of `count` parts."""
    compiled = compiled_once(run.stands.view(run.scene), run.options, *run.ways)
    place, records = table(LIMIT_CLOCK, 1), one_row(len(compiled.system.bodies), 0)
    place["augment"] = run.options.augmentation
    # a row for each active point, and for each term of a coordinate (`stepping.record.room_of_touches`)
    room = len(run.active.points) + 2 * len(run.compiled.system.relations.terms)
    records = records._replace(touch=table(TOUCH, room))
    work = new_work(compiled.system, run.method.b.size)
    rows = table(LOAD_LIMIT, count)
    return compiled, LoadLimits(rows, place, compiled.system, work, new_clock(), records)


def set_forces(limits: LoadLimits, run: Any) -> None:
    """Write the forces that are set between steps."""
    for there, now in zip(settable(limits.system.forces), settable(run.compiled.system.forces)):
        there[:] = now


class Loads:
    """Reactions of joints; dry friction has the force of the end of a step, and is solved for elsewhere."""

    def __init__(self, run: Any):
        self.has_friction = bool(dry_of(run.stands.view(run.scene)))
        self.compiled, self.limits = arrays_of_loads(run, 0)
        self.time, self.found = np.nan, np.zeros((1, self.compiled.system.joints.size, 6))

    def of(self, joint: Joint, look: Any) -> tuple[np.ndarray, np.ndarray]:
        """Return force and torque of a joint on its child."""
        if self.has_friction and not look.at_end:
            reaction = look.state.joint_reactions[joint.index]
        else:
            if look.t != self.time:
                self.solve(look.run)
                self.time = look.t
            reaction = self.found[0, joint.index]
        return reaction[:3], reaction[3:]

    def solve(self, run: Any) -> None:
        """Find all reactions as the run stands."""
        if len(self.limits.records.touch) < len(
            run.active.points
        ):  # there are more points than before
            self.compiled, self.limits = arrays_of_loads(run, 0)
        set_forces(self.limits, run)
        self.limits.place["whole"] = run.clock["whole"]
        find_loads(run.model, run.data, self.limits)
        out = np.array(self.limits.work.joint["reaction"])[None]
        self.found = on_children(self.compiled, run.now[None], out)
