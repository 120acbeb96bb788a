"""What a model has and a scene does not: all of it is reported."""

from __future__ import annotations

import numpy as np

from carom.io.models.links import name_of
from carom.io.models.needs import need_mujoco
from carom.io.models.report import Report

#: what is listed by name: accessor of the model, count, what it is, what happens
LISTED = (
    ("actuator", "nu", "actuators are not represented", "exerts no force"),
    ("tendon", "ntendon", "tendons are not represented", "left out"),
    ("skin", "nskin", "is only seen", "left out"),
    ("sensor", "nsensor", "sensors are not represented", "look at the solution"),
)
#: arrays in which other values than 0 mean something that is left out, where this version of MuJoCo has them
NOT_ZERO = (
    ("joint", "jnt_stiffnesspoly", "a spring that is not linear", "its linear part is there"),
    ("dof", "dof_dampingpoly", "a damper that is not linear", "its linear part is there"),
    ("joint", "jnt_springyield", "a spring that yields", "it does not yield"),
    ("geom", "geom_margin", "a margin of contact", "surfaces touch where they are"),
    ("geom", "geom_gap", "a gap of contact", "surfaces touch where they are"),
    ("geom", "geom_fluid", "forces of a fluid", "left out"),
    ("geom", "geom_adhesion", "adhesion", "left out"),
    ("geom", "geom_surfacevel", "a surface that moves", "it stands still"),
    ("pair", "pair_margin", "a margin of contact", "surfaces touch where they are"),
    ("pair", "pair_adhesion", "adhesion", "left out"),
)


#: flags by which a model switches off what the scene has all the same (contact and gravity are off there too)
SWITCHES = {
    "mjDSBL_EQUALITY": "equality constraints",
    "mjDSBL_LIMIT": "limits of joints",
    "mjDSBL_FRICTIONLOSS": "dry friction in joints",
    "mjDSBL_PASSIVE": "springs and dampers",
    "mjDSBL_SPRING": "springs",
    "mjDSBL_DAMPER": "dampers",
}


def report_leftovers(model, report: Report) -> None:
    """Add an entry for each part of a model that no part of a scene stands for."""
    for kind, count, what, instead in LISTED:
        for k in range(getattr(model, count)):
            report.add(f"{kind} {name_of(getattr(model, kind)(k), kind)!r}", what, instead)
    for kind, array, what, instead in NOT_ZERO:
        values = getattr(model, array, None)
        if values is None or not np.any(values):
            continue
        for k in np.flatnonzero(np.any(values.reshape(len(values), -1) != 0, axis=1)):
            report.add(_called(model, kind, int(k)), what, instead)
    for b in range(model.nbody):
        if model.body_mocapid[b] >= 0:
            report.add(
                f"body {name_of(model.body(b), 'body')!r}",
                "is moved by others (mocap)",
                "it stands still",
            )
    for p in range(model.npair):
        five = model.pair_friction[p]
        if five[0] != five[1] or five[3] != five[4]:
            what = "friction that depends on direction"
            report.add(
                f"pair {name_of(model.pair(p), 'pair')!r}", what, "the first number is that of all"
            )
    _report_whole(model, report)


def _called(model, kind: str, k: int) -> str:
    if kind == "dof":
        kind, k = "joint", int(model.dof_jntid[k])
    return f"{kind} {name_of(getattr(model, kind)(k), kind)!r}"


def _report_whole(model, report: Report) -> None:
    """Add what concerns the whole model."""
    opt, bits = model.opt, need_mujoco().mjtDisableBit
    for flag, what in SWITCHES.items():
        bit = getattr(bits, flag, None)  # not all versions have all
        if bit is not None and int(opt.disableflags) & int(bit):
            report.add(f"flag {flag}", f"switches off {what}", "they are there")
    if model.nflex:
        report.add("deformable bodies", "are not represented", f"{model.nflex} left out")
    if opt.density != 0.0 or opt.viscosity != 0.0 or np.any(opt.wind):
        report.add("fluid", "density, viscosity and wind are not represented", "there is no drag")
    if model.nplugin:
        report.add("plugins", "are not represented", f"{model.nplugin} left out")
    report.add(
        "solref, solimp",
        "contacts, limits and equality constraints of a scene are rigid",
        "impacts by restitution, contact that stays without penetration",
    )
