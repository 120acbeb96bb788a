"""The end of a command: its exit code, and one line on stderr for each error."""

from __future__ import annotations

import os
import signal
import sys
import warnings
from collections.abc import Callable
from contextlib import contextmanager
from functools import wraps

from carom.cli import CTRL_C, FAILED, USAGE


class Refused(Exception):
    """Wrong arguments that are found while the command runs; the message is one line."""


class Failed(Exception):
    """A failure of the command; the message is one line."""


def reported(name: str, extra: str = "") -> Callable:
    """Wrap a command: errors become one line on stderr and an exit code; `extra` has its packages."""

    def wrap(function: Callable[..., int | None]) -> Callable[..., int]:
        @wraps(function)
        def run(*args, **kwargs) -> int:
            from carom.status import SimulationError

            with _terminated_as_interrupted(), _plain_warnings(name):
                try:
                    return function(*args, **kwargs) or 0
                except KeyboardInterrupt:
                    return _say(name, "interrupted", CTRL_C)
                except BrokenPipeError:  # the reader has gone, as `head` does
                    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
                    return FAILED
                except ImportError as error:
                    return _say(name, missing(error, extra), FAILED)
                except (Refused, ValueError, TypeError) as error:
                    return _say(name, error, USAGE)
                except (Failed, SimulationError, OSError) as error:
                    return _say(name, error, FAILED)

        return run

    return wrap


def missing(error: ImportError, extra: str = "") -> str:
    """Return a message about an import error, with the command that installs the package."""
    from carom.cli.extras import pip_line

    if "pip install" in str(error) or not error.name:
        return str(error)
    if error.name.split(".")[0] == "carom":
        return f"this is not in carom {_version()} ({error})"
    return f"{error}; try: {pip_line(error.name, extra)}"


def warn(name: str, message: str) -> None:
    """Print a warning line on stderr."""
    _say(name, message, 0)


def _say(name: str, message: object, code: int) -> int:
    line = " ".join(str(message).split())
    print(f"carom {name}: {line}", file=sys.stderr)
    return code


def _version() -> str:
    import carom

    return carom.__version__


@contextmanager
def _plain_warnings(name: str):
    """Show warnings as lines of this command, without files and lines of source."""
    with warnings.catch_warnings():
        warnings.showwarning = lambda message, *_, **__: warn(name, str(message))
        yield


@contextmanager
def _terminated_as_interrupted():
    """Handle SIGTERM, which batch systems send, like Ctrl-C, so that results are saved."""

    def interrupt(*_):
        raise KeyboardInterrupt

    try:
        before = signal.signal(signal.SIGTERM, interrupt)
    except ValueError:  # not in the main thread
        yield
        return
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)
