"""Switches: scenes of other families in which parts break, are released, or are put in, at random moments."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from campaigns import (
    bearings,
    clearances,
    drives,
    forced,
    loads,
    magnets,
    mechanisms,
    plays,
    rests,
    ropes,
    strikes,
    tethers,
)
from campaigns.case import Case
from carom.scene.contacts import Contact
from carom.scene.forces import AppliedForce
from carom.scene.joints import Joint
from carom.scene.more_forces import JointInertia

BASES = {
    "mechanisms": mechanisms, "strikes": strikes, "forced": forced, "rests": rests, "plays": plays,
    "tethers": tethers, "ropes": ropes, "drives": drives, "loads": loads, "clearances": clearances,
    "bearings": bearings, "magnets": magnets,
}  # fmt: skip


def case(seed: int) -> Case:
    """Return the case `seed` of one of the families, with one to three switches."""
    rng = np.random.default_rng([59, seed])
    name = str(rng.choice(list(BASES)))
    base = BASES[name].case(seed)
    scene, parts = base.scene, []
    for part in (
        *base.scene.joints,
        *base.scene.forces,
        *base.scene.constraints,
        *base.scene.stops,
    ):
        if not isinstance(getattr(part, "definition", None), JointInertia):
            parts.append(part)
    parts += scene.contacts
    label = {**base.label, "base": name, "switches": []}
    for k in rng.permutation(len(parts))[: int(rng.integers(1, 4))]:
        _add(scene, parts[k], rng, base.duration)
    label["switches"] = [str(one) for one in scene.switches]
    free = any(isinstance(part, Contact) for one in scene.switches for part in one.parts)
    return replace(base, label=label, off=None, deep=(lambda s: 0.0) if free else base.deep)


def _add(scene, part, rng, duration: float) -> None:
    """Add a switch of a part, and perhaps another one that puts it back."""
    kind, time = (
        str(rng.choice(["time", "begins off", "force", "event"])),
        duration * rng.uniform(0.1, 0.8),
    )
    if kind == "force" and isinstance(part, Joint):
        limits = {"force": 10.0 ** rng.uniform(0, 2.5), "torque": 10.0 ** rng.uniform(-1, 2)}
        if rng.random() < 0.3:
            limits["impulse"] = 10.0 ** rng.uniform(-2, 1)
        scene._breaks(part, {name: float(limit) for name, limit in limits.items()})
        return
    if kind == "begins off" and isinstance(part, (Joint, AppliedForce)):
        if _on(scene, part, 0.5 * time) and rng.random() < 0.5:
            scene.switch(part, at=time)
        return
    if kind == "event":
        body = scene.bodies[int(rng.integers(len(scene.bodies)))].name
        axis, level = int(rng.integers(3)), 0.3 * rng.normal()
        scene.switch(part, at=lambda t, state: state[body].velocity[axis] - level)
    else:
        scene.switch(part, at=time)
    if isinstance(part, (Joint, AppliedForce)) and rng.random() < 0.4:
        _on(scene, part, 0.5 * (time + duration))


def _on(scene, part, time: float) -> bool:
    """Put a part in at a time; return whether that is possible."""
    try:
        scene.switch(part, at=time, off=False)
    except ValueError:
        return False
    return True
