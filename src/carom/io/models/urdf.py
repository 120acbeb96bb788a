"""Preparation of a URDF for MuJoCo: paths of its meshes, links without joints, and impossible inertias.

MuJoCo does not know ``package://``, and reads only STL, OBJ and MSH. What is in ``<visual>`` is seen, and
touches nothing: its geoms are named, so that they are told from others.
Links without joints are kept, so that their names exist (`carom.io.models.links` joins them to their parents).
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path

import numpy as np

from carom.io.models.links import possible_inertia
from carom.io.models.report import Report

GIVEN = 1e-9  # mass of a link that moves and has none, as a part of the robot's
ARM2 = 1e-2  # inertia by mass of what has none [m^2]
FLOOR = 1e-12  # of moments [kg m^2]: MuJoCo takes none below 1e-15
SIX: tuple[str, ...] = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
HIDDEN = 3  # group of geoms
VISUAL = ":visual"  # in the names of geoms
GREY = [0.5, 0.5, 0.5, 1.0]  # MuJoCo's colour of what has none
READ = (".stl", ".obj", ".msh")


def name_visuals(spec, root: ET.Element, mujoco) -> None:
    """Give the geoms of ``<visual>`` names and colours of their own, and let their meshes be open.

    What touches is not seen beside them: it is put into a group that MuJoCo's viewer hides.
    """
    left = {
        link.get("name"): [_tint(v.find("material"), root) for v in link.findall("visual")]
        for link in root.iter("link")
    }
    solid, seen = set(), {name for name, visuals in left.items() if visuals}
    for geom in spec.geoms:
        tints = left.get(geom.parent.name)
        if tints and geom.contype == 0 and geom.conaffinity == 0:
            geom.name = f"{geom.parent.name}{VISUAL}{len(tints)}"
            geom.rgba = tints.pop(0) or GREY
        else:
            solid.add(geom.meshname)
            geom.group = HIDDEN if geom.parent.name in seen else geom.group
    for mesh in spec.meshes:
        if mesh.name not in solid:
            mesh.inertia = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL


def drop_visuals(spec, error: str, report: Report) -> bool:
    """Leave out the visuals that an error is about, or all; return whether there were any."""
    visuals = [geom for geom in spec.geoms if VISUAL in geom.name]
    named = [g for g in visuals if g.meshname and f"'{g.meshname}'" in error]
    for geom in named or visuals:
        mesh = geom.meshname
        report.add(f"link {geom.parent.name!r}", f"a <visual> is not read ({error})", "left out")
        spec.delete(geom)
        if mesh and all(one.meshname != mesh for one in spec.geoms):
            spec.delete(spec.mesh(mesh))
    return bool(visuals)


def _tint(material: ET.Element | None, root: ET.Element) -> list[float] | None:
    """Return red, green, blue and opacity of a material, its own or those that the robot states by its name."""
    if material is None:
        return None
    shared = {one.get("name"): one.find("color") for one in root.findall("material")}
    own = material.find("color")
    own = shared.get(material.get("name")) if own is None else own
    with suppress(ValueError):
        rgba = [float(word) for word in ("" if own is None else own.get("rgba", "")).split()]
        return rgba if len(rgba) == 4 else None
    return None


def colours(root: ET.Element) -> dict[str, list[float]]:
    """Return red, green, blue and opacity of links with a ``<visual>`` that has a colour, by name."""
    found: dict[str, list[float]] = {}
    for link in root.iter("link"):
        for material in link.findall("visual/material"):
            rgba = _tint(material, root)
            if rgba is not None:
                found.setdefault(link.get("name", ""), rgba)
    return found


def prepared(root: ET.Element, folder: Path | None, package_dirs: Iterable, report: Report) -> str:
    """Return the text of a URDF that MuJoCo can read.

    Parameters
    ----------
    root
        The element ``<robot>``; it is changed.
    folder
        Where the file lies; None for a text.
    package_dirs
        Folders that contain packages, or are packages.
    report
        The report, for parts that are left out or changed.
    """
    mend_words(root, report)
    for link in root.iter("link"):
        for collision in (*link.findall("collision"), *link.findall("visual")):
            kind = "mesh" if collision.tag == "collision" else "visual mesh"
            mesh, shape = collision.find("geometry/mesh"), collision.find("geometry/*")
            if mesh is None:
                if shape is None or _is_flat(shape):
                    what = "is empty" if shape is None else "has a size of 0, and touches nothing"
                    if kind == "mesh":
                        report.add(
                            f"link {link.get('name')!r}", f"a shape of it {what}", "left out"
                        )
                    link.remove(collision)
                continue
            name = mesh.get("filename", "")
            found = located(name, folder, package_dirs)
            why = "was not found" if found is None else unreadable(found)
            if found is not None and why is None:
                mesh.set("filename", str(found))
                continue
            report.add(f"link {link.get('name')!r}", f"its {kind} {name!r} {why}", "left out")
            link.remove(collision)
    mend_inertias(root, report)
    options = root.find("mujoco")
    if options is None:
        options = ET.SubElement(root, "mujoco")
    compiler = options.find("compiler")
    if compiler is None:
        compiler = ET.SubElement(options, "compiler")
    compiler.attrib.update(strippath="false", fusestatic="false", discardvisual="false")
    compiler.attrib.pop("meshdir", None)  # meshes have their full paths now
    return ET.tostring(root, encoding="unicode")


def mend_words(root: ET.Element, report: Report) -> None:
    """Leave out what other programs do not look at: numbers beyond three, commas, further axes of a joint."""
    for parent in (*root.iter("link"), *root.iter("joint")):
        called = f"{parent.tag} {parent.get('name')!r}"
        for axis in parent.findall("axis")[1:]:
            report.add(called, "it has more than one axis", "the first one is used")
            parent.remove(axis)
        for element in parent.iter():
            for name in ("xyz", "rpy", "scale"):
                given = element.get(name, "")
                words = given.replace(",", " ").split()
                if len(words) > 3 and "$" not in given:
                    report.add(
                        called, f"{name}={given!r} has more than three numbers", "three are used"
                    )
                if "$" not in given and words:
                    element.set(name, " ".join(words[:3]))


def _is_flat(shape: ET.Element) -> bool:
    """Return whether a size of a shape is 0: other programs read such points, lines and faces."""
    words = [shape.get(size, "") for size in ("radius", "length", "size")]
    with suppress(ValueError):
        sizes = [float(word) for word in " ".join(words).split()]
        return min(sizes, default=1.0) == 0.0
    return False  # MuJoCo says what is wrong


def unreadable(path: Path) -> str | None:
    """Return why MuJoCo cannot read a mesh; None if it can."""
    if path.suffix.lower() not in READ:
        return f"is not one of {', '.join(READ)}"
    if path.suffix.lower() == ".stl":
        size = path.stat().st_size
        with path.open("rb") as file:
            head = file.read(84)
        if len(head) < 84 or size < 84 + 50 * int.from_bytes(head[80:84], "little"):
            return "is not a binary STL"
    return None


def located(name: str, folder: Path | None, package_dirs: Iterable) -> Path | None:
    """Return the file of a mesh, or None.

    ``package://robot/mesh.stl`` is looked for as ``robot/mesh.stl``, and as ``mesh.stl`` in a folder called
    ``robot``, in `package_dirs`, in the folder of the URDF and in all above it.
    """
    above = [] if folder is None else [folder, *folder.parents]
    given = [Path(one).resolve() for one in package_dirs]
    if name.startswith("file://"):
        tries = [Path(name.removeprefix("file://"))]
    elif "://" in name:
        rest = Path(name.split("://", 1)[1])
        inside = Path(*rest.parts[1:])
        tries = [place / rest for place in (*given, *above)]
        tries += [place / inside for place in (*given, *above) if place.name == rest.parts[0]]
    else:
        tries = [place / name for place in (*above[:1], *given)]
    return next((path for path in tries if path.is_file()), None)


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
