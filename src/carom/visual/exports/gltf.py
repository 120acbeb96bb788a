"""A run as glTF 2.0 (``.glb``): nodes, meshes and colours, and an animation that moves the nodes.

Source: Khronos Group, glTF 2.0 Specification (2021): y is up, rotations are (x, y, z, w), colours are linear.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

import carom
from carom import checks
from carom.io.files.disk import put
from carom.scene.shapes.revolved import Cylinder
from carom.visual.bodies import JOINT, Part, colours_of, ground_rails, turn_to
from carom.visual.films.models import model_of, rgb
from carom.visual.films.stage import PLANE
from carom.visual.surfaces import surface
from carom.visual.viewer.show import Show

THIN = 0.009  # radius of springs and rods, as a fraction of that of the region, as in films
ROUGH = 0.6  # roughness of all materials
NONE = np.array([1.0, 0.0, 0.0, 0.0])


def write_glb(show: Show, path: Path, speed: float) -> None:
    """Write a show, at `speed` seconds of the run per second of the animation."""
    file = File()
    time, x, Q = show.frames
    file.clock((time - time[0]) / speed)
    root = file.node(show.title, turn=to_y(show.place.up))
    looks: dict[int, list[tuple]] = {}
    scene = show.solution.scene
    still = [one.name for one in (*scene.statics, *ground_rails(scene))]  # parts are in this order
    names = iter([*still, *["look"] * len(scene.look)])
    for part in show.parts:
        pieces = file.pieces(part)
        for b, colour in zip(part.bodies, colours_of(part, scene)):
            drawn = tuple((*piece, file.material(rgb(colour), pale)) for piece, pale in pieces)
            if b < 0:
                name = next(names, "arrow")
                file.node(name, root, file.mesh(name, drawn))
            else:
                looks.setdefault(b, []).extend(drawn)
    for body in scene.bodies:
        b = body.index
        mesh = file.mesh(body.name, tuple(looks[b])) if b in looks else None
        node = file.node(body.name, root, mesh, x[0, b], Q[0, b])
        file.move(node, x[:, b], Q[:, b])
    for plane in show.planes:
        fan = np.array([(0, k, k + 1) for k in range(1, len(plane.corners) - 1)])
        normals = np.broadcast_to(plane.normal, plane.corners.shape)
        piece = (*file.surface(plane.corners, normals), file.indices(fan))
        shade = file.material(rgb(plane.colour) if plane.colour else PLANE)
        mesh = file.mesh(plane.name, ((*piece, shade),))
        file.node(plane.name, root, mesh)
    rod = Part(*surface(Cylinder(1.0, 1.0), 12), [], "joint")
    for k, link in enumerate(show.links):
        made = tuple((*p, file.material(rgb(JOINT))) for p, _ in file.pieces(rod))
        mesh = file.mesh("rod", made)
        places = (x.swapaxes(0, 1), Q.swapaxes(0, 1))
        a, b = (np.broadcast_to(end, (len(time), 3)) for end in link.ends(*places))
        lengths = np.linalg.norm(b - a, axis=1)
        along = np.where(lengths[:, None] > 0.0, b - a, (0.0, 0.0, 1.0))
        turns = np.array([turn_to(one / np.linalg.norm(one)) for one in along])
        seen = np.array([link.is_there(t) for t in time.tolist()])
        thin, lengths = np.where(seen, THIN * show.place.radius, 0.0), np.where(seen, lengths, 0.0)
        sizes, middle = np.stack([thin, thin, lengths], axis=1), 0.5 * (a + b)
        node = file.node(f"{link.kind}{k + 1}", root, mesh, middle[0], turns[0], sizes[0])
        file.move(node, middle, turns, sizes)
    file.write(path)


def to_y(up: np.ndarray) -> np.ndarray:
    """Return the shortest rotation (4,) that takes the unit vector `up` to y."""
    if up[1] < -1.0 + 1e-9:
        return np.array([0.0, 1.0, 0.0, 0.0])
    half = np.array([1.0 + up[1], -up[2], 0.0, up[0]])
    return half / np.linalg.norm(half)


class File:
    """A glTF file that is being made: each method adds a thing and returns its number."""

    def __init__(self):
        self.gltf = checks.need("pygltflib", "a file in .glb", "export")
        self.made = self.gltf.GLTF2(
            asset=self.gltf.Asset(generator=f"carom {carom.__version__}"),
            scene=0, scenes=[self.gltf.Scene(nodes=[0])],
        )  # fmt: skip
        self.block, self.known, self.channels = bytearray(), {}, []

    def once(self, key, make) -> Any:
        """Return the object of a key, made at its first use."""
        if key not in self.known:
            self.known[key] = make()
        return self.known[key]

    def accessor(self, array: np.ndarray, kind: str, bounds=False) -> int:
        """Add numbers, 4 bytes each, of a `kind` ("SCALAR", "VEC3" or "VEC4")."""
        g, made = self.gltf, self.made
        whole = np.issubdtype(array.dtype, np.integer)
        array = np.ascontiguousarray(array, dtype="<u4" if whole else "<f4")
        view = g.BufferView(buffer=0, byteOffset=len(self.block), byteLength=array.nbytes)
        self.block += array.tobytes()
        made.bufferViews.append(view)
        rows = array.reshape(len(array), -1)
        made.accessors.append(
            g.Accessor(
                bufferView=len(made.bufferViews) - 1, count=len(array), type=kind,
                componentType=g.UNSIGNED_INT if whole else g.FLOAT,
                min=rows.min(axis=0).tolist() if bounds else None,
                max=rows.max(axis=0).tolist() if bounds else None,
            )
        )  # fmt: skip
        return len(made.accessors) - 1

    def surface(self, points: np.ndarray, normals: np.ndarray) -> tuple[int, int]:
        """Add vertices and their normals."""
        return self.accessor(points, "VEC3", bounds=True), self.accessor(normals, "VEC3")

    def indices(self, triangles: np.ndarray) -> int:
        """Add triangles."""
        return self.accessor(triangles.ravel(), "SCALAR")

    def pieces(self, part: Part) -> list[tuple[tuple[int, int, int], float]]:
        """Add a part: vertices, normals and triangles of each shade, and how pale it is."""

        def make():
            model = model_of(part)
            rows = np.concatenate([model.corners, model.normals], axis=2).reshape(-1, 6)
            rows, number = np.unique(rows.round(12), axis=0, return_inverse=True)
            lines, triangles = self.surface(rows[:, :3], rows[:, 3:]), number.reshape(-1, 3)
            pale = model.colours[:, 0]
            shades = [(triangles[pale == one], float(one)) for one in np.unique(pale)]
            return [((*lines, self.indices(shade)), one) for shade, one in shades]

        return self.once((part.vertices.tobytes(), part.triangles.tobytes(), part.look), make)

    def material(self, colour: np.ndarray, pale: float = 0.0) -> int:
        """Add a colour, of parts from 0 to 1 as in ``#rrggbb``, mixed with white by the fraction `pale`."""
        colour = colour + pale * (1.0 - colour)
        # IEC 61966-2-1 (sRGB), by which screens show a colour
        light = np.where(colour > 0.04045, ((colour + 0.055) / 1.055) ** 2.4, colour / 12.92)

        def make():
            surface = self.gltf.PbrMetallicRoughness(
                baseColorFactor=[*light.tolist(), 1.0], metallicFactor=0.0, roughnessFactor=ROUGH
            )
            name = "#" + bytes((255.0 * colour).round().astype(int).tolist()).hex()
            self.made.materials.append(self.gltf.Material(name=name, pbrMetallicRoughness=surface))
            return len(self.made.materials) - 1

        return self.once(("material", colour.tobytes()), make)

    def mesh(self, name: str, pieces: tuple) -> int:
        """Add a mesh of pieces: (vertices, normals, triangles, material); equal ones once."""

        def make():
            primitives = [
                self.gltf.Primitive(
                    attributes=self.gltf.Attributes(POSITION=p, NORMAL=n), indices=i, material=m
                )
                for p, n, i, m in pieces
            ]
            self.made.meshes.append(self.gltf.Mesh(name=name, primitives=primitives))
            return len(self.made.meshes) - 1

        return self.once(("mesh", pieces), make)

    def node(self, name, parent=None, mesh=None, place=None, turn=NONE, size=None) -> int:
        """Add a node below another one."""
        nodes = self.made.nodes
        place, size = (None if one is None else one.tolist() for one in (place, size))
        rotation = turn[[1, 2, 3, 0]].tolist()
        nodes.append(
            self.gltf.Node(name=name, mesh=mesh, translation=place, rotation=rotation, scale=size)
        )
        if parent is not None:
            nodes[parent].children.append(len(nodes) - 1)
        return len(nodes) - 1

    def clock(self, times: np.ndarray) -> None:
        """Set the times of all frames [s]."""
        self.times = self.accessor(times, "SCALAR", bounds=True)

    def move(self, node: int, places, turns, sizes=None) -> None:
        """Let a node move from frame to frame, unless it stays where it is."""
        # q and -q are one rotation: of the two that which is near the one before, for viewers that mix numbers
        signs = np.cumprod(np.sign(np.sum(turns[1:] * turns[:-1], axis=1)) + 0.0)
        turns = turns * np.concatenate([[1.0], np.where(signs == 0.0, 1.0, signs)])[:, None]
        tracks = ("translation", places), ("rotation", turns[:, [1, 2, 3, 0]]), ("scale", sizes)
        for path, track in tracks:
            if track is not None and np.any(track != track[0]):
                values = self.accessor(track, "VEC4" if path == "rotation" else "VEC3")
                self.channels.append((node, path, values))

    def write(self, path: Path) -> None:
        """Write the file."""
        g, made = self.gltf, self.made
        if self.channels:
            samplers = [
                g.AnimationSampler(input=self.times, output=values, interpolation="LINEAR")
                for _, _, values in self.channels
            ]
            targets = [g.AnimationChannelTarget(node=n, path=p) for n, p, _ in self.channels]
            channels = [g.AnimationChannel(sampler=k, target=t) for k, t in enumerate(targets)]
            made.animations = [g.Animation(name="motion", samplers=samplers, channels=channels)]
        made.buffers = [g.Buffer(byteLength=len(self.block))]
        made.set_binary_blob(bytes(self.block))
        put(path, made.save_to_bytes())
