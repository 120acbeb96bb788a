"""Inner kernels have no wrapper for Python: calling one from Python would end the process."""

import ast
from functools import cache
from pathlib import Path

import pytest

import carom

INNER = {"kernel", "inlined", "unit"}
COMPILED = {*INNER, "entry"}
SOURCE = Path(carom.__file__).parent


def decorators(function: ast.FunctionDef) -> set[str]:
    made = (d.func if isinstance(d, ast.Call) else d for d in function.decorator_list)
    return {d.id for d in made if isinstance(d, ast.Name)}


def module(path: Path) -> str:
    return ".".join(["carom", *path.relative_to(SOURCE).with_suffix("").parts])


@cache  # every file is asked about, and there are many
def inner_kernels() -> set[tuple[str, str]]:
    return {
        (module(path), node.name)
        for path in SOURCE.rglob("*.py")
        for node in ast.parse(path.read_text()).body
        if isinstance(node, ast.FunctionDef) and decorators(node) & INNER
    }


@pytest.mark.parametrize(
    "path", [*SOURCE.rglob("*.py"), *Path(__file__).parent.rglob("*.py")], ids=lambda p: p.name
)
def test_python_calls_no_inner_kernel(path):
    kernels, tree = inner_kernels(), ast.parse(path.read_text())
    assert len(kernels) > 50
    names = {
        alias.asname or alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
        if (node.module, alias.name) in kernels
    }
    if SOURCE in path.parents:
        names |= {name for where, name in kernels if where == module(path)}
    called = {
        call.func.id
        for node in tree.body
        if isinstance(node, ast.FunctionDef) and not decorators(node) & COMPILED
        for call in ast.walk(node)
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name)
    }
    assert not called & names


def test_a_kernel_has_at_most_six_parameters():
    wide = {
        f"{module(path)}.{node.name}"
        for path in SOURCE.rglob("*.py")
        for node in ast.parse(path.read_text()).body
        if isinstance(node, ast.FunctionDef) and decorators(node) & COMPILED
        if len(node.args.args) > 6
    }
    assert wide == set()
