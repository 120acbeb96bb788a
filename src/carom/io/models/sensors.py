"""Sensors of a model as readings of the scene."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom.geometry import quaternion
from carom.io.models.build import Build
from carom.io.models.links import Link, called, name_of, pose_on_link
from carom.io.models.report import need_mujoco
from carom.io.models.tendons import fixed_tendon
from carom.results.robot import Motor
from carom.results.sensors import READINGS, Frame, Sensor
from carom.scene.bodies import GROUND

#: names of MuJoCo's types that are not those of the elements
NAMES = {"jointactfrc": "jointactuatorfrc"}
SUBTREES = ("force", "torque", "subtreecom", "subtreelinvel", "subtreeangmom")
LEFT_OUT = "left out"


def sensors_of(build: Build, links: list[Link], motors: list[Motor]) -> list[Sensor]:
    """Return the sensors that read what a scene has; report the others."""
    out = []
    for s in range(build.model.nsensor):
        kind = need_mujoco().mjtSensor(int(build.model.sensor_type[s])).name[7:].lower()
        kind = str(NAMES.get(kind, kind))
        given = (
            _given(build, links, motors, s, kind)
            if kind in READINGS
            else "a scene has none of this kind"
        )
        if isinstance(given, str):
            build.report.add(called(build.model, "sensor", s), given, LEFT_OUT)
            continue
        cutoff, positive = (
            float(build.model.sensor_cutoff[s]),
            need_mujoco().mjtDataType.mjDATATYPE_POSITIVE,
        )
        given |= {"cutoff": cutoff, "positive": bool(build.model.sensor_datatype[s] == positive)}
        out.append(Sensor(name_of(build.model, "sensor", s), kind, **given))
    return out


def _given(
    build: Build, links: list[Link], motors: list[Motor], s: int, kind: str
) -> dict[str, Any] | str:
    """Return the fields of a sensor, or why there is none."""
    m, target = build.model, int(build.model.sensor_objid[s])
    if kind in ("clock", "e_kinetic"):
        return {}
    if kind.startswith("joint"):
        if target not in build.coordinates:
            return "its joint is no hinge or slide"
        c = build.coordinates[target]
        ends = m.jnt_actfrcrange[target] if m.jnt_actfrclimited[target] else ()
        pulls = tuple((one, factor) for one in motors for own, factor in one.terms if own is c)
        return {
            "terms": ((c, 1.0),),
            **({"motors": pulls, "values": ends} if kind == "jointactuatorfrc" else {}),
        }
    if kind.startswith("ball"):
        if target not in build.balls:
            return "its joint is no ball joint"
        place = m.jnt_dofadr if kind == "ballangvel" else m.jnt_qposadr
        return {"at": int(place[target])}
    if kind.startswith("tendon"):
        terms = fixed_tendon(build, target)
        return (
            "its tendon is not along coordinates of joints"
            if terms is None
            else {"terms": tuple(terms)}
        )
    if kind.startswith("actuator"):
        if kind != "actuatorfrc" and not motors[target].terms:
            return "its actuator is not represented"
        return {"terms": motors[target].terms, "motors": ((motors[target], 1.0),)}
    return _seen(build, links, s, kind, target)


def _seen(build: Build, links: list[Link], s: int, kind: str, target: int) -> dict[str, Any] | str:
    """Return the fields of a sensor of a frame."""
    m, site = build.model, need_mujoco().mjtObj.mjOBJ_SITE
    body, frame = _frame(build, links, int(m.sensor_objtype[s]), target)
    fields: dict[str, Any] = {"frame": frame}
    if m.sensor_refid[s] >= 0:
        fields["reference"] = _frame(
            build, links, int(m.sensor_reftype[s]), int(m.sensor_refid[s])
        )[1]
    if kind in SUBTREES:
        if body != int(m.body_weldid[body]):
            return "its body is a part of the body that carries it"
        if kind in ("force", "torque") and body == 0:
            return "its body is fixed to the world"
        fields["members"] = tuple(
            build.moving(link.body) for link in links if _carries(m, body, link.body)
        )
        if not fields["members"]:
            return "no body that moves is behind it"
    if kind == "touch" and m.sensor_objtype[s] == site:
        fields["values"] = np.append(m.site_size[target], float(m.site_type[target]))
    if kind == "magnetometer":
        fields["values"] = m.opt.magnetic
    return fields


def _carries(m, body: int, other: int) -> bool:
    """Return whether a body is another one, or carries it."""
    while other not in (0, body):
        other = int(m.body_parentid[other])
    return other == body


def _frame(build: Build, links: list[Link], kind: int, target: int) -> tuple[int, Frame]:
    """Return the body of an object of the model, and its frame in the scene."""
    m, data, kinds = build.model, build.data, need_mujoco().mjtObj
    position, turn = np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])
    if kind in (int(kinds.mjOBJ_BODY), int(kinds.mjOBJ_XBODY)):
        body = target
        if kind == int(kinds.mjOBJ_BODY):  # its inertial frame
            position, turn = m.body_ipos[body], m.body_iquat[body]
    else:
        word = {int(kinds.mjOBJ_GEOM): "geom", int(kinds.mjOBJ_SITE): "site"}.get(kind, "cam")
        body = int(getattr(m, f"{word}_bodyid")[target])
        position, turn = getattr(m, f"{word}_pos")[target], getattr(m, f"{word}_quat")[target]
    part = build.carrier(body)
    if part is GROUND:
        at, axes, centre = data.xpos[body], data.xquat[body], np.zeros(3)
    else:
        (at, axes), root = pose_on_link(m, body), int(m.body_weldid[body])
        centre = next(link.centre for link in links if link.body == root)
    place = at + quaternion.rotate(axes, position) - centre
    return body, Frame(part, place, quaternion.normalize(quaternion.multiply(axes, turn)))
