"""Settings of a run as numbers."""

from __future__ import annotations

from typing import NamedTuple

LOCATE, PROJECT, WORK = range(3)  # treatment of an impact within a step


class Controls(NamedTuple):
    """Settings of a run, as numbers."""

    step: float  # or, with tolerances, the time of a bounce as high as the tolerance, of an island
    pull: float  # acceleration of gravity; with tolerances also by applied forces, of an island [m/s^2]
    interval: float  # the longest step of the run
    duration: float
    location: int  # LOCATE, PROJECT or WORK
    gap: float  # tolerance of a located gap, relative to the body
    tie: float  # vertices this near the lowest strike together, relative to the body
    hold: int
    rest: float  # speeds below this fraction of the speed that forces give in a step count as zero
    layer_steps: int
    layer_time: int  # 1: add the duration of impacts to the clock
    max_impacts: int
    max_cuts: int
    retry: int  # 1: a step with too much work is given up, and its bodies move as a crowd
    order: int  # of the estimate of the error, with tolerances; 0 without
    rtol: float
    atol: float
