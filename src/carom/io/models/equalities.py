"""Equality constraints of a model: points connected, bodies welded, joints and fixed tendons coupled."""

from __future__ import annotations

import numpy as np

from carom.geometry import quaternion
from carom.io.models.build import Build
from carom.io.models.joints import in_body
from carom.io.models.links import IDENTITY, called, name_of
from carom.io.models.report import need_mujoco
from carom.io.models.tendons import fixed_tendon
from carom.scene import constraints, joints
from carom.scene.bodies import Ground

FITS = 1e-9  # by the extent of the model: what may be missing at the start without a word

Frame = tuple[np.ndarray, np.ndarray]


def add_equalities(build: Build) -> None:
    """Add all that is active."""
    model, kinds = build.model, need_mujoco().mjtEq
    for e in range(model.neq):
        what = called(model, "equality", e)
        kind = model.eq_type[e]
        if not model.eq_active0[e]:
            build.report.add(what, "is not active at the start", "left out")
        elif kind == kinds.mjEQ_CONNECT:
            _tie(build, e, what, joints.Spherical((0.0, 0.0, 0.0)), *_connected(build, e))
        elif kind == kinds.mjEQ_WELD:
            _tie(build, e, what, joints.Fixed((0.0, 0.0, 0.0)), *_welded(build, e))
        elif kind == kinds.mjEQ_JOINT:
            _couple(build, e, what)
        elif kind == kinds.mjEQ_TENDON:
            _couple_tendons(build, e, what)
        else:
            build.report.add(what, "is between deformable bodies", "left out")


def _sides(build: Build, e: int) -> tuple[int, int, list[Frame] | None]:
    """Return both bodies, and where sites are given the frames of these in the world."""
    model, data = build.model, build.data
    ids = int(model.eq_obj1id[e]), int(model.eq_obj2id[e])
    if model.eq_objtype[e] != need_mujoco().mjtObj.mjOBJ_SITE:
        return *ids, None
    frames = [
        (data.site_xpos[s].copy(), quaternion.from_matrix(data.site_xmat[s].reshape(3, 3)))
        for s in ids
    ]
    return int(model.site_bodyid[ids[0]]), int(model.site_bodyid[ids[1]]), frames


def _connected(build: Build, e: int) -> tuple[int, int, Frame, Frame]:
    """Return both bodies and the points, as frames of the world, that are to be one."""
    first, second, frames = _sides(build, e)
    if frames is None:
        given = build.model.eq_data[e]
        points = (given[0:3], given[3:6])
        frames = [(_point(build, b, p), IDENTITY) for b, p in zip((first, second), points)]
    return first, second, (frames[0][0], IDENTITY), (frames[1][0], IDENTITY)


def _welded(build: Build, e: int) -> tuple[int, int, Frame, Frame]:
    """Return both bodies and the frames of the world that are to be one."""
    first, second, frames = _sides(build, e)
    # the second stands at the first times `turn`; points: of the second, the first
    if frames is None:
        given = build.model.eq_data[e]
        turn = quaternion.normalize(given[6:10])
        frames = [
            (_point(build, first, given[3:6]), quaternion.multiply(build.data.xquat[first], turn)),
            (_point(build, second, given[0:3]), build.data.xquat[second]),
        ]
    return first, second, frames[0], frames[1]


def _point(build: Build, body: int, point) -> np.ndarray:
    return build.data.xpos[body] + quaternion.rotate(build.data.xquat[body], point)


def _tie(build: Build, e: int, what: str, definition, first: int, second: int, one, two) -> None:
    """Add a joint between two bodies, with a frame in each."""
    parent, child = build.carrier(first), build.carrier(second)
    if parent is child:
        build.report.add(what, "joins two parts of the same body", "left out")
        return
    away = float(np.linalg.norm(two[0] - one[0])) / build.model.stat.extent
    turned = float(np.linalg.norm(quaternion.between(one[1], two[1])))
    if max(away, turned) > FITS:
        build.report.add(
            what,
            f"does not hold at the start: {away * build.model.stat.extent:.3g} m, {turned:.3g} rad",
            "use Options(project_start=True), which moves the parts together",
        )
    if isinstance(child, Ground):
        parent, child, one, two = child, build.moving(int(build.model.body_weldid[first])), two, one
    name = build.names.new(name_of(build.model, "equality", e), "equality")
    build.scene.add_joint(
        definition, parent, child,
        parent_frame=in_body(parent, *one), child_frame=in_body(child, *two), name=name,
    )  # fmt: skip


def _couple(build: Build, e: int, what: str) -> None:
    """Add q1 - q1_0 = a0 + a1 (q2 - q2_0); a polynomial of higher degree has no equivalent."""
    model = build.model
    first, second = int(model.eq_obj1id[e]), int(model.eq_obj2id[e])
    a = model.eq_data[e][:5]
    if second >= 0 and np.any(a[2:]):
        build.report.add(what, "is a polynomial of degree 2 or more", "left out")
        return
    if not {first, second} - {-1} <= build.coordinates.keys():
        build.report.add(what, "is for a joint that is not a hinge or slide", "left out")
        return
    sides = [
        ([(build.coordinates[j], 1.0)], factor)
        for j, factor in ((first, 1.0), (second, -a[1]))
        if j >= 0 and factor != 0.0
    ]
    _relate(build, e, what, sides, -a[0])


def _couple_tendons(build: Build, e: int, what: str) -> None:
    """Add the same of the lengths of two fixed tendons, or of one."""
    model = build.model
    first, second = int(model.eq_obj1id[e]), int(model.eq_obj2id[e])
    a = model.eq_data[e][:5]
    if second >= 0 and np.any(a[2:]):
        build.report.add(what, "is a polynomial of degree 2 or more", "left out")
        return
    sides = []
    for tendon, factor in ((first, 1.0), (second, -a[1])):
        if tendon >= 0 and factor != 0.0:
            terms = fixed_tendon(build, tendon)
            if terms is None:
                build.report.add(what, "is for a tendon along a path", "left out")
                return
            sides.append((terms, factor))
    _relate(build, e, what, sides, -a[0])


def _relate(build: Build, e: int, what: str, sides, missing: float) -> None:
    """Add a relation of sums of coordinates, each times a factor; by `missing` it does not hold in `qpos0`."""
    model, data, factors = build.model, build.data, {}
    for terms, factor in sides:
        for c, own in terms:
            missing += factor * own * (data.qpos[c.position] - model.qpos0[c.position])
            key = c.joint, c.index
            factors[key] = factors.get(key, 0.0) + factor * own * c.sign
    factors = {key: factor for key, factor in factors.items() if factor != 0.0}
    if abs(missing) > FITS:
        build.report.add(
            what, f"does not hold at the start, by {missing:.3g}", "keeps its value at the start"
        )
    name = build.names.new(name_of(model, "equality", e), "equality")
    build.scene.add_constraint(constraints.Coupling(factors), name=name)
