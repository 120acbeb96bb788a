"""Values of a scene by name: `part.field`, `gravity`, one component of them, and the law of all contacts.

A field is one of the part, of its definition (a joint, a force, a motor) or of its shape. The names are the
same in `carom.ensemble`, `carom.sensitivities` and `carom.identify`. A system in coordinates has `position` and
`velocity` in the place of gravity, and the fields of its contacts.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from difflib import get_close_matches
from itertools import product
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from carom import checks
from carom.fields import REQUIRED, Value, keep
from carom.generalized.stated import CoordinateContact
from carom.generalized.system import GeneralizedSystem
from carom.geometry.thresholds import ROUND_OFF, UNIT_ERROR
from carom.scene.bodies import Body
from carom.scene.contacts import Contact, check_overlap, far, place
from carom.scene.scene import Scene
from carom.scene.speed_law import SpeedLaw

STATE_FIELDS = {"position": 3, "orientation": 4, "velocity": 3, "angular_velocity": 3}
POSES = ("position", "orientation")
#: numbers of a contact law that the compiled scene has as they are
LAW_FIELDS = ("restitution", "friction", "friction_held", "rolling_friction", "pivoting_friction")
#: what no run depends on, and what has no number or word
LEFT_OUT = ("material", "color", "look")
SPIN, PLACE_OF_RATE = "surface_spin", 1  # a tuple, and where its rate is
AXES, SCALAR_FIRST = ("x", "y", "z"), ("w", "x", "y", "z")
MOMENTS = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
ENDS = ("anchor_parent", "anchor_child")
FOLLOWERS = ("inertia", "friction_held", "rest_length")
#: values of a scene and of a system in coordinates that are of no part
OF_SCENE, OF_SYSTEM = ("gravity",), ("position", "velocity")
Whole: TypeAlias = Scene | GeneralizedSystem


def own_fields(scene: Whole) -> tuple[str, ...]:
    """Return the names of the values of no part."""
    return OF_SYSTEM if isinstance(scene, GeneralizedSystem) else OF_SCENE


def common_fields(scene: Whole) -> tuple[str, ...]:
    """Return the names of values that all contacts may get together."""
    if isinstance(scene, GeneralizedSystem):
        return tuple(name for name in LAW_FIELDS if name in vars_of(CoordinateContact))
    return LAW_FIELDS


class Found(NamedTuple):
    """A field of a part, of its definition or of its shape; or of the whole, which stands for the part then."""

    part: Any
    inside: str  # name of the attribute that has the field, "" for the part
    field: str

    @property
    def owner(self) -> Any:
        """The record that has the field."""
        return getattr(self.part, self.inside) if self.inside else self.part

    @property
    def value(self) -> Any:
        """The value in the scene."""
        return getattr(self.owner, self.field)

    def check(self, value) -> Any:
        """Return a value as the field keeps it; refuse one that it does not take."""
        return vars_of(type(self.owner))[self.field].check(self.field, value)

    @property
    def bounds(self) -> tuple[float, float]:
        """Least and greatest number that the field takes."""
        rule = vars_of(type(self.owner))[self.field].check
        given = getattr(rule, "keywords", {})
        low = 0.0 if rule is checks.mass or "zero" in given else -np.inf
        return given.get("least", given.get("above", low)), given.get("most", np.inf)


def vars_of(kind: type) -> dict[str, Value]:
    """Return the fields of a class that check their values, first those that must be given."""
    found = {}
    for base in reversed(kind.__mro__):
        found |= {name: one for name, one in vars(base).items() if isinstance(one, Value)}
    return dict(sorted(found.items(), key=lambda one: one[1].default is not REQUIRED))


def fields_of(part) -> Iterator[Found]:
    """Yield the fields of a part that may be varied: numbers, arrays of them, and words."""
    for inside in ("", "definition", "shape"):
        if not inside or getattr(part, inside, None) is not None:
            owner = getattr(part, inside) if inside else part
            for field in vars_of(type(owner)):
                value = getattr(owner, field)
                plain = value is None or isinstance(value, (float, str, np.ndarray, SpeedLaw))
                if (plain or field == SPIN) and field not in LEFT_OUT:
                    yield Found(part, inside, field)


def find(scene: Whole, name: str) -> Found | None:
    """Return the field of a part, or of the whole, with this name; None if there is none."""
    if name in own_fields(scene):
        return Found(scene, "", name)
    part, _, field = name.rpartition(".")
    try:
        found = scene[part]
    except KeyError:
        return None
    return next((one for one in fields_of(found) if one.field == field), None)


def components(found: Found) -> dict[str, Any]:
    """Return the places of components by name: of an array, a law, coordinates, or the spin of a surface."""
    value = found.value
    if isinstance(found.part, GeneralizedSystem):
        return {name: k for k, name in enumerate(found.part.coordinate_names)}
    if isinstance(value, SpeedLaw):
        return {name: name for name in vars(value) if isinstance(getattr(value, name), float)}
    if isinstance(value, tuple):
        return {"rate": PLACE_OF_RATE}
    shape = np.shape(value)
    labels = {(3,): AXES, (4,): SCALAR_FIRST}.get(shape, ())
    return MOMENTS if shape == (3, 3) else dict(zip(labels, range(4)))


def split(scene: Whole, name: str, argument: str = "vary") -> tuple[str, str]:
    """Return a name without the component at its end, and this component or nothing.

    Raises
    ------
    ValueError
        If the scene has no value with the name.
    """
    if name in common_fields(scene) or find(scene, name):
        return name, ""
    stem, _, label = name.rpartition(".")
    found = find(scene, stem)
    if found and label in components(found):
        return stem, label
    raise ValueError(_unknown(scene, name, argument))


def whole(scene: Whole, inputs: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return rows for whole fields: components within the values of the scene, a law for each contact."""
    parts = {name: split(scene, name) for name in inputs}
    made = {name: rows for name, rows in inputs.items() if not parts[name][1]}
    laws: dict[str, dict[str, np.ndarray]] = {}  # their numbers
    for name, (stem, label) in parts.items():
        if not label:
            continue
        rows = _shaped(name, inputs[name], ())
        found = find(scene, stem)
        assert found is not None
        value = found.value
        if stem in inputs:
            raise ValueError(f"vary must have {stem!r} or its components, got it and {name!r}")
        if isinstance(value, tuple):
            made[stem] = np.empty(len(rows), dtype=object)
            for k, one in enumerate(rows.tolist()):
                made[stem][k] = (*value[:PLACE_OF_RATE], one, *value[PLACE_OF_RATE + 1 :])
            continue
        if stem not in made:
            made[stem] = np.repeat(np.asarray(value)[None], len(rows), axis=0)
        at = components(found)[label]
        if isinstance(value, SpeedLaw):
            laws.setdefault(stem, {})[label] = rows
            continue
        for one in {at, at[::-1]} if isinstance(at, tuple) else {(at,)}:  # an inertia is symmetric
            made[stem][(slice(None), *one)] = rows
    made |= {stem: _laws(stem, made[stem], numbers) for stem, numbers in laws.items()}
    for field in [name for name in made if name in LAW_FIELDS]:
        default = getattr(scene, "contact_default", None) is not None
        if default or not scene.contacts:
            raise ValueError(
                f"vary[{field!r}] is the value of all contacts of add_contact, got a {scene._parts.whole} with "
                + ("set_contact_default" if default else "none")
            )
        rows = made.pop(field)
        for contact in scene.contacts:
            made.setdefault(f"{contact.name}.{field}", rows)
    return made


