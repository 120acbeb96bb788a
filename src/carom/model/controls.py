"""Settings of a run as numbers."""

from __future__ import annotations

from typing import NamedTuple

LOCATE, PROJECT, WORK = range(3)  # what is done about an impact within a step


class Controls(NamedTuple):
    """Settings of a run, as numbers."""

    step: float
    duration: float
    location: int  # LOCATE, PROJECT or WORK
    save_every: int
    last: int  # number of the last step; 0 where steps vary
    gap: float  # tolerance of a located gap, relative to the body
    tie: float  # vertices this near the lowest strike together, relative to the body
    hold: int
    rest: float  # speeds below this part of what forces give in a step are none
    layer_steps: int
    layer_time: int  # 1: add the duration of impacts to the clock
    max_impacts: int
    max_cuts: int
    retry: int  # 1 where a step that does not get on is given up, to be taken whole
    order: int  # of the error of a step whose length is chosen; 0: all steps are `step`
    rtol: float
    atol: float
    longest: float
