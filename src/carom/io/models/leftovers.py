"""Parts of a model that a scene cannot have: an entry in the report for each of them."""

from __future__ import annotations

import numpy as np

from carom.io.models.links import called
from carom.io.models.report import Report, need_mujoco

#: parts listed by name: accessor of the model, count, description, replacement in the scene
LISTED = (("skin", "nskin", "is only visible", "left out"),)
#: arrays whose nonzero values are left out, if this version of MuJoCo has them
NOT_ZERO = (
    ("joint", "jnt_stiffnesspoly", "a spring that is not linear", "only its linear part is used"),
    ("dof", "dof_dampingpoly", "a damper that is not linear", "only its linear part is used"),
    ("joint", "jnt_springyield", "a spring that yields", "it does not yield"),
    ("geom", "geom_margin", "a margin of contact", "surfaces touch where they are"),
    ("geom", "geom_gap", "a gap of contact", "surfaces touch where they are"),
    ("geom", "geom_fluid", "forces of a fluid", "left out"),
    ("geom", "geom_adhesion", "adhesion", "left out"),
    ("geom", "geom_surfacevel", "a surface that moves", "it does not move"),
    ("pair", "pair_margin", "a margin of contact", "surfaces touch where they are"),
    ("pair", "pair_gap", "a gap of contact", "surfaces touch where they are"),
    ("joint", "jnt_margin", "a margin of its limits", "they act where they are"),
    ("pair", "pair_adhesion", "adhesion", "left out"),
)


def report_leftovers(model, driven, report: Report) -> None:
    """Add an entry for each part of a model that no part of the scene represents. Bodies `driven` move."""
    for kind, count, what, instead in LISTED:
        for k in range(getattr(model, count)):
            report.add(called(model, kind, k), what, instead)
    for kind, array, what, instead in NOT_ZERO:
        values = getattr(model, array, None)
        if values is None or not np.any(values):
            continue
        for k in np.flatnonzero(np.any(values.reshape(len(values), -1) != 0, axis=1)):
            of = ("joint", int(model.dof_jntid[k])) if kind == "dof" else (kind, int(k))
            report.add(called(model, *of), what, instead)
    for b in range(model.nbody):
        if model.body_mocapid[b] >= 0 and b not in driven:
            report.add(
                called(model, "body", b),
                "is moved from outside (mocap)",
                "it does not move; give its motion by mocap=",
            )
    for p in range(model.npair):
        five = model.pair_friction[p]
        if five[0] != five[1] or five[3] != five[4]:
            what = "friction that depends on direction"
            report.add(
                called(model, "pair", p),
                what,
                "the first value is used for all directions",
            )
    _report_whole(model, report)


def _report_whole(model, report: Report) -> None:
    """Add entries about the whole model."""
    opt = model.opt
    if int(opt.enableflags) & int(need_mujoco().mjtEnableBit.mjENBL_OVERRIDE):
        what = "gives all contacts the margin and the friction of <option>"
        report.add("flag override", what, "those of the geoms are used")
    if model.nflex:
        report.add("deformable bodies", "are not represented", f"{model.nflex} left out")
    if opt.density != 0.0 or opt.viscosity != 0.0 or np.any(opt.wind):
        report.add("fluid", "density, viscosity and wind are not represented", "there is no drag")
    if model.nplugin:
        report.add("plugins", "are not represented", f"{model.nplugin} left out")
    report.add(
        "solref, solimp",
        "contacts, limits and equality constraints of a scene are rigid",
        "impacts by restitution, persistent contact without penetration",
    )
