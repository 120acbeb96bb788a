"""The command ``carom`` with all its subcommands."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Annotated

import typer

from carom.cli import USAGE, bench, doctor, info, paper, pictures, simulate, throw, view, warmup
from carom.cli.outcome import reported

_ABOUT = """\
Motion of multibody systems with frictional impacts.

For example:
  carom simulate die.py -o die.h5 --duration 2    run a scene, save the result
  carom info die.h5                               print a summary of the result
  carom plot die.h5 energy -o energy.png          plot the result
  carom paper                                     reproduce the paper
"""
_END = """\
'carom COMMAND --help' explains a command, with examples. Exit codes: 0 done, 1 failed, 2 wrong arguments
(nothing was run), 130 interrupted. Results are written to stdout, progress and errors (one line each) to
stderr.
"""

#: name, function, and the extra that it needs, in the order of the help
COMMANDS: tuple[tuple[str, Callable, str], ...] = (
    ("simulate", simulate.run, "files"),
    ("info", info.run, ""),
    ("view", view.run, "view"),
    ("plot", pictures.plot, "plot"),
    ("film", pictures.film, "film"),
    ("throw", throw.run, "ensemble"),
    ("paper", paper.run, "paper"),
    ("bench", bench.run, ""),
    ("warmup", warmup.run, ""),
    ("doctor", doctor.run, ""),
)


def _version(wanted: bool) -> None:
    if wanted:
        from carom import __version__

        typer.echo(f"carom {__version__}")
        raise typer.Exit


def _laid_out(text: str | None) -> str:
    """Return a help text that keeps the lines of paragraphs with indented lines (by Click's mark)."""
    parts = inspect.cleandoc(text or "").split("\n\n")
    return "\n\n".join(f"\b\n{part}" if "\n  " in f"\n{part}" else part for part in parts)


def _top(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
        raise typer.Exit(USAGE)


def command():
    """Return the command.

    Its help is plain text, wrapped to the width of the terminal, also in a pipe or a log.
    """
    app = typer.Typer(
        rich_markup_mode=None, pretty_exceptions_enable=False, help=_laid_out(_ABOUT), epilog=_END,
        context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    )  # fmt: skip
    app.callback(invoke_without_command=True, help=_laid_out(_ABOUT), epilog=_END)(_top)
    for name, function, extra in COMMANDS:
        app.command(name, help=_laid_out(function.__doc__))(reported(name, extra)(function))
    return typer.main.get_command(app)
