"""Scenes from files: Python, JSON, a result file, or a model (MJCF, URDF)."""

from __future__ import annotations

import runpy
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from carom.cli.outcome import Failed, Refused

MODELS = (".xml", ".mjcf", ".urdf")
RESULTS = (".nc", ".h5", ".hdf5", ".nc4")


class Found(NamedTuple):
    """A scene, and the settings in its file."""

    scene: Any
    settings: dict[str, Any]


def load(path: Path, **model: Any) -> Found:
    """Return the scene of a file; `model` has values that replace those of a model (None: not replaced).

    Raises
    ------
    Refused
        If the file has no scene, or its kind cannot have one.
    Failed
        If the Python code in it failed.
    """
    suffix = path.suffix.lower()
    given = {name: value for name, value in model.items() if value is not None}
    if suffix in MODELS:
        return Found(_model(path, given), {})
    if given:
        names = " and ".join(f"--{name.replace('_', '-')}" for name in given)
        raise Refused(f"{names} only with a model ({', '.join(MODELS)}), got {str(path)!r}")
    if suffix == ".py":
        return _python(path)
    if suffix == ".json":
        return Found(_json(path), {})
    if suffix in RESULTS:
        from carom import Solution

        solution = Solution.load(path)
        return Found(solution.scene, dict(solution.settings))
    kinds = ", ".join((".py", ".json", *RESULTS[:2], *MODELS))
    raise Refused(f"SCENE must be a file with a suffix of {kinds}, got {str(path)!r}")


def functions(scene) -> dict[str, Callable]:
    """Return the user-defined functions of a scene, by their names in a result file."""
    from carom.io.files.scene_data import Encoder

    encoder = Encoder()
    for part in scene._parts:
        encoder.part(part)
    return encoder.functions


def _model(path: Path, given: dict[str, Any]):
    """Read MJCF or URDF; a line on stderr tells about each part that is left out or changed."""
    from carom import load_model

    key = given.get("keyframe")
    if key is not None and key.isdigit():
        given["keyframe"] = int(key)
    made = load_model(path, **given)
    if len(made.report):
        print(made.report, file=sys.stderr)
    return made.scene


def _json(path: Path):
    from carom.io.files.scene_parts import scene_from_text

    try:
        scene, _ = scene_from_text(path.read_text(encoding="utf-8"))
    except ValueError as error:
        what = "'carom info FILE --scene' prints a scene in this form"
        raise Refused(
            f"SCENE must be a scene as JSON, got {str(path)!r} ({error}); {what}"
        ) from None
    return scene


def _python(path: Path) -> Found:
    """Run a file; its `scene` is a Scene, or a function without arguments that returns one."""
    from carom import GeneralizedSystem, Scene

    sys.path.insert(0, str(path.parent))  # as `python file.py` has it
    try:
        names = runpy.run_path(str(path), run_name="carom_scene")
        made = names.get("scene")
        made = made() if callable(made) else made
    except Exception as error:
        raise Failed(f"{_where(path, error)}: {type(error).__name__}: {error}") from error
    finally:
        sys.path.remove(str(path.parent))
    if not isinstance(made, (Scene, GeneralizedSystem)):
        what = "none" if made is None else f"a {type(made).__name__}"
        raise Refused(
            f"SCENE must define 'scene', a carom.Scene or a function without arguments that returns one; "
            f"{str(path)!r} has {what}"
        )
    return Found(made, {})


def _where(path: Path, error: BaseException) -> str:
    """Return the last line of the user's file in the traceback of an error."""
    if isinstance(error, SyntaxError):
        return f"{error.filename}, line {error.lineno}"
    here = [
        frame for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)
    ]
    return f"{path}, line {here[-1].lineno}" if here else str(path)
