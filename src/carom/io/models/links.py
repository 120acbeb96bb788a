"""The links of a model: each body with all bodies that are welded to it, as one body of the scene."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom.geometry import quaternion

IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])
TRIANGLE = 1e-12  # by which a greatest principal moment may exceed the sum of the others: rounding


class Link(NamedTuple):
    """A body of the model that moves, and the bodies without joints that it carries."""

    body: int  # number in the model
    name: str
    members: list[int]  # it and those it carries
    mass: float
    centre: np.ndarray  # (3,) mass centre of all, in the axes of the body
    inertia: np.ndarray  # (3, 3) of all about it, in the axes of the body


def name_of(model, kind: str, k: int) -> str:
    """Return the name of element k of a kind of a model, or its kind and number where it has none."""
    return getattr(model, kind)(k).name or f"{kind}{k}"


def called(model, kind: str, k: int) -> str:
    """Return what an element is called in the report."""
    return f"{kind} {name_of(model, kind, k)!r}"


def moving_links(model) -> list[Link]:
    """Return all that moves, parents before children."""
    members: dict[int, list[int]] = {}
    for b in range(1, model.nbody):
        members.setdefault(int(model.body_weldid[b]), []).append(b)
    return [_link(model, b, group) for b, group in sorted(members.items()) if b != 0]


def pose_on_link(model, body: int) -> tuple[np.ndarray, np.ndarray]:
    """Return position and orientation of a body in the axes of the one that carries it."""
    position, orientation = np.zeros(3), IDENTITY
    carrier = int(model.body_weldid[body])
    while body != carrier:
        q, p = model.body_quat[body], model.body_pos[body]
        position = p + quaternion.rotate(q, position)
        orientation = quaternion.multiply(q, orientation)
        body = int(model.body_parentid[body])
    return position, orientation


def _link(model, body: int, members: list[int]) -> Link:
    """Return a link: masses added, inertias moved to the common centre (Steiner)."""
    name = name_of(model, "body", body)
    mass = np.array([model.body_mass[b] for b in members])
    poses = [pose_on_link(model, b) for b in members]
    centres = np.array(
        [p + quaternion.rotate(q, model.body_ipos[b]) for b, (p, q) in zip(members, poses)]
    )
    centre = mass @ centres / mass.sum() if len(members) > 1 else centres[0]
    inertia = np.zeros((3, 3))
    for m, c, b, (_, q) in zip(mass, centres, members, poses):
        axes = quaternion.matrix(quaternion.normalize(quaternion.multiply(q, model.body_iquat[b])))
        arm = c - centre
        inertia += axes @ np.diag(model.body_inertia[b]) @ axes.T
        inertia += m * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return Link(body, name, members, float(mass.sum()), centre, 0.5 * (inertia + inertia.T))


def possible_inertia(
    inertia: np.ndarray, floor: float = 0.0, margin: float = 0.0
) -> tuple[np.ndarray, float]:
    """Return the inertia nearest to one that a body can have, and by what part of it that was changed.

    MuJoCo takes moments of 0 and, by rounding, some that break the triangle inequality a <= b + c; a scene
    takes neither. Small moments are raised: to `floor` [kg m^2] at least, and in a triangle that is broken to
    ``b + c = (1 + margin) a``.
    """
    moments, axes = np.linalg.eigh(inertia)
    possible = np.maximum(moments, max(1e-10 * np.max(np.abs(moments)), floor))
    if possible[2] * (1.0 - TRIANGLE / 2) > possible[0] + possible[1]:
        possible[:2] += 0.5 * (possible[2] * (1.0 + margin) - possible[0] - possible[1])
    change = float(np.max(np.abs(possible - moments)) / max(np.max(np.abs(moments)), floor))
    if change == 0.0:
        return inertia, 0.0
    better = axes @ np.diag(possible) @ axes.T
    return 0.5 * (better + better.T), change
