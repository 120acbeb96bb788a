"""The digest of scene, functions, settings and inputs that identifies a saved ensemble."""

from __future__ import annotations

import functools
import hashlib
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from carom._compiled.cache_key import stamp
from carom.generalized.scene import CoordinateScene
from carom.generalized.system import GeneralizedSystem
from carom.io.files.scene_data import Encoder
from carom.io.files.scene_parts import scene_to_text
from carom.scene.scene import Scene
from carom.studies.ensembles.plan import Plan


def digest(plan: Plan, inputs: dict[str, np.ndarray]) -> str:
    """Return a digest of an ensemble: of its inputs, settings, scene and functions."""
    found = hashlib.sha256(repr(plan.settings).encode())
    for name, values in sorted(inputs.items()):
        found.update(name.encode() + np.ascontiguousarray(values).tobytes())
    found.update(text_of(plan.varied.source).encode())
    return found.hexdigest()


def text_of(source) -> str:
    """Return a text that differs for another scene, system or function."""
    if isinstance(source, Scene):
        return scene_to_text(source, _Marker())
    if isinstance(source, GeneralizedSystem):
        scene = CoordinateScene(source._apart())
        return "; ".join([*source._model.marks(mark_of), scene_to_text(scene, _Marker())])
    return mark_of(source)


class _Marker(Encoder):
    """An encoder that adds a mark of their code to user-defined functions; a file has only their names."""

    def function(self, value: Any, where: str) -> dict:
        """Return the name of a function and its mark."""
        return {**super().function(value, where), "mark": mark_of(value)}


def mark_of(function: Callable) -> str:
    """Return a text that depends on the code of a function and on the numbers that it uses.

    It does not depend on Python functions that it calls, nor on the contents of objects of other classes.
    """
    return "; ".join(_marks(function))


def _marks(value: Any) -> Iterator[str]:
    if isinstance(value, functools.partial):
        yield from _marks(value.func)
        yield from _marks(value.args)
        yield from _marks(tuple(value.keywords.items()))
        return
    plain = getattr(value, "py_func", value)
    plain = getattr(plain, "__func__", plain)
    if hasattr(plain, "__code__"):
        yield stamp(plain)
        cells = [cell.cell_contents for cell in plain.__closure__ or ()]
        for inner in (*cells, *(plain.__defaults__ or ()), *(plain.__kwdefaults__ or {}).values()):
            yield from _marks(inner)
    elif isinstance(value, (tuple, list)):
        for inner in value:
            yield from _marks(inner)
    elif isinstance(value, np.ndarray):
        yield f"{value.dtype}{value.shape}{hashlib.sha256(value.tobytes()).hexdigest()}"
    elif isinstance(value, (int, float, complex, str, bool, type(None), np.generic)):
        yield repr(value)
    else:
        yield f"{type(value).__module__}.{type(value).__qualname__}"
