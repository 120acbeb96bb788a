"""Time of scenes where many bodies touch, by a step of a millisecond."""

from __future__ import annotations

import carom
from carom.bench.many import ALL, STEP
from carom.bench.measure import clock

SCENES = {make.__name__: make for make in ALL}


class Many:
    params = (list(SCENES),)
    param_names = ("scene",)
    timeout = 900

    def track_run(self, scene):
        many = SCENES[scene]()
        carom.simulate(many.scene(), 2 * STEP, step=STEP, throw=False)
        begin = clock()
        carom.simulate(many.scene(), many.duration, step=STEP, throw=False)
        return clock() - begin

    track_run.unit = "s"
