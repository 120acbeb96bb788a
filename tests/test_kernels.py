"""Inner kernels have no wrapper for Python: calling one from Python would end the process."""

import ast
import re
from functools import cache
from pathlib import Path

import carom
from sources import tree

INNER = {"kernel", "inlined", "unit"}
COMPILED = {*INNER, "entry"}
SOURCE = Path(carom.__file__).parent


def decorators(function: ast.FunctionDef) -> set[str]:
    made = (d.func if isinstance(d, ast.Call) else d for d in function.decorator_list)
    return {d.id for d in made if isinstance(d, ast.Name)}


def module(path: Path) -> str:
    return ".".join(["carom", *path.relative_to(SOURCE).with_suffix("").parts])


def inner_kernels() -> set[tuple[str, str]]:
    return {
        (module(path), node.name)
        for path in SOURCE.rglob("*.py")
        for node in tree(path).body
        if isinstance(node, ast.FunctionDef) and decorators(node) & INNER
    }


@cache
def imports_of(modules: frozenset[str]) -> re.Pattern[str]:
    """An import from one of some modules, in the text of a file: most files need not be parsed."""
    return re.compile(rf"from ({'|'.join(map(re.escape, modules))}) import")


def called_from_python(path: Path, kernels: set[tuple[str, str]]) -> set[str]:
    """Return the inner kernels that plain functions of a file call."""
    own = SOURCE in path.parents
    if not own and not re.search(imports_of(frozenset(m for m, _ in kernels)), path.read_text()):
        return set()  # it imports none
    parsed = tree(path)
    names = {
        alias.asname or alias.name
        for node in ast.walk(parsed)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
        if (node.module, alias.name) in kernels
    }
    if own:
        names |= {name for where, name in kernels if where == module(path)}
    if not names:
        return names
    return names & {
        call.func.id
        for node in parsed.body
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
        for node in tree(path).body
        if isinstance(node, ast.FunctionDef) and decorators(node) & COMPILED
        if len(node.args.args) > 6
    }
    assert wide == set()
