"""The verification manual: its page is that of its rows; features have rows, and marked tests wrote theirs."""

import ast
import math
import runpy
from pathlib import Path

import numpy as np
import pytest

import verified
from sources import tree
from verified import agree, verifies

ROOT = Path(__file__).parents[1]
TOOL = runpy.run_path(str(ROOT / "tools" / "verification.py"))
ROWS = TOOL["kept"]()


def test_the_page_is_that_of_the_rows():
    """If this fails: python tools/verification.py."""
    assert TOOL["PAGE"].read_text(encoding="utf-8") == TOOL["page"]()


def test_each_feature_has_a_row():
    """What is new and public is verified: mark a test with `verifies`, and run ``make verify``."""
    assert TOOL["missing"]() == {}


def test_rows_are_of_what_is_public():
    known = {name for names in TOOL["features"]().values() for name in names}
    assert {row["feature"] for row in ROWS} - known == set()


def test_what_needs_no_row_is_public(monkeypatch):
    """A name that is gone is no reason any more."""
    monkeypatch.setitem(TOOL["features"].__globals__, "NO_ROW", {})
    monkeypatch.setitem(TOOL["features"].__globals__, "PLAIN", set())
    found = {name for names in TOOL["features"]().values() for name in names}
    assert set(TOOL["NO_ROW"]) - found == set()
    assert TOOL["PLAIN"] - {name.partition("(")[2].rstrip("=)") for name in found} == set()


def marked():
    """Yield the test, the feature, the equation and the source of each decorator `verifies`."""
    for path in sorted((ROOT / "tests").rglob("test_*.py")):
        marks = "verifies(" in path.read_text(encoding="utf-8")
        for node in tree(path).body if marks else ():
            for mark in node.decorator_list if isinstance(node, ast.FunctionDef) else ():
                if isinstance(mark, ast.Call) and getattr(mark.func, "id", "") == "verifies":
                    given = [ast.literal_eval(one) for one in mark.args]
                    yield f"{path.relative_to(ROOT).as_posix()}::{node.name}", *given


def test_marked_tests_have_rows_and_rows_have_tests():
    """If this fails: make verify, or ``pytest tests/... --verified docs/_static/verification.json``."""
    written = {(row["test"], row["feature"], row["equation"], row["source"]) for row in ROWS}
    stated = [one for one in marked() if "{" not in one[1]]
    assert [one for one in stated if one not in written] == []
    assert {one[0] for one in marked()} - {row["test"] for row in ROWS} == set()
    known = {(test, *rest) for test, _, *rest in marked()}
    tests = {one[0] for one in known}
    for row in ROWS:  # also of marks whose feature is that of the case, or that one case has
        stated = (row["test"], row["equation"], row["source"]) in known
        assert stated if row["test"] in tests else TOOL["is_stated"](row), row


def test_errors_are_within_what_was_asked():
    assert [row for row in ROWS if not 0.0 <= row["reached"] <= row["asked"]] == []


def recorded(actual, exact, **bounds):
    """Return what a comparison recorded."""
    agree(actual, exact, **bounds)
    return verified._made[-1]


def test_a_comparison_is_recorded_as_it_was_made():
    assert recorded(1.5, 1.0, atol=1.0) == (0.5, 1.0, False)
    assert recorded([1.0, 4.5], [1.0, 5.0], rtol=0.2) == (0.1, 0.2, True)
    # the entry that is nearest to its bound, not the one with the greatest error
    assert recorded([100.0, 0.1], [101.0, 0.0], rtol=0.1, atol=0.1) == (0.1, 0.1, False)
    assert recorded(np.arange(3), 0.0, atol=np.array([1.0, 4.0, 8.0])) == (1.0, 4.0, False)
    assert recorded([1, 2], (1, 2)) == (0.0, 0.0, False)


@pytest.mark.parametrize(
    ("actual", "exact", "bounds"),
    [
        (1.1, 1.0, {"atol": 0.01}), (1.1, 1.0, {"rtol": 0.01}), (1.0, 1.0 + 1e-15, {}),
        (math.nan, 1.0, {"atol": 9.0}), (1.0, math.nan, {"atol": 9.0}), ([], [], {}),
        (math.inf, 1.0, {"atol": 9.0}),
    ],
)  # fmt: skip
def test_what_does_not_agree_fails(actual, exact, bounds):
    with pytest.raises(AssertionError):
        agree(actual, exact, **bounds)


def test_a_source_is_one_of_those_that_are_known():
    with pytest.raises(ValueError, match="source must begin with one of"):
        verifies("joints.Screw", "z = p q/(2 pi)", "by heart")
