"""Contact laws, materials, and the rules that combine two materials to the law of a pair.

Restitution and friction are properties of a pair of surfaces, not of one surface: they are measured for each
pair, and no rule computes them correctly from one number of each surface. So the user has to choose a rule by
name; two equal materials need no rule. Other engines use: average, min, max and product (PhysX, Unity,
Unreal), product (Bullet), max (MuJoCo), geometric mean for friction with max for restitution (Box2D).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields
from typing import Any

from carom import arguments, checks
from carom.fields import Number, NumberOrNone, Value, Word, keep, number, word
from carom.scene.friction import anisotropy_of, check_anisotropy, combined_anisotropy
from carom.scene.friction import friction as friction_or_law
from carom.scene.restitution import restitution as number_or_law
from carom.scene.speed_law import SpeedLaw
from carom.scene.stiffness import ABSOLUTE, Hertz
from carom.scene.stiffness import stiffness as absolute_or_relative

IMPACT_LAWS = ("newton", "poisson", "stronge", "moreau")
MULTIPLE = ("simultaneous", "sequential")  # in the order of `carom.impact.multiple.layout`
RULES: dict[str, Callable[[float, float], float]] = {
    "average": lambda a, b: 0.5 * (a + b),
    "min": min,
    "max": max,
    "product": lambda a, b: a * b,
    "geometric": lambda a, b: math.sqrt(a) * math.sqrt(b),
}
COMBINED = (
    "restitution", "friction", "friction_held", "rolling_friction", "pivoting_friction",
    "tangential_restitution",
)  # fmt: skip


def _of_materials(name: str, value) -> tuple[str, ...]:
    return tuple(
        checks.choice(name, one, (*COMBINED, "stiffness"))
        for one in checks.listed(name, value, "words")
    )


@dataclass(frozen=True, kw_only=True)
class ContactLaw:
    """The law of restitution and friction of a pair.

    Attributes
    ----------
    restitution : float or Restitution
        Coefficient of restitution e, from 0 to 1, or its law. Default 0.5.
    friction : float or Friction
        Coulomb's friction coefficient mu in impacts, at least 0, or its law. Default 0.
    friction_held : float or Friction
        mu in persistent contact, at least 0, or its law. Default: `friction`.
    impact_law : {"newton", "poisson", "stronge", "moreau"}
        Definition of e: the ratio of normal speeds ("newton") or of normal impulses ("poisson"), or the square
        root of the ratio of works ("stronge"). "moreau" is that of normal speeds, with friction by the slip
        after the impact.
    stiffness : float, Stiffness or Hertz
        Stiffness of the boundary layer of the contact relative to those of simultaneous contacts, above 0.
        Default 1. Or that of the bodies, from which force and duration of an impact follow; the moduli of
        Hertz's laws also divide impacts of several contacts, if all pairs of a scene have one.
    rolling_friction, pivoting_friction : float
        Greatest moment against rolling, and about the normal, in persistent contact, divided by the normal
        force [m], at least 0. Default 0. Impacts do not use them.
    tangential_restitution : float
        e_t from -1 to 1: an impact that ends in stick leaves the slip -e_t u_t^-, as far as the friction
        allows: below 0 in its direction before. Default 0.
    multiple : {"simultaneous", "sequential"}
        Impact of the pair while other contacts are closed: simultaneous with theirs (default), or an impact of
        its own, one after another.
    adhesion : float
        Force [N] with which the pair holds together while it touches, at least 0. Default 0.
    of_materials : tuple of str
        Names of the values that come from materials, if a part of a `Compound` has a material of its own: each
        two parts then have their own values, and those of the law are for the materials of the bodies.
    """

    restitution: Value[Any, Any] = number_or_law(0.5)
    friction: Value[Any, Any] = friction_or_law(0.0)
    friction_held: Value[Any, Any] = friction_or_law(None)
    impact_law: Word = word(IMPACT_LAWS, "newton")
    stiffness: Value[Any, Any] = Value(absolute_or_relative, 1.0)
    rolling_friction: Number = number(0.0, least=0)
    pivoting_friction: Number = number(0.0, least=0)
    tangential_restitution: Number = number(0.0, least=-1, most=1)
    multiple: Word = word(MULTIPLE, "simultaneous")
    adhesion: Number = number(0.0, least=0)
    of_materials: Value[tuple[str, ...], Iterable[str]] = Value(_of_materials, ())

    def __post_init__(self):
        if self.friction_held is None:
            keep(self, friction_held=self.friction)
        check_anisotropy(self.friction, self.friction_held)

    @property
    def relative_stiffness(self) -> float:
        """The stiffness relative to those of simultaneous contacts: 1 where one in newton is stated.

        If all pairs of a scene have Hertz's law, that of their moduli takes its place.
        """
        return 1.0 if isinstance(self.stiffness, ABSOLUTE) else self.stiffness


@arguments.known
@dataclass(frozen=True)
class Material:
    """The contact properties of a surface; `Scene.set_contact_default` says how two materials combine.

    Parameters
    ----------
    restitution, friction
        e from 0 to 1, and mu at least 0, or their laws, as for `Scene.add_contact`. No rule combines two
        different laws, or a law and a number: pass that of the pair to `Scene.add_contact`.
    friction_held
        mu in persistent contact, at least 0. Default: `friction`.
    stiffness
        Relative stiffness, above 0. Default 1. Two materials act in series: ``2 / (1 / s1 + 1 / s2)``.
    young, poisson
        Young's modulus [Pa] and Poisson's ratio. If both materials of a pair have a modulus, impacts of round
        bodies (two balls, or a ball on a plane) have the force and the duration of Hertz's law
        (`carom.Hertz`). Default None, and 0.3.
    rolling_friction, pivoting_friction
        Greatest moment divided by the normal force [m], at least 0. Default 0.
    tangential_restitution
        e_t from -1 to 1, as for `Scene.add_contact`. Default 0.
    """

    restitution: Value[Any, Any] = number_or_law()
    friction: Value[Any, Any] = friction_or_law()
    friction_held: Value[Any, Any] = friction_or_law(None)
    stiffness: Number = number(1.0, above=0)
    rolling_friction: Number = number(0.0, least=0)
    pivoting_friction: Number = number(0.0, least=0)
    tangential_restitution: Number = number(0.0, least=-1, most=1)
    young: NumberOrNone = number(None, above=0, unit="Pa")
    poisson: Number = number(0.3, least=0, most=0.5)


Rule = str | Mapping[str, str] | None


def checked_rule(combine) -> dict[str, str]:
    """Return the rule of each property that has one; ``combine`` is a name, names by property, or None."""
    if combine is None:
        return {}
    if isinstance(combine, str):
        return dict.fromkeys(COMBINED, checks.choice("combine", combine, RULES))
    if not isinstance(combine, Mapping):
        raise ValueError(
            f"combine must be one of {', '.join(map(repr, sorted(RULES)))} or a dict of these by property, "
            f"got {checks.shown(combine)}"
        )
    return {
        checks.choice("a key of combine", key, COMBINED): checks.choice(
            f"combine[{key!r}]", rule, RULES
        )
        for key, rule in combine.items()
    }


def law_of(first, second, given: Mapping, default: ContactLaw | None, rules: Mapping) -> ContactLaw:
    """Return the law of a pair of a body and another body or a half-space.

    Values `given` for the pair override those of the materials, and these override the default.
    """
    given = {name: value for name, value in given.items() if value is not None}
    if "friction" in given:
        given.setdefault("friction_held", given["friction"])
    default = default or ContactLaw()
    base = {f.name: getattr(default, f.name) for f in fields(ContactLaw)}
    one, two = first.material, second.material
    if one is not None and two is not None:
        open_ones = tuple(name for name in ("stiffness", *COMBINED) if name not in given)
        base |= _values(open_ones, first, second, rules)
        if any(
            getattr(part, "shape", None) and part.shape.has_materials for part in (first, second)
        ):
            base["of_materials"] = open_ones
    elif (one is not None or two is not None) and not {"restitution", "friction"} <= set(given):
        has, lacks = (first, second) if one is not None else (second, first)
        raise ValueError(
            f"material must be given for both bodies of a pair or for none: {has.name!r} has {has.material!r}, "
            f"{lacks.name!r} has none; give it a material, or pass restitution and friction to add_contact"
        )
    return ContactLaw(**{**base, **given})


def law_of_parts(law: ContactLaw, first, second, rules: Mapping) -> ContactLaw:
    """Return the law of two parts, each with a material and a name, from that of their bodies."""
    base: dict[str, Any] = {f.name: getattr(law, f.name) for f in fields(ContactLaw)}
    return ContactLaw(**base | _values(law.of_materials, first, second, rules))


def _values(names: Iterable[str], first, second, rules: Mapping) -> dict[str, Any]:
    """Return some values of the law of two materials."""
    found = {}
    for name in names:
        if name == "stiffness":
            found[name] = _stiffness_of(first, second)
        else:
            found[name] = _combined(name, first, second, rules)
    return found


def _stiffness_of(first, second) -> float | Hertz:
    """Return Hertz's law where both materials are elastic, else two springs in series."""
    one, two = first.material, second.material
    if one.young is not None and two.young is not None:
        return Hertz((one.young, two.young), (one.poisson, two.poisson))
    return 2.0 / (1.0 / one.stiffness + 1.0 / two.stiffness)


def _combined(name: str, first, second, rules: Mapping) -> Any:
    values = []
    for material in (first.material, second.material):
        value = getattr(material, name)
        values.append(material.friction if value is None else value)
    rule, anisotropies = RULES.get(rules.get(name, "")), [anisotropy_of(value) for value in values]
    law = any(isinstance(v, SpeedLaw) and v.by_speed for v in values)
    if any(anisotropies):
        found = combined_anisotropy(name, values[0], values[1], rule)
        if found is not None:
            return found
    elif rule is not None and not law:
        return rule(*values)
    if values[0] == values[1]:
        return values[0]
    if law:
        raise ValueError(
            f"{name} must be given for a pair of materials with different laws, which no rule combines: "
            f"{first.name!r} has {values[0]:g}, {second.name!r} has {values[1]:g}; pass {name} of this pair to "
            "add_contact"
        )
    raise ValueError(
        f"combine must be given, the rule for {name} of two materials: {first.name!r} has {values[0]:g}, "
        f"{second.name!r} has {values[1]:g}; choose a rule with "
        f'set_contact_default(combine="average") or {", ".join(r for r in RULES if r != "average")}, '
        f"or pass {name} of this pair to add_contact"
    )
