"""Scenes of other families whose friction is anisotropic; the forces are measured by the ellipse itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import carom
from campaigns import frictions
from campaigns.case import Case
from carom.geometry import quaternion
from carom.scene.friction import FrictionLaw

#: how far a force may be beyond its ellipse, as a part of the greatest; sine below which anisotropy fades out;
#: number of forces, and of impulses, that are looked at
EXCESS, FADES, LOOKS = 1e-6, 0.1, 300


def case(seed: int) -> Case:
    """Return case number `seed`: families in turn, a law for each contact or for all pairs."""
    made = frictions.with_laws(seed, np.random.default_rng([47, seed]), friction)
    made.off = off
    return made


def by_slip(seed: int) -> Case:
    """Return case number `seed` of laws of the direction and of the slip in one."""
    made = frictions.with_laws(seed, np.random.default_rng([48, seed]), friction_by_slip)
    made.off = off
    return made


def friction_by_slip(rng) -> carom.Friction:
    """Return a law of the slip along an axis, with a ratio from 1/30 to 30."""
    law, along = friction(rng), frictions.friction(rng)
    return replace(law, along=along, across=along.bound * law.across / law.along)


def friction(rng) -> carom.Friction:
    """Return a law with a ratio from 1/30 to 30, fixed to any of both bodies or to the world."""
    most = rng.uniform(0.05, 1.2)
    both = [most, most / 30.0 ** rng.uniform(0.0, 1.0)]
    along, across = rng.permutation(both)
    of = str(rng.choice(["body", "other", "world"]))
    return carom.Friction(axis=rng.normal(size=3), along=along, across=across, of=of)


def off(s: carom.Solution) -> float:
    """Return how far forces and impulses are beyond the ellipses of their laws, in units of EXCESS."""
    forces, impacts, spaces = s.forces, s.impacts, s.scene.half_spaces
    of_forces, of_impulses = (np.max(f[:, 0], initial=0.0) for f in (forces.force, impacts.impulse))
    rows, chosen = [], slice(None, None, 1 + len(forces) // LOOKS)
    for c, k, f in zip(forces.contact[chosen], forces.saved[chosen], forces.force[chosen]):
        plane = s.pairs.plane[c] if c < len(s.pairs) else -1  # stops of joints follow
        if 0 <= plane < len(spaces):
            rows.append((c, spaces[plane].normal, s.orientation[k], f / of_forces))
    chosen = slice(None, None, 1 + len(impacts) // LOOKS)
    many = len(impacts) > LOOKS  # attitudes between saved times would take longer than the run
    times = impacts.time[:0] if many else np.minimum(impacts.time, s.t[-1])
    turns = s.evaluate(times)[1] if len(times) else [None] * len(impacts)
    columns = impacts.contact, impacts.normal, turns, impacts.impulse
    for c, n, q, p in zip(*(column[chosen] for column in columns)):
        if c < len(s.pairs) and (q is not None or law_of(s, c).of == "world"):
            rows.append((c, n, q, p / of_impulses))
    return max((beyond(s, *row) for row in rows), default=0.0) / EXCESS


def beyond(s: carom.Solution, contact: int, normal, orientation, force) -> float:
    """Return how far a force is beyond its ellipse; 0 where anisotropy fades out."""
    law = law_of(s, contact)
    if abs(axis_of(s, contact, law, orientation) @ normal) > np.sqrt(1.0 - FADES**2):
        return 0.0
    along, across = law.along, law.across
    if isinstance(along, FrictionLaw):  # the greatest ellipse
        most = max(along.bound, np.max(along(np.append(0.0, np.geomspace(1e-6, 1e3, 500)))))
        along, across = most, across * most / along.bound
    return float(np.hypot(force[1] / along, force[2] / across) - force[0])


def law_of(s: carom.Solution, contact: int) -> carom.Friction:
    """Return the law of friction of a contact."""
    return s.pairs.laws[s.pairs.law[contact]].friction


def axis_of(s: carom.Solution, contact: int, law: carom.Friction, orientation) -> np.ndarray:
    """Return the axis of a law in the world."""
    pairs, turn = s.pairs, None
    if law.of == "body":
        turn = orientation[pairs.body[contact]]
    elif law.of == "other" and pairs.other[contact] >= 0:
        turn = orientation[pairs.other[contact]]
    elif law.of == "other":
        fixed = s.scene.fixed[pairs.plane[contact]]
        turn = getattr(fixed, "orientation", None)
    return np.array(law.axis) if turn is None else quaternion.rotate(turn, law.axis)
