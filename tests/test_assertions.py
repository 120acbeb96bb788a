"""Each test asserts something, and no assertion excuses a case by its name. Read from the code of the tests."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parent
#: calls that are checks: of pytest, and of processes by `check=True`
RAISE = {"raises", "warns", "fail"}


@cache
def trees() -> dict[str, ast.Module]:
    """The code of all files of tests, by the names under which they are imported."""
    found = {}
    for path in ROOT.rglob("*.py"):
        parts = path.relative_to(ROOT).with_suffix("").parts
        package = (path.parent / "__init__.py").exists()
        found[".".join(parts if package else parts[-1:])] = ast.parse(path.read_text())
    return found


class Function(NamedTuple):
    """What a function of a file of tests does."""

    checks: bool  # itself
    calls: frozenset[str]  # last names of what it calls
    asserts: list[ast.Assert]


@cache
def functions(module: str) -> dict[str, Function]:
    """All functions at the top of a file by their names."""
    return {
        node.name: read(node) for node in trees()[module].body if isinstance(node, ast.FunctionDef)
    }


def read(function: ast.FunctionDef) -> Function:
    """Read the code of a function."""
    calls, asserts, checks = set(), [], False
    for node in ast.walk(function):
        if isinstance(node, ast.Assert):
            asserts.append(node)
        elif isinstance(node, ast.Call):
            name = node.func
            calls.add(getattr(name, "attr", getattr(name, "id", "")))
            checks |= any(keyword.arg == "check" for keyword in node.keywords)
        checks |= isinstance(node, ast.Raise)
    checks |= bool(asserts or calls & RAISE) or any(name.startswith("assert_") for name in calls)
    return Function(checks, frozenset(calls), asserts)


@cache
def checking(module: str) -> frozenset[str]:
    """Names in a file of functions that check something, also by others that they call."""
    found, own = set(), functions(module)
    for node in trees()[module].body:
        if isinstance(node, ast.ImportFrom) and node.module in trees():
            known = checking(node.module)
            found |= {name.asname or name.name for name in node.names if name.name in known}
    found |= {name for name, function in own.items() if function.checks}
    while more := {n for n, one in own.items() if n not in found and found & one.calls}:
        found |= more
    return frozenset(found)


def all_tests():
    """Yield the file, the name and the code of each test."""
    for module in trees():
        for name, function in functions(module).items():
            if name.startswith("test_"):
                yield module, name, function


def test_each_test_asserts_something():
    assert [f"{m}::{name}" for m, name, _ in all_tests() if name not in checking(m)] == []


def excuses(node: ast.Assert) -> bool:
    """Whether an assertion holds by `or` for cases that it names: ``assert right or name == "heap"``."""
    if not isinstance(node.test, ast.BoolOp) or not isinstance(node.test.op, ast.Or):
        return False
    return any(
        isinstance(part, ast.Compare)
        and isinstance(part.left, ast.Name)
        and isinstance(part.ops[0], ast.Eq | ast.NotEq | ast.Is | ast.IsNot)
        and ast.unparse(part.comparators[0]) != "None"  # what may be missing is no case
        for part in node.test.values
    )


def test_no_assertion_excuses_a_case():
    """An assertion for some cases is under an `if`, or says what holds for the others: ``right == (...)``."""
    tests = all_tests()
    found = [f"{m}:{line.lineno}" for m, _, test in tests for line in test.asserts if excuses(line)]
    assert found == []
