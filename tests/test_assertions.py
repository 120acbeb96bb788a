"""Each test asserts something, and no assertion excuses a case by its name. Read from the code of the tests."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

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


def called(node: ast.AST):
    """Yield the last names of all that is called in a node."""
    for call in ast.walk(node):
        if isinstance(call, ast.Call):
            yield call.func.attr if isinstance(call.func, ast.Attribute) else ast.unparse(call.func)


def checks(node: ast.AST) -> bool:
    """Whether a function checks something itself."""
    for part in ast.walk(node):
        if isinstance(part, ast.Assert | ast.Raise):
            return True
        if isinstance(part, ast.keyword) and part.arg == "check":
            return True
    return any(name in RAISE or name.startswith("assert_") for name in called(node))


def functions(tree: ast.Module) -> dict[str, ast.FunctionDef]:
    """All functions of a file by their names."""
    return {node.name: node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}


@cache
def checking(module: str) -> frozenset[str]:
    """Names in a file of functions that check something, also by others that they call."""
    tree, found = trees()[module], set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module in trees():
            known = checking(node.module)
            found |= {name.asname or name.name for name in node.names if name.name in known}
    own = functions(tree)
    found |= {name for name, node in own.items() if checks(node)}
    while more := {n for n, node in own.items() if n not in found and found & {*called(node)}}:
        found |= more
    return frozenset(found)


def all_tests():
    """Yield the file and the code of each test."""
    for module, tree in trees().items():
        for name, node in functions(tree).items():
            if name.startswith("test_"):
                yield module, node


def test_each_test_asserts_something():
    nothing = [f"{m}::{node.name}" for m, node in all_tests() if node.name not in checking(m)]
    assert nothing == []


def excuses(node: ast.AST) -> bool:
    """Whether an assertion holds by `or` for cases that it names: ``assert right or name == "heap"``."""
    if not isinstance(node, ast.Assert) or not isinstance(node.test, ast.BoolOp):
        return False
    return isinstance(node.test.op, ast.Or) and any(
        isinstance(part, ast.Compare)
        and isinstance(part.left, ast.Name)
        and isinstance(part.ops[0], ast.Eq | ast.NotEq | ast.Is | ast.IsNot)
        for part in node.test.values
    )


def test_no_assertion_excuses_a_case():
    """An assertion for some cases is under an `if`, or says what holds for the others: ``right == (...)``."""
    found = [
        f"{module}:{part.lineno}"
        for module, node in all_tests()
        for part in ast.walk(node)
        if excuses(part) and "None" not in ast.unparse(part)  # what may be missing is no case
    ]
    assert found == []
