"""Inner kernels have no wrapper for Python: calling one from Python would end the process."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import carom
from sources import tree

INNER = {"kernel", "inlined", "unit", "by_kind", "by_element", "by_coordinate", "by_ground"}
COMPILED = {*INNER, "entry"}
SOURCE = Path(carom.__file__).parent
FROM = re.compile(r"from ([\w.]+) import")


def decorators(function: ast.FunctionDef) -> set[str]:
    made = (d.func if isinstance(d, ast.Call) else d for d in function.decorator_list)
    return {d.id for d in made if isinstance(d, ast.Name)}


def module(path: Path) -> str:
    return ".".join(["carom", *path.relative_to(SOURCE).with_suffix("").parts])


def kernels_in_source(marks: set[str]) -> Iterator[tuple[str, ast.FunctionDef]]:
    """Yield the module and the code of all functions with one of some decorators."""
    for path in SOURCE.rglob("*.py"):
        if (
            "carom._compiled" in path.read_text()
        ):  # without an import of the decorators there is none
            for node in tree(path).body:
                if isinstance(node, ast.FunctionDef) and decorators(node) & marks:
                    yield module(path), node


def inner_kernels() -> dict[str, set[str]]:
    """Return the names of inner kernels by module."""
    found: dict[str, set[str]] = {}
    for where, node in kernels_in_source(INNER):
        found.setdefault(where, set()).add(node.name)
    return found


def called_from_python(path: Path, kernels: dict[str, set[str]]) -> set[str]:
    """Return the inner kernels that plain functions of a file call."""
    here = module(path) if SOURCE in path.parents else ""
    imports = set(FROM.findall(path.read_text())) & kernels.keys()
    if not imports and here not in kernels:
        return set()  # most files need not be parsed
    parsed = tree(path)
    names = kernels.get(here, set()) | {
        alias.asname or alias.name
        for node in ast.walk(parsed)
        if isinstance(node, ast.ImportFrom) and node.module in imports
        for alias in node.names
        if alias.name in kernels[node.module]
    }
    return names & {
        call.func.id
        for node in parsed.body
        if isinstance(node, ast.FunctionDef) and not decorators(node) & COMPILED
        for call in ast.walk(node)
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Name)
    }


def test_python_calls_no_inner_kernel():
    kernels = inner_kernels()
    assert sum(map(len, kernels.values())) > 50
    files = [*SOURCE.rglob("*.py"), *Path(__file__).parent.rglob("*.py")]
    found = {str(path): called_from_python(path, kernels) for path in files}
    assert not {path: names for path, names in found.items() if names}


def test_a_kernel_has_at_most_six_parameters():
    kernels = kernels_in_source(COMPILED)
    assert {f"{where}.{one.name}" for where, one in kernels if len(one.args.args) > 6} == set()
