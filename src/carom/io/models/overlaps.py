"""Models that start slightly inside the floor: bodies with free joints are moved out."""

from __future__ import annotations

import numpy as np

from carom.io.models.build import Build
from carom.io.models.links import Link
from carom.io.models.report import need_mujoco
from carom.io.models.solids import Solid
from carom.io.models.state import place
from carom.io.models.touching import Filter
from carom.scene.bodies import Body
from carom.scene.contacts import far, overlap
from carom.scene.contacts import place as place_of
from carom.scene.shapes import Shape

OVERLAP_ROUNDS = 20
Covers = dict[int, tuple[Shape | None, list[int]]]


def lift_out(build: Build, links: list[Link], covers: Covers, standing: list[Solid], rules: Filter):
    """Move bodies with free joints out of fixed parts, each time by the deepest overlap.

    MuJoCo's contacts are soft: a body at rest penetrates the floor. carom allows no penetration.
    """
    model, data = build.model, build.data
    for root in links:
        joint = int(model.body_jntadr[root.body])
        if model.jnt_type[joint] != need_mujoco().mjtJoint.mjJNT_FREE:
            continue
        tree = [one for one in links if model.body_rootid[one.body] == root.body]
        first, shift = int(model.jnt_qposadr[joint]), np.zeros(3)
        for _ in range(OVERLAP_ROUNDS):
            depth, normal = _deepest(build, tree, covers, standing, rules)
            if depth <= 0.0:
                break
            shift += depth * (1.0 + 1e-9) * normal
            data.qpos[first : first + 3] += depth * (1.0 + 1e-9) * normal
            place(model, data)
        if np.any(shift):
            text = f"starts {np.linalg.norm(shift):.3g} m inside fixed parts"
            build.report.add(f"body {root.name!r}", text, f"moved by {shift.round(9).tolist()} m")


def _deepest(build: Build, tree, covers: Covers, standing, rules: Filter):
    """Return the depth of the deepest overlap of a tree with fixed parts, and the direction out of it."""
    deepest, out, still = 0.0, np.zeros(3), np.zeros(3)
    for link in tree:
        shape, geoms = covers[link.body]
        if not geoms:
            continue
        body = Body(0, link.name, shape, 1.0, np.ones(3), *pose(build, link), still, still)
        for solid in standing:
            apart = far(body, solid.part, body.position, place_of(solid.part))
            if apart or rules.between(geoms, solid.geoms).friction is None:
                continue
            depth, normal = overlap(body, solid.part)
            if depth > deepest:
                deepest, out = depth, normal
    return deepest, out


def pose(build: Build, link: Link) -> tuple[np.ndarray, np.ndarray]:
    """Return position of the mass centre and orientation of a link in the world."""
    axes = build.data.xmat[link.body].reshape(3, 3)
    return build.data.xpos[link.body] + axes @ link.centre, build.data.xquat[link.body]
