"""The command ``carom``. Each command is a file here: `add` its arguments, `run` its work."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

OK, FAILED, USAGE = 0, 1, 2

_ABOUT = """\
Motion of multibody systems with frictional impacts.

  carom paper       reproduce the paper: figures and tables under out/paper
  carom throw       throw a die many times: how often each face, is it fair
  carom warmup      compile everything once, so that later runs start at once
  carom doctor      check this installation
"""
_END = "'carom COMMAND --help' explains a command. Exit codes: 0 done, 1 failed, 2 wrong arguments."


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are one line and the way to the help."""

    def error(self, message: str):
        self.exit(USAGE, f"{self.prog}: {message} (see '{self.prog} --help')\n")


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command with all its sub-commands."""
    from carom import __version__
    from carom.cli import doctor, paper, throw, warmup

    main = _Parser(
        prog="carom",
        description=_ABOUT,
        epilog=_END,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    main.add_argument("--version", action="version", version=f"carom {__version__}")
    commands = main.add_subparsers(metavar="COMMAND", dest="command")
    for module in (paper, throw, warmup, doctor):
        module.add(commands)
    return main


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return its exit code."""
    from carom.status import SimulationError

    whole = parser()
    try:
        given = whole.parse_args(arguments)
    except SystemExit as leave:  # help, version, or wrong arguments
        return int(leave.code or 0)
    if given.command is None:
        whole.print_help()
        return USAGE
    try:
        return given.run(given)
    except KeyboardInterrupt:
        print("carom: interrupted", file=sys.stderr)
    except ModuleNotFoundError as error:
        extra = f"; try: pip install 'carom[{given.extra}]'" if hasattr(given, "extra") else ""
        print(f"carom {given.command}: {error}{extra}", file=sys.stderr)
    except (SimulationError, ValueError, OSError) as error:
        print(f"carom {given.command}: {error}", file=sys.stderr)
    return FAILED
