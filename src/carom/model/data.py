"""The arguments of the kernels of a step: `Model`, which they read, and `Data`, which they change."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.model.arrays import System
from carom.model.controls import Controls
from carom.model.records import Records
from carom.model.workspace import ActiveSet, Work


class Model(NamedTuple):
    """A compiled scene, or an island of one, and the settings of its run: what changes in it a test names."""

    system: System
    controls: Controls


class Data(NamedTuple):
    """All that a step changes: state, active set, workspace, clock and records.

    The arrays of an island are parts of those of the run.
    """

    state: np.recarray  # (N,) STATE, the present
    active: ActiveSet
    work: Work
    group: tuple  # `carom.impact.workspace.Group`: the closed points of a group
    multiple: tuple  # `carom.impact.workspace.MultipleImpact`: workspace of a multiple impact
    crowd: tuple  # `carom.stepping.crowd.layout.Crowd`: workspace of a time-stepping step
    clocks: np.recarray  # (1,) CLOCK
    records: Records
    watch: np.recarray  # (1,) WATCH
