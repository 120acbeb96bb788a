"""The package that reads models: imported where it is used."""

from __future__ import annotations

import importlib
from typing import Any

from carom import checks


def need_mujoco() -> Any:
    """Return the module ``mujoco``, or say how to install it.

    Raises
    ------
    ModuleNotFoundError
        If it is not installed.
    """
    try:
        return importlib.import_module("mujoco")
    except ModuleNotFoundError as error:
        if error.name != "mujoco":
            raise  # it is there, and lacks something itself
        raise checks.missing_package("load_model", "mujoco", "models") from None
