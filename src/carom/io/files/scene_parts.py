"""A scene as one JSON text, and back."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

from carom import checks
from carom.io.files.scene_check import check_pair, check_part
from carom.io.files.scene_data import PARTS, Decoder, Encoder
from carom.results.robot import Robot
from carom.scene.materials import ContactLaw, checked_rule
from carom.scene.scene import Scene

#: how the text of the scene of a system in coordinates begins
OF_SYSTEM = '{"system": '
#: note in the file about missing functions
NOTE = (
    "user-defined functions are not in the file: a scene read from it has placeholders, which raise an error "
    "when they are called"
)


def scene_to_text(scene: Scene, encoder: Encoder | None = None) -> str:
    """Return a scene as JSON: its parts in the order added, and which pairs touch."""
    encoder, pairs = encoder or Encoder(), scene._pairs
    system = getattr(scene, "system", None)
    parts = [encoder.part(part) for part in scene._parts]
    ignored = [[scene[name] for name in pair] for pair in pairs._ignored]
    data = {
        **({} if system is None else {"system": _of_system(system, encoder)}),
        "gravity": scene.gravity.tolist(),
        "shapes": encoder.shapes,
        "parts": parts,
        "own_pairs": _names([(one.body, one.other) for one in scene.contacts]),
        "ignored_pairs": _names([*ignored, *((one.parent, one.child) for one in scene.joints)]),
        "combine": pairs._rules,
        "contact_values": encoder.value(pairs._values),
        "all_pairs": pairs.default is not None,
        "robot": encoder.value(scene.robot, "robot"),
        **({"look": encoder.value(scene.look, "look")} if scene.look else {}),
        "functions": list(encoder.functions),
    }
    if encoder.functions:
        data["note"] = NOTE
    return json.dumps(data, allow_nan=False)


def _of_system(system, encoder: Encoder) -> dict:
    """Return what tells a system in coordinates from others, beside the bodies that stand for them."""
    names = "name", "restitution", "friction", "impact_law", "tangential_restitution"
    contacts = [[getattr(one, name) for name in names] for one in system.contacts]
    return {
        "constraints": system._model.rows,
        "scale": system.scale.tolist(),
        "contacts": [[encoder.value(value) for value in values] for values in contacts],
    }


def scene_from_text(
    text: str, functions: Mapping[str, Callable] | None = None
) -> tuple[Scene, list[str]]:
    """Return a scene from its JSON, and the names of functions that are missing in it.

    Parameters
    ----------
    text : str
        Output of `scene_to_text`.
    functions : mapping, optional
        User-defined functions by name, ``"part.field"``.

    Raises
    ------
    ValueError
        If the text is not JSON, a scene would refuse a part, or the scene does not have a name in `functions`;
        the message names the part.
    """
    with naming("the text"):
        checks.instance("a scene", text, (str,))
        data = json.loads(text, parse_constant=_no_number)
        checks.instance("a scene", data, (dict,))
        known = [str(name) for name in data["functions"]]
    unknown = set(functions or {}) - set(known)
    if unknown:
        names = ", ".join(map(repr, sorted(set(known)))) or "none"
        raise ValueError(f"functions must have names of the file ({names}), got {min(unknown)!r}")
    decoder = Decoder(functions)
    for k, shape in enumerate(_list(data, "shapes")):
        with naming(f"shapes[{k}]"):
            decoder.shapes.append(decoder.value(shape))
    with naming("gravity"):
        scene = Scene(data["gravity"])
    for k, part in enumerate(_list(data, "parts")):
        with naming(f"parts[{k}]"):
            made = decoder.value(part)
            checks.instance("a part", made, PARTS)
            check_part(scene, made)
            decoder.parts[made.name] = scene._parts.add(made)
    with naming("contacts"):
        _put_pairs(scene, data, decoder)
    with naming("robot"):
        scene._robot = decoder.value(data.get("robot"))
        checks.instance("robot", scene._robot, (Robot, type(None)))
    with naming("look"):
        scene.look = decoder.value(data.get("look"))
    return scene, decoder.missing


def _put_pairs(scene: Scene, data: dict, decoder: Decoder) -> None:
    """Let those pairs of a scene touch that do in the file."""
    pairs, values = scene._pairs, decoder.value(data["contact_values"])
    if values is not None:
        checks.instance("contact_values", values, (ContactLaw,))
    pairs._own, ignored = (
        {check_pair(frozenset(map(decoder.value, pair))) for pair in data[name]}
        for name in ("own_pairs", "ignored_pairs")
    )
    known = {part.name for part in scene._parts}
    pairs._ignored = {pair for pair in ignored if pair <= known} - pairs.joined()
    checks.instance("combine", data["combine"], (dict,))
    pairs._rules = checked_rule(data["combine"])
    pairs._values, pairs.unsaid_default = values, False
    pairs.default = values if checks.flag("all_pairs", data["all_pairs"]) else None


@contextmanager
def naming(where: str) -> Iterator[None]:
    """Name the part of a scene in the message of an error that it causes."""
    try:
        yield
    except Exception as error:
        what = str(error) if isinstance(error, ValueError) else f"{type(error).__name__}: {error}"
        raise ValueError(f"{where}: {what}") from error


def _list(data: dict, name: str) -> list:
    with naming(name):
        checks.instance(name, data[name], (list,))
    return data[name]


def _no_number(name: str):
    raise ValueError(f"{name} is no number of JSON")


def _names(pairs) -> list:
    """Return pairs of parts, or of a part and the ground, in an order that does not depend on memory."""
    encoder = Encoder()
    named = [[encoder.value(p) for p in sorted(pair, key=lambda p: p.name)] for pair in pairs]
    texts = {json.dumps(pair): pair for pair in named}
    return [texts[text] for text in sorted(texts)]
