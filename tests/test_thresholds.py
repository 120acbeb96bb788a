"""Each threshold is stated once, with its unit and its reason, is used, and is on the page."""

import ast
import importlib
import re
import runpy
from collections import Counter
from decimal import Decimal
from pathlib import Path

import pytest

from sources import tree
from test_architecture import ROOT, modules

TOOL = runpy.run_path(str(Path(__file__).parents[1] / "tools" / "thresholds.py"))
ROOMS = TOOL["ROOMS"]


def test_the_page_is_that_of_the_files():
    """If this fails: python tools/thresholds.py."""
    assert TOOL["PAGE"].read_text(encoding="utf-8") == TOOL["page"]()
    assert {p.parent.name for p in ROOT.glob("*/thresholds.py")} == set(ROOMS)


@pytest.mark.parametrize("room", ROOMS)
def test_a_threshold_has_a_unit_and_a_reason(room):
    stated = TOOL["thresholds"](room)[1]
    module = importlib.import_module(f"carom.{room}.thresholds")
    assert {row.name for row in stated} == {name for name in vars(module) if name.isupper()}
    assert not [row.name for row in stated if not row.unit or not row.reason]


def test_no_name_stands_for_two_thresholds():
    names = Counter(row.name for room in ROOMS for row in TOOL["thresholds"](room)[1])
    assert not [name for name, times in names.items() if times > 1]


IMPORTS = re.compile(r"^from carom\.\w+\.thresholds import (\([^)]*\)|.*)$", re.MULTILINE)
BY_MODULE = re.compile(r"\b(?:limits|thresholds)\.([A-Z]\w+)")


def test_each_threshold_is_used():
    """Imported by its name (ruff finds it where it is not used then), as an attribute, or in its own file."""
    used = set()
    for path in modules().values():
        text = path.read_text()
        used.update(
            BY_MODULE.findall(text), *(re.findall(r"\w+", names) for names in IMPORTS.findall(text))
        )
        if path.name == "thresholds.py":
            nodes = ast.walk(tree(path))
            used |= {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Load)}
    assert not {row.name for room in ROOMS for row in TOOL["thresholds"](room)[1]} - used


#: a smaller number is a threshold; others are factors of a formula
SMALL = 0.02
#: a number of more digits is a coefficient of a method, which nobody chose (`carom.model.tableaus`); what
#: mathematics gives otherwise is written as a quotient, 1.0 / 120.0
FEW = 2


def chosen(path: Path) -> list[str]:
    """Return the small numbers of few digits in a file, by their lines."""
    return [
        f"{path.name}:{node.lineno}: {node.value}"
        for node in ast.walk(tree(path))
        if isinstance(node, ast.Constant)
        and isinstance(node.value, float)
        and 0.0 < node.value < SMALL
        and len(Decimal(repr(node.value)).normalize().as_tuple().digits) <= FEW
    ]


@pytest.mark.parametrize("room", ROOMS)
def test_a_small_number_has_a_name(room):
    """In the file of thresholds of its folder, where it has a unit and a reason."""
    paths = [p for p in sorted((ROOT / room).rglob("*.py")) if p.name != "thresholds.py"]
    found = [where for path in paths for where in chosen(path)]
    assert not found
    assert chosen(ROOT / room / "thresholds.py")  # the others are found
