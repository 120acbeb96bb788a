"""Time and error of each problem with a known answer."""

from __future__ import annotations

from carom.bench.problems import ALL

PROBLEMS = {problem.NAME: problem for problem in ALL}


class Problem:
    """A problem by the default method with the middle one of its steps."""

    params = (list(PROBLEMS),)
    param_names = ("problem",)
    timeout = 900  # the first run compiles

    def setup(self, name):
        problem = PROBLEMS[name]
        self.task = problem.ours(problem.STEPS[len(problem.STEPS) // 2])
        self.task.run()  # compiled code is loaded

    def time_run(self, name):
        self.task.run()

    def track_error(self, name):
        return self.task.error()

    def peakmem_run(self, name):
        self.task.run()
