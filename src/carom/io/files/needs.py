"""Packages that only files need; they are imported where they are used."""

from __future__ import annotations

import importlib
from typing import Any

from carom import checks


def need(package: str, what: str, extra: str = "files") -> Any:
    """Return an optional package of an `extra` of carom; `what` needs it.

    Raises
    ------
    ImportError
        If it is not installed; the message has the command that installs it.
    """
    try:
        return importlib.import_module(package)
    except ImportError as error:
        if error.name is not None and error.name.split(".")[0] != package:
            raise  # it is there, and lacks something itself
        raise checks.missing_package(what, package, extra) from None
