"""How a command ends: its exit code, and one line on stderr for whatever went wrong."""

from __future__ import annotations

import os
import signal
import sys
import warnings
from collections.abc import Callable
from contextlib import contextmanager
from functools import wraps

from carom.cli import FAILED, INTERRUPTED, USAGE


class Refused(Exception):
    """Wrong arguments that are only seen while the command works; its message is one line."""


class Failed(Exception):
    """Something that went wrong, in one line."""


def told(name: str, extra: str = "") -> Callable:
    """Wrap a command: errors become one line on stderr and an exit code; `extra` is what it needs of pip."""

    def wrap(function: Callable[..., int | None]) -> Callable[..., int]:
        @wraps(function)
        def run(*args, **kwargs) -> int:
            from carom.status import SimulationError

            with _terminated_as_interrupted(), _plain_warnings(name):
                try:
                    return function(*args, **kwargs) or 0
                except KeyboardInterrupt:
                    return _say(name, "interrupted", INTERRUPTED)
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
    """Return what an import error is about, with the line that installs it."""
    from carom.cli.extras import pip_line

    if "pip install" in str(error) or not error.name:
        return str(error)
    if error.name.split(".")[0] == "carom":
        return f"this is not in carom {_version()} ({error})"
    return f"{error}; try: {pip_line(error.name, extra)}"


def warn(name: str, message: str) -> None:
    """Print a line on stderr that is no failure."""
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
    """Take a request to end (SIGTERM, as batch systems send it) like Ctrl-C, so that work is kept."""

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
