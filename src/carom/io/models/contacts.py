"""The contacts of the scene: one for each pair of bodies of which geoms may touch."""

from __future__ import annotations

from collections import Counter
from itertools import combinations
from typing import Any

import numpy as np

from carom.io.models.build import Build
from carom.io.models.solids import Solid
from carom.io.models.touching import Filter, Friction
from carom.scene.bodies import FIXED, Body, HalfSpace, StaticBody
from carom.scene.contacts import check_curvature, far, overlap, place

Pair = tuple[Body, Body | HalfSpace | StaticBody]
BY_MATERIAL = Friction(np.nan, np.nan, np.nan)  # that of each two geoms is given by their materials


def add_contacts(
    build: Build, solids: list[Solid], rules: Filter, restitution, friction, law, strict: bool
) -> None:
    """Let all pairs touch that touch in the model.

    The friction that most pairs have is the default of the scene; the others have contacts of their own. If
    geoms have materials, these are the default.
    """
    pairs = touching_pairs(build, solids, rules)
    if friction is not None:
        pairs = {pair: f._replace(sliding=friction) for pair, f in pairs.items()}
    pairs = without_overlaps(build, pairs, strict)
    if not pairs:
        return
    joined = {frozenset((j.parent, j.child)) for j in build.scene.joints}
    common = Counter(pairs.values()).most_common(1)[0][0]
    if rules.restitution is None:
        rule, values = None, _values(common)
    else:
        common, rule, values = None, "max", {}
    build.scene.set_contact_default(restitution=restitution, impact_law=law, combine=rule, **values)
    for first, second in combinations(solids, 2):
        body, other = _ordered(first.part, second.part)
        if not isinstance(body, Body):
            continue
        value = pairs.get((body, other))
        if value is None:
            build.scene.ignore_contact(body, other)
        elif value is BY_MATERIAL and frozenset((body, other)) not in joined:
            continue
        elif value != common or frozenset((body, other)) in joined:
            name = build.names.new(f"{body.name}-{other.name}", "contact")
            own = {} if value is BY_MATERIAL else {"restitution": restitution, **_values(value)}
            build.scene.add_contact(body, other, impact_law=law, name=name, **own)
    _ignore_what_is_seen(build, solids)


def _values(friction: Friction) -> dict[str, Any]:
    return {
        "friction": friction.sliding,
        "pivoting_friction": friction.pivoting,
        "rolling_friction": friction.rolling,
    }


def _ordered(first, second) -> Pair:
    """Return a pair with a body first."""
    return (second, first) if isinstance(first, FIXED) else (first, second)


def touching_pairs(build: Build, solids: list[Solid], rules: Filter) -> dict[Pair, Friction]:
    """Return the pairs of which some geoms touch, with their friction."""
    pairs = {}
    for first, second in combinations(solids, 2):
        if not (first.moves or second.moves) or not (first.geoms and second.geoms):
            continue
        touch = rules.between(first.geoms, second.geoms)
        if touch.friction is None:
            continue
        pair = _ordered(first.part, second.part)
        called = f"pair {pair[0].name!r}, {pair[1].name!r}"
        if touch.some:
            build.report.add(called, "only some of their geoms touch", "all of them touch")
        if rules.restitution is not None and touch.by_material:
            pairs[pair] = BY_MATERIAL
            continue
        if touch.differ:
            build.report.add(
                called,
                "friction differs from geom to geom",
                f"the greatest is used for all, {touch.friction.sliding:g}",
            )
        pairs[pair] = touch.friction
    return pairs


def without_overlaps(build: Build, pairs: dict[Pair, Friction], strict: bool) -> dict:
    """Return the pairs that do not start inside each other; `strict` refuses a model with such ones.

    Bodies that are too round for a height field do not touch it.
    """
    kept = {}
    for (body, other), friction in pairs.items():
        try:
            check_curvature(body, other)
        except ValueError as error:
            called = f"pair {body.name!r}, {other.name!r}"
            build.report.add(called, str(error), "the two do not touch")
            continue
        depth = 0.0 if far(body, other, body.position, place(other)) else overlap(body, other)[0]
        if depth <= 0.0:
            kept[body, other] = friction
            continue
        text = f"{body.name!r} starts {depth:.3g} m inside {other.name!r}"
        if strict:
            raise ValueError(
                f'{text}; start elsewhere (keyframe, qpos), or use overlaps="repair" to leave it out'
            )
        build.report.add(f"pair {body.name!r}, {other.name!r}", text, "the two do not touch")
    return kept


def _ignore_what_is_seen(build: Build, solids: list[Solid]) -> None:
    """Bodies whose geoms touch nothing have shapes all the same, to be drawn."""
    touching = {solid.part for solid in solids if solid.geoms}
    for body in build.scene.bodies:
        if body.shape is not None and body not in touching:
            for other in (*build.scene.bodies, *build.scene.half_spaces, *build.scene.statics):
                if other is not body:
                    build.scene.ignore_contact(body, other)
