"""Changes of a scene: parts that are replaced or taken away, and what refers to them.

Parts are frozen, and a solution keeps those of its run. So a part that changes, and each part that refers to it
or gets another number, is made anew. All that are made from one another have one `origin`: so what a method of
the scene once returned stands for the part that is there.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields
from typing import Any, NamedTuple

from carom import arguments, checks
from carom.fields import keep
from carom.scene.bodies import Body, Ground, HalfSpace, StaticBody, mass_and_inertia
from carom.scene.constraints import CONSTRAINTS, Constraint
from carom.scene.contacts import Contact
from carom.scene.coordinates import Combination, Length
from carom.scene.forces import FORCES, AppliedForce
from carom.scene.joints import JOINTS, Joint
from carom.scene.shapes.mesh import shape_given
from carom.scene.stops import Stop
from carom.scene.switch import Switch


class Kind(NamedTuple):
    """A kind of part."""

    called: str  #: in messages
    example: str  #: a value that such a part has
    links: tuple[str, ...] = ()  #: its fields that are other parts, beside those of its definition


#: a part refers only to those of kinds before its own
KINDS: dict[type[Any], Kind] = {
    Body: Kind("body", "mass"),
    HalfSpace: Kind("half-space", "point"),
    StaticBody: Kind("static body", "position"),
    Joint: Kind("joint", "definition", ("parent", "child")),
    AppliedForce: Kind("force", "definition", ("parent", "child")),
    Constraint: Kind("constraint", "definition"),
    Stop: Kind("stop", "restitution", ("joint",)),
    Contact: Kind("contact", "friction", ("body", "other")),
    Switch: Kind("switch", "time", ("parts",)),
}
_RANKS = {kind: k for k, kind in enumerate(KINDS)}
LEAVES = (Switch,)  # to which no part refers
REFERRING = (*FORCES, *CONSTRAINTS, Combination, Length)  # definitions that may contain parts
#: fields of parts and definitions that say which part it is, or to which it refers
_FIXED = {
    "index",
    "name",
    "body",
    "other",
    "parent",
    "child",
    "frames",
    "joint",
    "bodies",
    "terms",
    "parts",
}


def _rank(part) -> int:
    return _RANKS[type(part)]


def origin(part) -> Any:
    """Return the part from which this one was made by changes of its scene; itself if there is none."""
    return vars(part).get("_origin", part)


def of_origin(part, first) -> Any:
    """Return a part that has been made in the place of `first`."""
    keep(part, _origin=origin(first))
    return part


def parts_in(value) -> Iterator[Any]:
    """Yield the parts to which a part or a definition refers, and the ground."""
    own = vars(value)
    for name in KINDS[type(value)].links if type(value) in KINDS else ():
        yield from _parts_of(own[name])
    if isinstance(value, REFERRING):
        for field in fields(value):
            yield from _parts_of(own[field.name])
    elif isinstance(own.get("definition"), REFERRING):
        yield from parts_in(own["definition"])


def _parts_of(value) -> Iterator[Any]:
    if isinstance(value, Combination):
        value = value.terms
    elif isinstance(value, Length):
        value = value.parent, value.child
    if type(value) in KINDS or isinstance(value, Ground):
        yield value
    elif isinstance(value, tuple):
        for one in value:
            yield from _parts_of(one)


def followed(record, made: Mapping[int, Any], **own) -> Any:
    """Return a part or definition that refers to the parts `made` in the place of others, by their `id`.

    It is the record itself if it refers to none of them and has the values `own`.
    """
    alike = all(getattr(record, name) == value for name, value in own.items())
    if alike and not any(id(part) in made for part in parts_in(record)):
        return record
    old = {field.name: getattr(record, field.name) for field in fields(record)}
    new = {name: _followed(value, made) for name, value in old.items()}
    found = object.__new__(type(record))
    keep(found, **new | own)
    if hasattr(found, "__post_init__") and not isinstance(found, Joint):  # whose frames stay exact
        found.__post_init__()
    return of_origin(found, record) if type(record) in KINDS else found


def _followed(value, made: Mapping[int, Any]) -> Any:
    if id(value) in made:
        return made[id(value)]
    if isinstance(value, tuple):
        new = tuple(_followed(one, made) for one in value)
        return value if all(a is b for a, b in zip(new, value)) else new
    return followed(value, made) if isinstance(value, REFERRING) else value


def exchanged(parts: Iterable, changed: Mapping[int, Any]) -> list:
    """Return parts with some `changed`, by their `id`: into others, or None for those that are taken away.

    All others are numbered and refer to parts as it is then.
    """
    numbers, made, found = dict.fromkeys(KINDS, 0), {}, []
    for part in sorted(parts, key=_rank):
        new = changed.get(id(part), part)
        if new is not None:
            found.append(followed(new, made, index=numbers[type(new)]))
            numbers[type(new)] += 1
            if found[-1] is not part:
                made[id(part)] = found[-1]
    return found


def dependents(parts: Iterable, part) -> list:
    """Return the parts that refer to a part, directly or by others."""
    found = [part]
    for one in sorted(parts, key=_rank):
        if any(other is known for other in parts_in(one) for known in found):
            found.append(one)
    return found[1:]


def renewed(part, values: dict[str, Any]) -> Any:
    """Return a part with other values, each checked; `values` are arguments of the method that added it.

    For a joint, force or constraint they are also fields of its definition.
    """
    definition = getattr(part, "definition", None)
    inside = [] if definition is None else [f.name for f in fields(definition)]
    if "shape" in values:
        values["shape"] = shape_given(values["shape"])
    own = sorted(fields(part), key=lambda field: bool(field.kw_only))  # as the method has them
    allowed = [name for name in (*(f.name for f in own), *inside) if name not in _FIXED]
    if isinstance(part, Body):
        allowed.insert(2, "density")
    arguments.check_known(f"replace({part.name!r})", allowed, values)
    own = {name: value for name, value in values.items() if name not in inside}
    if isinstance(part, Body):
        own = _of_body(part, own)
    if isinstance(part, Contact) and "friction" in own and part.friction_held == part.friction:
        own = {"friction_held": None, **own}  # then it is the new friction
    if isinstance(part, Contact):
        own["of_materials"] = tuple(name for name in part.of_materials if name not in own)
    if "definition" in own:
        kinds = JOINTS if isinstance(part, Joint) else (type(definition),)
        checks.instance("definition", own["definition"], kinds)
        definition = own["definition"]
    if len(own) < len(values):
        own["definition"] = _set(definition, {n: v for n, v in values.items() if n not in own})
    return of_origin(_set(part, own), part)


def _set(record, values: Mapping[str, Any]) -> Any:
    found = object.__new__(type(record))
    keep(found, **{field.name: getattr(record, field.name) for field in fields(record)})
    for name, value in values.items():
        object.__setattr__(found, name, value)  # fields check what they are given
    if hasattr(found, "__post_init__"):
        found.__post_init__()
    return found


def _of_body(body: Body, values: dict[str, Any]) -> dict[str, Any]:
    """Return values of a body with its mass and inertia, if they change.

    Where no inertia is given, it is scaled with the mass, or it is that of a new solid shape.
    """
    if not values.keys() & {"shape", "mass", "density", "inertia"}:
        return values
    values = dict(values)
    shape, density = values.get("shape", body.shape), values.pop("density", None)
    mass = values.get("mass", body.mass if density is None else None)
    scaled = "inertia" not in values and (shape is None or shape is body.shape)
    inertia = values.get("inertia", body.inertia if scaled else None)
    values["mass"], values["inertia"] = mass_and_inertia(shape, mass, density, inertia)
    if scaled:
        values["inertia"] = body.inertia * (values["mass"] / body.mass)
    return values


def list_of(parts: Iterable) -> str:
    """Return parts by kind and name, for a message."""
    return ", ".join(f"{KINDS[type(one)].called} {one.name!r}" for one in parts)
