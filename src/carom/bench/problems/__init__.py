"""Standard problems, one a file: what moves, its exact answer, and the same for MuJoCo."""

from __future__ import annotations

from carom.bench.problems import chain, four_bar, planar_die, spatial_die, sphere, stack
from carom.bench.problems.task import Task

#: those with an error to compare: each has ``ours(step, method)``, ``mujoco(module, step)``, STEPS, and words
ALL = (sphere, planar_die, spatial_die, chain, four_bar, stack)

__all__ = ["ALL", "Task", "chain", "four_bar", "planar_die", "spatial_die", "sphere", "stack"]
