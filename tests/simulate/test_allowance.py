"""Bounds of the work of an island: counts for each part of a run, saved for later, whatever is saved of it."""

import numpy as np
import pytest

from carom._compiled.decorators import entry
from carom._compiled.record_arrays import table
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
from carom.model.workspace import STEP

pytestmark = pytest.mark.plain


def controls(**given) -> Controls:
    """A run of 2 s in steps of 1 ms."""
    fields = {name: 0.0 for name in Controls._fields}
    kinds = {name: 0 for name, kind in Controls.__annotations__.items() if kind == "int"}
    return Controls(**{**fields, **kinds, "interval": 1e-3, "duration": 2.0, "retry": 1, **given})


@entry
def remaining(controls, steps, kind):
    return left(controls, steps[0], kind)


@entry
def too_much(controls, steps):
    return overdone(controls, steps[0])


def after(spent=0.0, **counts):
    step = table(STEP, 1)
    step["spent"] = spent
    for name, number in counts.items():
        kind = {"trials": COUNT_TRIALS, "searches": COUNT_SEARCHES, "blocks": COUNT_BLOCKS}[name]
        step["counts"][0, kind] = number
    return step


def test_a_step_may_use_what_was_saved_and_its_own_part():
    at_end = (SAVED + 1.0) * OF_STEP
    assert remaining(controls(), after(1e-3), COUNT_TRIALS) == pytest.approx(at_end)
    assert not too_much(controls(), after(1e-3, trials=at_end - 1.0))
    assert too_much(controls(), after(1e-3, trials=at_end + 1.0))
    assert too_much(controls(), after(searches=SAVED * PART[COUNT_SEARCHES] + 1.0))
    assert not too_much(controls(retry=0), after(trials=1e9))
    assert not too_much(controls(), after(blocks=1e9))  # gives no step up


def test_with_tolerances_the_bound_does_not_depend_on_saved_times():
    some = [
        remaining(controls(order=5, interval=step), after(0.5), COUNT_SEARCHES)
        for step in (1e-3, 0.1)
    ]
    assert some[0] == some[1] == pytest.approx(PART[COUNT_SEARCHES] * (SAVED + 0.25 * PARTS))


def test_few_steps_may_use_more_each():
    one = remaining(controls(interval=0.2), after(0.2), COUNT_TRIALS)
    assert one == pytest.approx(OF_STEP * (SAVED + 0.1 * PARTS))
    assert np.size(after()["counts"]) == COUNTS