def _laws(stem: str, laws: np.ndarray, numbers: dict[str, np.ndarray]) -> np.ndarray:
    """Return laws (R,) with some of their numbers from rows (R,); refuse numbers that they do not take."""
    made = np.empty(len(laws), dtype=object)
    for k, (law, *row) in enumerate(zip(laws, *(rows.tolist() for rows in numbers.values()))):
        try:
            made[k] = replace(law, **dict(zip(numbers, row)))
        except ValueError as error:
            names = " and ".join(repr(f"{stem}.{label}") for label in numbers)
            raise ValueError(f"vary[{names}] in run {k}: {error}") from None
    return made


@dataclass(frozen=True)
class Target:
    """The destination of the values of one name."""

    name: str
    part: str  # name of the part; "" if it is the scene
    field: str
    index: int  # index of the part
    light: bool  # whether the compiled scene can be used again


def find_targets(scene: Whole, inputs: dict[str, np.ndarray]) -> list[Target]:
    """Return the destination of each whole field; refuse values that are not allowed."""
    return [_find(scene, name, values) for name, values in inputs.items()]


def _find(scene: Whole, name: str, values: np.ndarray) -> Target:
    found = find(scene, name)
    assert found is not None
    part, field = found.part, found.field
    if part is scene:
        _shaped(name, values, found.value.shape)
        return Target(name, "", name, -1, False)
    light = _light(scene, found)
    if values.dtype.kind == "U" or isinstance(found.value, str) or not (light or field == "mass"):
        _check_each(name, found, values)
    elif field in STATE_FIELDS:
        _shaped(name, values, (STATE_FIELDS[field],))
        if field == "orientation":
            length = np.linalg.norm(values, axis=1)
            _all(name, np.abs(length - 1.0) <= UNIT_ERROR, values, "unit quaternions (w, x, y, z)")
    else:
        _shaped(name, values, ())
        if field == "mass":
            _all(name, values > 0.0, values, "above 0")
        elif field == "restitution":
            _all(name, (values >= 0.0) & (values <= 1.0), values, "from 0 to 1")
        else:
            _all(name, values >= 0.0, values, "at least 0")
    return Target(name, part.name, field, part.index, light)


