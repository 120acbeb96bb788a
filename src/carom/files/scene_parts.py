"""A scene as one JSON text, and back."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping

import numpy as np

from carom.files.scene_data import Decoder, Encoder
from carom.scene.scene import Scene

#: what a missing function means, in the words of the file
NOTE = (
    "functions of the user's are not in the file: a scene read from it has placeholders there, which raise "
    "an error when they are called"
)


def scene_to_text(scene: Scene, encoder: Encoder | None = None) -> str:
    """Return a scene as JSON: its parts in the order added, and which pairs touch."""
    encoder, pairs = encoder or Encoder(), scene._pairs
    parts = [encoder.part(part) for part in scene._parts]
    data = {
        "gravity": scene.gravity.tolist(),
        "shapes": encoder.shapes,
        "parts": parts,
        "own_pairs": _names(pairs._own),
        "ignored_pairs": _names(pairs._ignored),
        "combine": pairs._rules,
        "contact_values": encoder.value(pairs._values),
        "all_pairs": pairs.default is not None,
        "functions": encoder.functions,
    }
    if encoder.functions:
        data["note"] = NOTE
    return json.dumps(data, allow_nan=False)


def scene_from_text(
    text: str, functions: Mapping[str, Callable] | None = None
) -> tuple[Scene, list[str]]:
    """Return a scene from its JSON, and the names of functions that are missing in it.

    Parameters
    ----------
    text : str
        What `scene_to_text` has written.
    functions : mapping, optional
        Functions of the user's by name, ``"part.field"``.

    Raises
    ------
    ValueError
        If a name of `functions` is none that the scene knows.
    """
    data = json.loads(text)
    unknown = set(functions or {}) - set(data["functions"])
    if unknown:
        known = ", ".join(map(repr, sorted(set(data["functions"])))) or "none"
        raise ValueError(f"functions must have names of the file ({known}), got {min(unknown)!r}")
    decoder = Decoder(data["shapes"], functions)
    scene = Scene(np.array(data["gravity"], dtype=float))
    for part in data["parts"]:
        scene._parts.add(decoder.part(part))
    pairs, values = scene._pairs, decoder.value(data["contact_values"])
    pairs._own, pairs._ignored = (
        {frozenset(decoder.value(one) for one in pair) for pair in data[name]}
        for name in ("own_pairs", "ignored_pairs")
    )
    pairs._rules = dict(data["combine"])
    pairs._values, pairs.default = values, values if data["all_pairs"] else None
    return scene, decoder.missing


def _names(pairs) -> list:
    """Return pairs of parts, or of a part and the ground, in an order that does not depend on memory."""
    encoder = Encoder()
    named = [[encoder.value(p) for p in sorted(pair, key=lambda p: p.name)] for pair in pairs]
    return sorted(named, key=json.dumps)
