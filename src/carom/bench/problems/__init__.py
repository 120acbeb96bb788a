"""Standard problems, one in each file: the scene, its exact result, and the same scene for MuJoCo."""

from __future__ import annotations

from carom.bench.problems import chain, four_bar, planar_die, spatial_die, sphere, stack
from carom.bench.problems.task import Task

#: problems with a reference: each has ``ours(step, method)``, ``mujoco(module, step)``, STEPS, and texts
ALL = (sphere, planar_die, spatial_die, chain, four_bar, stack)

__all__ = ["ALL", "Task", "chain", "four_bar", "planar_die", "spatial_die", "sphere", "stack"]
