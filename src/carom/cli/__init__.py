"""The command ``carom``: `main` runs it and reports each error as an exit code and one line.

Each subcommand is a file of this package, with a function whose arguments are the options; `app.py` collects
them.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

#: exit codes: done; failed; wrong arguments, nothing was run; interrupted (Ctrl-C, as shells have it)
EXIT_OK, FAILED, USAGE, CTRL_C = 0, 1, 2, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code."""
    from typing import Any

    from carom import checks

    try:
        typer: Any = checks.need("typer", "the command", "command")
        from carom.cli.app import command
    except ModuleNotFoundError as error:
        print("carom:", " ".join(str(error).split()), file=sys.stderr)
        return FAILED

    # BadParameter is a UsageError, which is a ClickException: those classes are Click's own, or copies in typer
    usage_error: Any = typer.BadParameter.__mro__[1]
    any_error: Any = typer.BadParameter.__mro__[2]
    whole: Any = command()
    try:
        code = whole.main(
            None if arguments is None else list(arguments), prog_name="carom", standalone_mode=False
        )
    except usage_error as error:
        path = error.ctx.command_path if error.ctx else "carom"
        message = " ".join(error.format_message().split())
        if "No such command" in message:
            message += f" Commands: {', '.join(whole.commands)}."
        print(f"{path}: {message} (see '{path} --help')", file=sys.stderr)
        return USAGE
    except any_error as error:  # pragma: no cover: Click has few others
        print(f"carom: {error.format_message()}", file=sys.stderr)
        return FAILED
    except (KeyboardInterrupt, typer.Abort):
        print("carom: interrupted", file=sys.stderr)
        return CTRL_C
    return int(code or EXIT_OK)
