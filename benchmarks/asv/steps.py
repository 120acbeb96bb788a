"""Time of a step, setting up not counted; of an impact; of a throw."""

from __future__ import annotations

import statistics

from carom.bench.measure import per_step, stepper
from carom.bench.problems import chain, corner_impact, free_step, planar_die, spatial_die, stack


class FreeStep:
    params = (list(free_step.CASES),)
    param_names = ("case",)
    timeout = 900

    def track_step(self, case):
        return 1e9 * statistics.median(per_step(free_step.ours(case), 1000, 101000))

    track_step.unit = "ns"


class Links:
    params = ([1, 10, 100, 1000],)
    param_names = ("links",)
    timeout = 900

    def track_step(self, links):
        run = stepper(chain.scene(links), 2e-4)
        return 1e6 * statistics.median(per_step(run, 50, 50 + 40000 // links))

    track_step.unit = "us"


class Stack:
    params = ([8, 20, 50],)
    param_names = ("boxes",)
    timeout = 900

    def track_step(self, boxes):
        steps = stack.ours(1e-3, boxes=boxes).steps
        return 1e6 * statistics.median(per_step(steps, 20, 150))

    track_step.unit = "us"


class CornerImpact:
    params = ([0.0, 0.2, 0.8],)
    param_names = ("friction",)
    timeout = 900

    def setup(self, friction):
        self.run = corner_impact.ours(friction)
        self.run()

    def time_two_thousand(self, friction):
        self.run()

    def track_error(self, friction):
        return corner_impact.error(friction)

    track_error.unit = "m/s"


class Throws:
    timeout = 900

    def track_rate(self):
        spatial_die.rate(10, step=1e-3)
        return statistics.median(spatial_die.rate(60, seed, step=1e-3) for seed in range(3))

    track_rate.unit = "throws/s"


class Memory:
    timeout = 900

    def setup(self):
        self.flight = stepper(planar_die.scene(1e9), 1e-3)
        self.flight(10)

    def peakmem_million_steps(self):
        self.flight(1_000_000)


class Startup:
    timeout = 900  # the first process compiles

    def timeraw_import(self):
        return "import carom"

    def timeraw_command(self):
        return "from carom.cli.app import command; command()"

    def timeraw_first_run(self):
        return "import carom; from carom.bench.problems.chain import scene; carom.simulate(scene(), 2.0)"
