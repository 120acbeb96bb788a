"""Names of the values that may be varied: `body.field`, `contact.field`, and `gravity`."""

from __future__ import annotations

import copy
from dataclasses import dataclass, replace
from difflib import get_close_matches
from itertools import product

import numpy as np

from carom.fields import keep
from carom.geometry.thresholds import UNIT_ERROR
from carom.scene.bodies import Body
from carom.scene.contacts import Contact, check_overlap, far, place
from carom.scene.scene import Scene

STATE_FIELDS = {"position": 3, "orientation": 4, "velocity": 3, "angular_velocity": 3}
POSES = ("position", "orientation")
LAW_FIELDS = ("restitution", "friction", "friction_held", "rolling_friction", "pivoting_friction")
BODY_FIELDS = ("mass", "inertia")


@dataclass(frozen=True)
class Target:
    """The destination of the values of one name."""

    name: str
    part: str  # name of the body or contact; "" if it is the scene
    field: str
    index: int  # index of the body or contact
    light: bool  # whether the compiled scene can be used again


def find_targets(scene: Scene, inputs: dict[str, np.ndarray]) -> list[Target]:
    """Return the destination of each input; refuse unknown names and values that are not allowed."""
    return [_find(scene, name, values) for name, values in inputs.items()]


def _find(scene: Scene, name: str, values: np.ndarray) -> Target:
    if name == "gravity":
        _shaped(name, values, (3,))
        return Target(name, "", name, -1, False)
    known = _known(scene)
    if name not in known:
        near = get_close_matches(name, known, n=1)
        hint = f"; did you mean {near[0]!r}?" if near else ""
        raise ValueError(
            "names in vary must be 'gravity', or a body or contact of the scene with one of its fields, like "
            f"{next(iter(known), 'die.position')!r}, got {name!r}{hint or _fields_of(scene, name)}"
        )
    part, field = known[name]
    if field in STATE_FIELDS:
        _shaped(name, values, (STATE_FIELDS[field],))
        if field == "orientation":
            length = np.linalg.norm(values, axis=1)
            _all(name, np.abs(length - 1.0) <= UNIT_ERROR, values, "unit quaternions (w, x, y, z)")
    elif field == "inertia":
        if values.shape[1:] not in ((3,), (3, 3)):
            raise ValueError(
                f"vary[{name!r}] must have shape (runs, 3) or (runs, 3, 3) [kg m^2], got {values.shape}"
            )
    else:
        _shaped(name, values, ())
        if field == "mass":
            _all(name, values > 0.0, values, "above 0")
        elif field == "restitution":
            _all(name, (values >= 0.0) & (values <= 1.0), values, "from 0 to 1")
        else:
            _all(name, values >= 0.0, values, "at least 0")
    return Target(name, part.name, field, part.index, _light(scene, field))


def _light(scene: Scene, field: str) -> bool:
    """Return whether a field is only a number in the arrays of the compiled scene.

    Joints and forces are placed in the world at the start: if poses vary, they have to be placed again.
    """
    if field in BODY_FIELDS:
        return False
    return field not in POSES or not (scene.joints or scene.forces or scene.constraints)


def _known(scene: Scene) -> dict:
    fields = (*STATE_FIELDS, *BODY_FIELDS)
    found: dict = {f"{b.name}.{field}": (b, field) for b in scene.bodies for field in fields}
    for contact in scene.contacts:
        found.update({f"{contact.name}.{field}": (contact, field) for field in LAW_FIELDS})
    return found


def _fields_of(scene: Scene, name: str) -> str:
    """Return the end of a message: the fields of the part that `name` names."""
    part, _, field = name.rpartition(".")
    if part in {body.name for body in scene.bodies}:
        return f"; a body has {', '.join((*STATE_FIELDS, *BODY_FIELDS))}"
    if part in {contact.name for contact in scene.contacts}:
        return f"; a contact has {', '.join(LAW_FIELDS)}"
    pairs = product(scene.bodies, (*scene.fixed, *scene.bodies))
    default = next(((a, b) for a, b in pairs if part == f"{a.name}-{b.name}"), None)
    if field in LAW_FIELDS and default is not None:
        a, b = (repr(one.name) for one in default)
        return f"; to vary the law of these two give them a contact: scene.add_contact({a}, {b})"
    return ""


