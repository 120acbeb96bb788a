"""Correction of a URDF, which MuJoCo would refuse: impossible inertias, and moving links without mass."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np

from carom.io.models.links import possible_inertia
from carom.io.models.report import Report

GIVEN = 1e-9  # mass of a link that moves and has none, as a part of the robot's
ARM2 = 1e-2  # inertia by mass of what has none [m^2]
FLOOR = 1e-12  # of moments [kg m^2]: MuJoCo takes none below 1e-15
SIX: tuple[str, ...] = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def mend_inertias(root: ET.Element, report: Report) -> None:
    """Change the elements ``<inertial>`` of a robot so that each inertia is possible for a rigid body."""
    links = {link.get("name"): link for link in root.iter("link")}
    for name, link in links.items():
        inertial = link.find("inertial")
        if inertial is None:
            continue
        if not _mass(link) > 0.0:
            link.remove(inertial)
            continue
        _mend(inertial.find("inertia"), f"link {name!r}", report)
    total = sum(map(_mass, links.values()))
    carries = {
        joint.find("parent").get("link")  # pyright: ignore[reportOptionalMemberAccess]
        for joint in root.iter("joint")
        if joint.get("type") == "fixed" and joint.find("parent") is not None
    }
    for joint in root.iter("joint"):
        child = joint.find("child")
        link = None if child is None else links.get(child.get("link"))
        if link is None or joint.get("type") == "fixed" or _mass(link) > 0.0:
            continue
        if link.get("name") in carries:  # what is fixed to it has the mass
            continue
        mass = GIVEN * total
        inertial = ET.SubElement(link, "inertial")
        ET.SubElement(inertial, "mass", value=repr(mass))
        moments = [*[repr(ARM2 * mass)] * 3, *["0"] * 3]
        ET.SubElement(inertial, "inertia", dict(zip(SIX, moments)))
        report.add(
            f"link {link.get('name')!r}", "moves and has no mass", f"it is given {mass:.1e} kg"
        )


def _mass(link: ET.Element) -> float:
    mass = link.find("inertial/mass")
    return 0.0 if mass is None else float(mass.get("value", "0"))


def _mend(inertia: ET.Element | None, called: str, report: Report) -> None:
    """Replace moments that are not above 0, or of which one exceeds the sum of the others."""
    if inertia is None:
        return
    xx, yy, zz, xy, xz, yz = (float(inertia.get(key, "0")) for key in SIX)
    given = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    better, change = possible_inertia(given, FLOOR, 1e-9)
    if change == 0.0:
        return
    values = (*np.diag(better), better[0, 1], better[0, 2], better[1, 2])
    inertia.attrib.update({key: repr(float(value)) for key, value in zip(SIX, values)})
    if change > 1e-9:
        what = "its inertia is impossible for a rigid body"
        report.add(called, what, "the nearest possible one, with small moments raised")
