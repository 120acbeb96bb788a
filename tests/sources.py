"""The parsed files of the library, each read once."""

import ast
from functools import cache
from pathlib import Path


@cache
def tree(path: Path) -> ast.Module:
    """Return a parsed file, which nobody changes."""
    return ast.parse(path.read_text())
