"""Inner kernels have no wrapper for Python: calling one from Python would end the process."""

import ast
from functools import cache
from pathlib import Path

import carom

INNER = {"kernel", "inlined", "unit"}
COMPILED = {*INNER, "entry"}
SOURCE = Path(carom.__file__).parent


def decorators(function: ast.FunctionDef) -> set[str]:
    made = (d.func if isinstance(d, ast.Call) else d for d in function.decorator_list)
    return {d.id for d in made if isinstance(d, ast.Name)}


def module(path: Path) -> str:
    return ".".join(["carom", *path.relative_to(SOURCE).with_suffix("").parts])


@cache  # a file is read once
def parsed(path: Path) -> ast.Module:
    return ast.parse(path.read_text())


def inner_kernels() -> set[tuple[str, str]]:
    return {
        (module(path), node.name)
        for path in SOURCE.rglob("*.py")
        for node in parsed(path).body
        if isinstance(node, ast.FunctionDef) and decorators(node) & INNER
    }


def called_from_python(path: Path, kernels: set[tuple[str, str]]) -> set[str]:
    """Return the inner kernels that plain functions of a file call."""
    tree = parsed(path)
    names = {
        alias.asname or alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
        if (node.module, alias.name) in kernels
    }
    if SOURCE in path.parents:
        names |= {name for where, name in kernels if where == module(path)}
    if not names:
        return names
    return names & {
        call.func.id
        for node in tree.body
        if isinstance(node, ast.FunctionDef) and not decorators(node) & COMPILED
        for call in ast.walk(node)
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name)
    }


def test_python_calls_no_inner_kernel():
    kernels = inner_kernels()
    assert len(kernels) > 50
    files = [*SOURCE.rglob("*.py"), *Path(__file__).parent.rglob("*.py")]
    found = {str(path): called_from_python(path, kernels) for path in files}
    assert not {path: names for path, names in found.items() if names}


def test_a_kernel_has_at_most_six_parameters():
    wide = {
        f"{module(path)}.{node.name}"
        for path in SOURCE.rglob("*.py")
        for node in parsed(path).body
        if isinstance(node, ast.FunctionDef) and decorators(node) & COMPILED
        if len(node.args.args) > 6
    }
    assert wide == set()
