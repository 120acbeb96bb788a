"""Scenes of other families whose restitution is a law of the speed: powers, viscoelastic spheres, tables."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import crowds, piles, strikes, throws
from campaigns.case import Case

FAMILIES = (throws, strikes, throws, piles, throws, crowds)


def case(seed: int) -> Case:
    """Return case number `seed`: families in turn, a law for each contact or for all pairs."""
    rng = np.random.default_rng([13, seed])
    made = FAMILIES[seed % len(FAMILIES)].case(seed)
    scene, default = made.scene, made.scene.contact_default
    law = restitution(rng)
    for contact in scene.contacts:
        given = {"restitution": law if len(scene.contacts) == 1 else restitution(rng)}
        if seed % 5 == 0:
            given["tangential_restitution"] = rng.uniform(-1.0, 1.0)
        scene.replace(contact.name, **given)
    if default is not None:
        scene.set_contact_default(
            restitution=law, friction=default.friction, friction_held=default.friction_held,
            impact_law=default.impact_law, multiple=default.multiple,
        )  # fmt: skip
    made.label["restitution"] = repr(law)
    return made


def restitution(rng) -> carom.Restitution:
    """Return a law: also one that rises, and one that is hardly elastic or hardly plastic."""
    kind = rng.integers(3)
    if kind == 0:
        return carom.Restitution.power(
            rng.uniform(0.0, 1.2), speed=10.0 ** rng.uniform(-1, 1),
            exponent=rng.choice([-0.25, -0.25, rng.uniform(-1, 1)]), maximum=rng.uniform(0.2, 0.98),
        )  # fmt: skip
    if kind == 1:
        return carom.Restitution.viscoelastic(10.0 ** rng.uniform(-1.0, 0.5))
    count = int(rng.integers(2, 9))
    speeds = np.cumsum(10.0 ** rng.uniform(-3, 0.5, count))
    values = rng.uniform(0.0, 0.98, count)
    return carom.Restitution.table(speeds, values if rng.random() < 0.5 else -np.sort(-values))
