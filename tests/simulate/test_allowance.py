"""Bounds of the work of an island: counts for each part of a run, saved for later, whatever is saved of it."""

import numpy as np
import pytest

from carom._compiled.decorators import entry
from carom.model.allowance import (
    COUNT_BLOCKS,
    COUNT_SEARCHES,
    COUNT_TRIALS,
    COUNTS,
    OF_STEP,
    PART,
    PARTS,
    SAVED,
    left,
    overdone,
)  # fmt: skip
from carom.model.controls import Controls
from carom.model.records import new_clock

pytestmark = pytest.mark.plain


def controls(**given) -> Controls:
    """A run of 2 s in steps of 1 ms."""
    fields = {name: 0.0 for name in Controls._fields}
    kinds = {name: 0 for name, kind in Controls.__annotations__.items() if kind == "int"}
    return Controls(**{**fields, **kinds, "interval": 1e-3, "duration": 2.0, "retry": 1, **given})


@entry
def remaining(controls, clocks, kind):
    return left(controls, clocks[0], kind)


@entry
def too_much(controls, clocks):
    return overdone(controls, clocks[0])


def after(clock, spent=0.0, **counts):
    clock["spent"], clock["counts"] = spent, 0.0
    for name, number in counts.items():
        kind = {"trials": COUNT_TRIALS, "searches": COUNT_SEARCHES, "blocks": COUNT_BLOCKS}[name]
        clock["counts"][0, kind] = number
    return clock


def test_a_step_may_use_what_was_saved_and_its_own_part():
    clock = new_clock()
    at_end = (SAVED + 1.0) * OF_STEP
    assert remaining(controls(), after(clock, 1e-3), COUNT_TRIALS) == pytest.approx(at_end)
    assert not too_much(controls(), after(clock, 1e-3, trials=at_end - 1.0))
    assert too_much(controls(), after(clock, 1e-3, trials=at_end + 1.0))
    assert too_much(controls(), after(clock, searches=SAVED * PART[COUNT_SEARCHES] + 1.0))
    assert not too_much(controls(retry=0), after(clock, trials=1e9))
    assert not too_much(controls(), after(clock, blocks=1e9))  # gives no step up


def test_with_tolerances_the_bound_does_not_depend_on_saved_times():
    some = [
        remaining(controls(order=5, interval=step), after(new_clock(), 0.5), COUNT_SEARCHES)
        for step in (1e-3, 0.1)
    ]
    assert some[0] == some[1] == pytest.approx(PART[COUNT_SEARCHES] * (SAVED + 0.25 * PARTS))


def test_few_steps_may_use_more_each():
    one = remaining(controls(interval=0.2), after(new_clock(), 0.2), COUNT_TRIALS)
    assert one == pytest.approx(OF_STEP * (SAVED + 0.1 * PARTS))
    assert np.size(new_clock()["counts"]) == COUNTS