def _check_each(name: str, found: Found, values: np.ndarray) -> None:
    """Refuse values that the field does not take; equal ones are looked at once."""
    seen = set()
    for k in range(len(values)):
        row = values[k, ...]  # an object is one too
        if (key := row.tobytes()) not in seen:
            seen.add(key)
            try:
                found.check(row if row.ndim else row.item())
            except ValueError as error:
                raise ValueError(f"vary[{name!r}] in run {k}: {error}") from None


def _light(scene: Whole, found: Found) -> bool:
    """Return whether a field is only a number in the arrays of the compiled scene.

    Joints and forces are placed in the world at the start: if poses vary, they have to be placed again.
    """
    if isinstance(found.part, Contact):
        return found.field in LAW_FIELDS and not isinstance(found.value, SpeedLaw)
    if not isinstance(found.part, Body) or found.field not in STATE_FIELDS:
        return False
    assert isinstance(scene, Scene)  # a system has no bodies
    return found.field not in POSES or not (scene.joints or scene.forces or scene.constraints)


def _unknown(scene: Whole, name: str, argument: str) -> str:
    known = [f"{part.name}.{one.field}" for part in scene._parts for one in fields_of(part)]
    own = own_fields(scene)
    example = next(iter(known), "die.position" if isinstance(scene, Scene) else "wall.friction")
    return (
        f"names in {argument} must be {', '.join(map(repr, own))}, or a part of the {scene._parts.whole} with "
        f"one of its fields, like {example!r}, got {name!r}{_hint(scene, name, [*own, *known])}"
    )


def _hint(scene: Whole, name: str, known: list[str]) -> str:
    """Return the end of a message: the nearest name, or the fields of the part that `name` names."""
    part, _, field = name.rpartition(".")
    try:
        own = [one.field for one in fields_of(scene[part])]
    except KeyError:
        own = []
    if part in own_fields(scene) and not own:
        known = [f"{part}.{one}" for one in components(Found(scene, "", part))]
    near = get_close_matches(field, own, n=1) if own else get_close_matches(name, known, n=1)
    if near:
        meant = f"{part}.{near[0]}" if own else near[0]
        return f"; did you mean {meant!r}?"
    if own:
        return f"; {part!r} has {', '.join(own)}"
    if not isinstance(scene, Scene):
        return ""
    pairs = product(scene.bodies, (*scene.fixed, *scene.bodies))
    default = next(((a, b) for a, b in pairs if part == f"{a.name}-{b.name}"), None)
    if field in LAW_FIELDS and default is not None:
        a, b = (repr(one.name) for one in default)
        return f"; to vary the law of these two give them a contact: scene.add_contact({a}, {b})"
    return ""


