"""What the tests verify: a mark that names a feature and its equation, and a comparison that is recorded.

    @verifies("joints.Screw", "z = p q/(2 pi)", "closed form")
    def test_screw():
        ...
        agree(q[:, 1], pitch * q[:, 0] / (2.0 * np.pi), atol=1e-13)

`agree` asserts like `numpy.testing.assert_allclose`, and records the greatest error and what was asked: so
the row of a test says nothing that the test did not check. ``make verify`` runs the marked tests and makes
the page of their rows (`tools/verification.py`).
"""

from __future__ import annotations

import runpy
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import ArrayLike

#: where a right value may come from; what follows a colon says which one
SOURCES = (
    "closed form",  # a formula for the result
    # a program of ours that is no part of carom, in the test or with its numbers there: SciPy's integrators,
    # quadrature, dense matrices
    "own integration",
    "other program",  # of others: MuJoCo, Adams, coal, SciPy's Rotation
    "publication",  # numbers or formulas that others have published
    "invariant",  # what the motion must keep: energy, momentum, a symmetry, a bound
    "experiment",  # a measurement: its rows are of the validation
)


class Comparison(NamedTuple):
    """The greatest error of one comparison, and what was asked of it, both absolute or both relative."""

    reached: float
    asked: float
    relative: bool


#: comparisons of the test that runs, and rows of those that have run
_made: list[Comparison] = []
_rows: list[dict] = []


def verifies(feature: str, equation: str, source: str) -> pytest.MarkDecorator:
    """Mark a test, or a case of one, as one that verifies a feature.

    Parameters
    ----------
    feature
        Its public name without ``carom.``, or ``name(argument=)``, ``argument="word"``. Names in braces are
        arguments of the test: ``'method="{method}"'``. One mark for each feature.
    equation
        What the right value is, as a formula or in a few words.
    source
        Where it comes from: one of `SOURCES`, and more after a colon.
    """
    if source.partition(":")[0] not in SOURCES:
        raise ValueError(f"source must begin with one of {SOURCES}; got {source!r}")
    return pytest.mark.verifies(feature, equation, source)


def agree(actual, exact, *, rtol: ArrayLike = 0.0, atol: ArrayLike = 0.0) -> None:
    """Assert that values agree to ``atol + rtol |exact|``, and record the one that is nearest to this bound."""
    given = [np.asarray(one, dtype=float) for one in (actual, exact, rtol, atol)]
    actual, exact, rtol, atol = np.broadcast_arrays(*given)
    assert actual.size, "nothing is compared"
    error, bound = np.abs(actual - exact), atol + rtol * np.abs(exact)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(error == 0.0, 0.0, error / bound)
    worst = np.unravel_index(np.argmax(share), share.shape)  # NaN counts as the greatest
    relative = bool(atol[worst] == 0.0 < rtol[worst] * np.abs(exact[worst]))
    size = np.abs(exact[worst]) if relative else 1.0
    _made.append(Comparison(float(error[worst] / size), float(bound[worst] / size), relative))
    assert share[worst] <= 1.0, (
        f"{actual[worst]!r} instead of {exact[worst]!r}: an error of {error[worst]:.3g}, of which "
        f"{bound[worst]:.3g} is allowed (at {tuple(map(int, worst))} of {share.shape})"
    )


def rows(item: pytest.Item) -> list[dict]:
    """Return the rows of a test: one for each feature, with the comparison that is nearest to its bound."""
    marks = [*item.iter_markers("verifies")]
    assert _made or not marks, "a test that verifies a feature compares by `agree`"
    path = item.path.relative_to(item.config.rootpath).as_posix()
    given = item.callspec.params if hasattr(item, "callspec") else {}
    test = {"test": f"{path}::{item.originalname}", "cases": 1, "comparisons": len(_made)}
    return [
        {"feature": feature.format(**given), "equation": equation, "source": source}
        | test
        | max(_made, key=share)._asdict()
        for feature, equation, source in (mark.args for mark in marks)
    ]


def share(one: Comparison) -> float:
    """Return the error as a part of what was asked; where nothing but the very number was, 0."""
    return one.reached / one.asked if one.asked else 0.0


# Hooks of pytest, which `conftest.py` imports


def pytest_addoption(parser):
    """Add the option that ``make verify`` sets."""
    parser.addoption(
        "--verified", metavar="FILE", help="write what the tests verified into this file"
    )


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item):
    """Hand the rows of a test to the process that reports."""
    _made.clear()
    result = yield
    item.user_properties += [("verified", row) for row in rows(item)]
    return result


def pytest_runtest_logreport(report):
    """Collect the rows of a test that has passed."""
    if report.when == "call" and report.passed:
        _rows.extend(row for name, row in report.user_properties if name == "verified")


def pytest_sessionfinish(session, exitstatus):
    """Write the rows, those of the cases of a test as one; tests that did not run keep theirs."""
    path = session.config.getoption("--verified")
    if path is None or exitstatus != 0 or hasattr(session.config, "workerinput"):
        return
    tool = runpy.run_path(str(session.config.rootpath / "tools" / "verification.py"))
    tool["update"](Path(path), _rows)
