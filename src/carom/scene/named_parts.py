"""Parts that a definition names: they are looked up when the definition is added to a scene."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from carom.fields import keep
from carom.scene.bodies import Body
from carom.scene.constraints import Coupling, acts_along
from carom.scene.joints import Joint


def with_parts(definition: Any, member: Callable) -> Any:
    """Return a definition whose joints and bodies are parts of a scene; one that has them already as it is.

    Parameters
    ----------
    definition : a force or a constraint
    member : `carom.scene.registry.Registry.member` of the scene

    Raises
    ------
    ValueError
        If the scene has no part with such a name (with the nearest one), or if a part is of another scene.
    """
    if isinstance(definition, Coupling):
        terms = tuple(
            (member("each joint of the definition", joint, (Joint,)), k, factor)
            for joint, k, factor in definition.terms
        )
        if len({term[:2] for term in terms}) != len(terms):
            raise ValueError(
                f"each joint of the definition must be given once, got {[t[0].name for t in terms]}"
            )
        for joint, k, _ in terms:
            acts_along(joint, k, "each joint of the definition")
        if terms == definition.terms:
            return definition
        made = copy.copy(definition)
        keep(made, terms=terms)
        return made
    fields = {}
    if hasattr(definition, "joint"):
        fields["joint"] = member("joint of the definition", definition.joint, (Joint,))
    elif hasattr(definition, "bodies"):
        fields["bodies"] = tuple(
            member("each body of the definition", body, (Body,)) for body in definition.bodies
        )
    known = all(getattr(definition, name) == part for name, part in fields.items())
    return definition if known else replace(definition, **fields)