def _shaped(name: str, values: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    if values.dtype.kind == "U":
        raise ValueError(f"vary[{name!r}] must be numbers, got {checks.shown(values[0].item())}")
    if values.shape[1:] != shape:
        wanted = ", ".join(["runs", *map(str, shape)])
        raise ValueError(f"vary[{name!r}] must have shape ({wanted}), got {values.shape}")
    _all(name, np.isfinite(values), values, "finite")
    return values


def _all(name: str, good: np.ndarray, values: np.ndarray, allowed: str) -> None:
    if not np.all(good):
        k = int(np.argwhere(~good)[0][0])
        raise ValueError(f"vary[{name!r}] must be {allowed}, got {values[k]} in run {k}")


def changed_system(
    system: GeneralizedSystem, targets: list[Target], values: dict[str, np.ndarray]
) -> GeneralizedSystem:
    """Return a copy of a system in coordinates with the values of one run."""
    laws: dict[str, dict] = {}
    for target in targets:
        value = np.array(values[target.name])
        laws.setdefault(target.part, {})[target.field] = value if value.ndim else value.item()
    state = laws.pop("", {})
    return system._changed(state, laws)


def changed(scene: Scene, targets: list[Target], values: dict[str, np.ndarray]) -> Scene:
    """Return a copy of a scene with the values of one run.

    What a part has by default follows what it was computed from, unless it is varied itself: the inertia the
    mass, and the shape if it was that of the shape; `friction_held` the friction, and the `rest_length` of a
    spring its ends, if they were equal.
    """
    scene = copy.deepcopy(scene)
    named = {target.name for target in targets}
    for target in targets:
        value = np.array(values[target.name])
        value = value if value.ndim else value.item()
        found = find(scene, target.name)
        if found is None:
            continue  # coordinates of a model, to which a run is moved
        if found.part is scene:
            scene._gravity = value
            continue
        follow = {one for one in FOLLOWERS if f"{target.part}.{one}" not in named}
        keep(found.part, **(_inside if found.inside else _direct)(found, value, follow))
        if hasattr(found.part, "__post_init__"):
            found.part.__post_init__()
    scene.validate()
    return scene


def _direct(found: Found, value, follow: set[str]) -> dict:
    """Return a new field of a part, and what follows it."""
    part, field = found.part, found.field
    new = {field: units(value) if field == "orientation" else found.check(value)}
    if field == "mass" and "inertia" in follow:
        new["inertia"] = part.inertia * (new["mass"] / part.mass)
    if field == "friction" and "friction_held" in follow and part.friction_held == part.friction:
        new["friction_held"] = new["friction"]
    return new


def _inside(found: Found, value, follow: set[str]) -> dict:
    """Return what a part is made of, made again with a new field, and what follows it."""
    part, owner = found.part, found.owner
    # by fields as they are kept; what is computed of them is computed again
    made: Any = object.__new__(type(owner))
    vars(made).update({one.name: vars(owner)[one.name] for one in fields(owner) if one.init})
    keep(made, **{found.field: found.check(value)})
    if found.field in ENDS and "rest_length" in follow and hasattr(owner, "rest_length"):
        if owner.rest_length == math.dist(owner.anchor_parent, owner.anchor_child):
            keep(made, rest_length=None)
    if hasattr(made, "__post_init__"):
        made.__post_init__()
    new = {found.inside: made}
    if isinstance(part, Body) and "inertia" in follow:
        if np.allclose(part.inertia, owner.inertia(part.mass), rtol=ROUND_OFF, atol=0.0):
            new["inertia"] = made.inertia(part.mass)
    return new


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
