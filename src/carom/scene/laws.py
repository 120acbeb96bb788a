"""The classes of laws of friction and of restitution, by which files know them."""

from __future__ import annotations

import inspect
from importlib import import_module

MODULES = ("friction", "restitution")
LAWS = tuple(
    one
    for name in MODULES
    for _, one in inspect.getmembers(import_module(f"carom.scene.{name}"), inspect.isclass)
    if "_kind" in vars(one)  # it is of a kind, and not a base class
)
