"""A run for ParaView (``.pvd``): a list of times, and for each of them VTK files of bodies and contacts."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree

import numpy as np

from carom import checks
from carom.geometry import quaternion
from carom.io.files.disk import staged
from carom.visual.viewer.show import Show
from carom.visual.viewer.strikes import world_impulses


def write_pvd(show: Show, path: Path, speed: float) -> None:
    """Write a show; times are those of the run, whatever the `speed`."""
    meshio = checks.need("meshio", "a file in .pvd", "export")
    with staged(path) as folder:
        _write_all(show, path, folder, meshio)


def _write_all(show: Show, path: Path, folder: Path, meshio) -> None:
    """Write the list of times and all its files into a folder."""
    file = ElementTree.Element("VTKFile", type="Collection", version="0.1")
    found = ElementTree.SubElement(file, "Collection")

    def note(t: float, part: int, name: str) -> None:
        ElementTree.SubElement(
            found, "DataSet", timestep=repr(float(t)), part=str(part), file=f"{path.stem}/{name}"
        )  # fmt: skip

    fixed = _fixed(show, meshio)
    if fixed is not None:
        fixed.write(folder / "fixed.vtu")
    moving, touching = Moving(show), Touching(show)
    for k, t in enumerate(show.frames.time):
        moving.mesh(k, meshio).write(folder / f"bodies{k:05d}.vtu")
        touching.mesh(k, meshio).write(folder / f"contacts{k:05d}.vtu")
        note(t, 0, f"bodies{k:05d}.vtu")
        note(t, 1, f"contacts{k:05d}.vtu")
        if fixed is not None:
            note(t, 2, "fixed.vtu")
    ElementTree.indent(file)
    ElementTree.ElementTree(file).write(folder / path.name, encoding="utf-8", xml_declaration=True)


def _fixed(show: Show, meshio):
    """Return the mesh of half-spaces and static bodies; None if there are none."""
    fans = [np.array([(0, k, k + 1) for k in range(1, len(p.corners) - 1)]) for p in show.planes]
    pieces = [(p.corners, fan) for p, fan in zip(show.planes, fans)]
    pieces += [(p.vertices, p.triangles) for p in show.parts if p.look == "static"]
    if not pieces:
        return None
    first = np.cumsum([0, *(len(points) for points, _ in pieces)])
    triangles = np.concatenate([faces + start for (_, faces), start in zip(pieces, first)])
    return meshio.Mesh(np.concatenate([points for points, _ in pieces]), [("triangle", triangles)])


class Moving:
    """The surfaces of all bodies, springs and rods, at each frame."""

    def __init__(self, show: Show):
        self.links = show.links
        self.time, self.x, self.Q = show.frames
        self.v, self.w = show.solution._curve(self.time)[2:]
        parts = [(part, b) for part in show.parts for b in part.bodies if b >= 0]
        self.points = np.concatenate([part.vertices for part, _ in parts])
        self.owner = np.repeat([b for _, b in parts], [len(part.vertices) for part, _ in parts])
        first = np.cumsum([0, *(len(part.vertices) for part, _ in parts)])
        triangles = np.concatenate([p.triangles + f for (p, _), f in zip(parts, first)])
        self.triangles = triangles.astype(np.int32)

    def mesh(self, k: int, meshio):
        """Return the mesh of frame k: velocities of points, and of each cell its body and its motion."""
        arms = quaternion.rotate(self.Q[k, self.owner], self.points)
        v, w = (column[k, self.owner] for column in (self.v, self.w))
        points, velocity = self.x[k, self.owner] + arms, v + np.cross(w, arms)
        bodies = [self.owner[self.triangles[:, 0]]]
        cells = [("triangle", self.triangles)]
        links = [link for link in self.links if link.is_there(self.time[k])]
        if links:
            ends = np.reshape([link.ends(self.x[k], self.Q[k]) for link in links], (-1, 3))
            sides = np.array([b for link in links for b in (link.parent, link.child)])
            rate = self.v[k, sides] + np.cross(self.w[k, sides], ends - self.x[k, sides])
            lines = (len(points) + np.arange(len(ends))).reshape(-1, 2).astype(np.int32)
            cells.append(("line", lines))
            bodies.append(np.array([link.child for link in links]))
            points = np.concatenate([points, ends])
            velocity = np.concatenate([velocity, np.where(sides[:, None] < 0, 0.0, rate)])
        motion = {
            "velocity_of_mass_centre": [self.v[k, b] for b in bodies],
            "angular_velocity": [self.w[k, b] for b in bodies],
        }
        # single precision halves the files, and is finer than any picture
        numbers = {
            name: [c.astype(np.float32) for c in columns] for name, columns in motion.items()
        }
        numbers["body"] = [b.astype(np.int32) for b in bodies]
        velocity = velocity.astype(np.float32)
        return meshio.Mesh(points.astype(np.float32), cells, {"velocity": velocity}, numbers)


class Touching:
    """Contact points at each frame: persistent ones with their forces, impacts with their impulses."""

    def __init__(self, show: Show):
        solution = show.solution
        self.time, self.forces, self.impacts = show.frames.time, solution.forces, solution.impacts
        self.impulses = world_impulses(solution)
        self.saved = np.searchsorted(solution.t, self.time, side="right") - 1

    def mesh(self, k: int, meshio):
        """Return the points of frame k; impacts are those since the frame before."""
        low, high = np.searchsorted(self.forces.saved, self.saved[k] + np.arange(2))
        since = self.time[k - 1] if k else -np.inf
        first, last = np.searchsorted(self.impacts.time, [since, self.time[k]], side="right")
        force, impulse = self.forces.vector[low:high], self.impulses[first:last]
        held, struck = np.zeros_like(force), np.zeros_like(impulse)
        points = np.concatenate([self.forces.point[low:high], self.impacts.point[first:last]])
        contact = np.concatenate([self.forces.contact[low:high], self.impacts.contact[first:last]])
        data = {
            "force": np.concatenate([force, struck]),
            "impulse": np.concatenate([held, impulse]),
            "contact": contact.astype(np.int64),
        }
        return meshio.Mesh(points, [("vertex", np.arange(len(points))[:, None])], data)
