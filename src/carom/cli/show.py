"""Output of commands: tables, JSON, and progress with the remaining time."""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Sequence
from typing import Any

from carom.io.progress import Bar

#: width in a pipe or a file: rows are not cut
WIDE = 200


def table(head: Sequence[str], rows: Sequence[Sequence[object]], left: int = 1) -> None:
    """Print a table with the first `left` columns left-aligned and the others right-aligned.

    In a terminal the header is bold (not with NO_COLOR) and long cells wrap; in a pipe rows stay on one line.
    """
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    screen = Console(highlight=False, width=None if sys.stdout.isatty() else WIDE)
    made = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), show_header=any(head))
    for k, name in enumerate(head):
        made.add_column(name, justify="left" if k < left else "right", overflow="fold")
    for row in rows:
        made.add_row(*(Text(str(cell)) for cell in row))
    if screen.is_terminal:
        screen.print(made)
        return
    with screen.capture() as got:
        screen.print(made)
    print("\n".join(line.rstrip() for line in got.get().splitlines()))


def as_json(value: Any) -> None:
    """Print a value as JSON on stdout, with null for numbers that are not finite."""
    print(json.dumps(plain(value), indent=2, ensure_ascii=False, allow_nan=False))


def plain(value: Any) -> Any:
    """Return a value made only of types that JSON has."""
    if isinstance(value, dict):
        return {str(key): plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(one) for one in value]
    if hasattr(value, "tolist"):  # NumPy's
        return plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value if value is None or isinstance(value, (bool, int, float, str)) else str(value)


def progress(what: str) -> Bar:
    """Return a bar with elapsed and remaining time, which is hidden if stderr is not a terminal."""
    return Bar(what, hidden=not sys.stderr.isatty())