def _shaped(name: str, values: np.ndarray, shape: tuple[int, ...]) -> None:
    if values.shape[1:] != shape:
        wanted = ", ".join(["runs", *map(str, shape)])
        raise ValueError(f"vary[{name!r}] must have shape ({wanted}), got {values.shape}")
    _all(name, np.isfinite(values), values, "finite")


def _all(name: str, good: np.ndarray, values: np.ndarray, allowed: str) -> None:
    if not np.all(good):
        k = int(np.argwhere(~good)[0][0])
        raise ValueError(f"vary[{name!r}] must be {allowed}, got {values[k]} in run {k}")


def changed(scene: Scene, targets: list[Target], values: dict[str, np.ndarray]) -> Scene:
    """Return a copy of a scene with the values of one run.

    Inertia is scaled with the mass, unless it is varied itself; `friction_held` follows `friction` if the two
    were equal.
    """
    scene = copy.deepcopy(scene)
    named = {target.name for target in targets}
    for target in targets:
        value = np.array(values[target.name])
        if target.field == "gravity":
            scene._gravity = value
            continue
        part = scene[target.part]
        if isinstance(part, Body):
            if target.field == "mass" and f"{part.name}.inertia" not in named:
                keep(part, inertia=part.inertia * (float(value) / part.mass))
            if target.field == "inertia" and value.ndim == 1:
                value = np.diag(value)
            if target.field == "orientation":
                value = units(value)
            keep(part, **{target.field: float(value) if value.ndim == 0 else value})
        else:
            assert isinstance(part, Contact)
            follows = target.field == "friction" and f"{part.name}.friction_held" not in named
            if follows and part.friction_held == part.friction:
                keep(part, friction_held=float(value))
            keep(part, **{target.field: float(value)})
    if any(target.field in POSES for target in targets):
        scene.validate()
    return scene


def units(q: np.ndarray) -> np.ndarray:
    """Return q (..., 4) divided by its length, each with the same bits as if it were alone."""
    return q / np.sqrt(np.vecdot(q, q))[..., None]


def may_overlap(scene: Scene, targets: list[Target], values: dict[str, np.ndarray]) -> np.ndarray:
    """Return for which runs (K,) bodies may penetrate each other at the start, so that this is checked."""
    moved = {target.part for target in targets if target.field in POSES}
    places = {target.part: values[target.name] for target in targets if target.field == "position"}
    runs = len(next(iter(values.values())))
    near = np.full(runs, bool(moved) and scene.contact_default is not None)
    for contact in scene.contacts:
        if moved & {contact.body.name, contact.other.name}:
            x, y = (places.get(part.name, place(part)) for part in (contact.body, contact.other))
            near |= ~far(contact.body, contact.other, x, y)
    return near


def check_places(scene: Scene, targets: list[Target], values: dict[str, np.ndarray]) -> None:
    """Refuse bodies that penetrate each other at the start of a run in which poses vary."""
    if scene.contact_default is not None:
        changed(scene, targets, values)
        return
    bodies = {}
    for target in targets:
        if target.field in POSES:
            value = np.array(values[target.name])
            if target.field == "orientation":
                value = units(value)
            body = bodies.get(target.part, scene[target.part])
            bodies[target.part] = replace(body, **{target.field: value})
    for contact in scene.contacts:
        body, other = contact.body, contact.other
        if body.name in bodies or other.name in bodies:
            there = bodies.get(body.name, body), bodies.get(other.name, other)
            check_overlap(f"contact {contact.name!r}", *there)
