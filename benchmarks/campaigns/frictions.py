"""Scenes of other families whose friction is a law of the slip: static and kinetic, Stribeck's, tables."""

from __future__ import annotations

import numpy as np

import carom
from campaigns import crowds, piles, rests, slides, strikes, throws
from campaigns.case import Case

FAMILIES = (throws, slides, strikes, slides, rests, piles, throws, crowds)


def case(seed: int) -> Case:
    """Return case number `seed`: families in turn, a law for each contact or for all pairs."""
    return with_laws(seed, np.random.default_rng([46, seed]), friction)


def with_laws(seed: int, rng, friction) -> Case:
    """Return case number `seed` of the families in turn, with laws drawn for each contact or for all pairs."""
    made = FAMILIES[seed % len(FAMILIES)].case(seed)
    scene, default = made.scene, made.scene.contact_default
    law = friction(rng)
    for contact in scene.contacts:
        one = law if len(scene.contacts) == 1 else friction(rng)
        scene.replace(contact.name, friction=one, friction_held=one)
    if default is not None:
        scene.set_contact_default(
            restitution=default.restitution, friction=law, impact_law=default.impact_law,
            multiple=default.multiple,
        )  # fmt: skip
    made.label["law of friction"] = repr(law)
    return made


def friction(rng) -> carom.Friction:
    """Return a law: also one that rises, and one that is nearly a step."""
    kinetic = 10.0 ** rng.uniform(-2.0, 0.0)
    static = kinetic * 10.0 ** rng.uniform(0.0, 0.7)
    kind = rng.integers(3)
    if kind == 0:
        return carom.Friction(static, kinetic)
    if kind == 1:
        speed = 10.0 ** rng.uniform(-3.0, 1.0)
        return carom.Friction(static, kinetic, speed=speed, exponent=rng.uniform(0.5, 2.0))
    count = int(rng.integers(2, 9))
    speeds = np.append(0.0, np.cumsum(10.0 ** rng.uniform(-3, 0.5, count - 1)))
    values = 10.0 ** rng.uniform(-2.0, 0.3, count)
    return carom.Friction.table(speeds, values if rng.random() < 0.5 else -np.sort(-values))
