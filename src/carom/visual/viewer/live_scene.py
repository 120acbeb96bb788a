"""The motion in viser: bodies, planes, arrows and marks, moved to a time."""

from __future__ import annotations

import numpy as np

from carom.scene.shapes import Sphere
from carom.visual.bodies import JOINT, colours_of
from carom.visual.surfaces import surface
from carom.visual.viewer.frames import poses_at
from carom.visual.viewer.planes import grid_lines, round_length
from carom.visual.viewer.show import FORCE, IMPULSE, Show

PATHS = 20  # bodies whose paths are drawn
SHADE = (236, 240, 243)
FAINT = (184, 194, 202)


class LiveScene:
    """The parts of a run in the scene of a viser server."""

    def __init__(self, server, show: Show):
        self.show = show
        self.radius, centre = show.place.radius, show.place.centre
        self.length = 1.0  #: factor of all arrows
        self.arrows_on = True
        self.strongest = np.max(np.linalg.norm(show.strikes.arrow, axis=1), initial=0.0)
        forces = np.linalg.norm(show.persistent.force, axis=1)
        self.largest_force = float(np.quantile(forces, 0.99)) if len(forces) else 0.0
        self.stage = stage = server.scene
        stage.configure_default_lights(enabled=False)
        up, side = show.place.up, show.place.side
        sun = 5.0 * self.radius * (up + 0.5 * side + 0.4 * np.cross(up, side))
        stage.add_light_directional(
            "/sun", intensity=2.2, cast_shadow=True, position=tuple(centre + sun)
        )
        stage.add_light_ambient("/sky", intensity=1.1)
        stage.set_up_direction(tuple(show.place.up))
        lift = show.place.lift
        eye = np.cos(lift) * show.place.side + np.sin(lift) * show.place.up
        server.initial_camera.position = centre + 3.4 * self.radius * eye
        server.initial_camera.look_at = centre
        server.initial_camera.fov = 0.62
        server.initial_camera.near = 1e-3 * self.radius
        server.initial_camera.far = 40.0 * self.radius
        x, Q = poses_at(show.frames, show.frames.time[0])
        self.bodies = [self._part(k, part, x, Q) for k, part in enumerate(show.parts)]
        for plane in show.planes:
            self._plane(plane)
        self.paths = self._paths()
        self.links = None
        if show.links:
            self.links = stage.add_line_segments(
                "/links",
                _ends(show, show.frames.time[0]),
                (91, 104, 115),
                thickness=0.012 * self.radius,
            )
        points = show.solution.impacts.point[show.strikes.number]
        self.marks = stage.add_icosphere("/none", 1e-9) if not len(points) else self._marks(points)
        self.impulses = self._arrows("/impulses", IMPULSE)
        self.forces = self._arrows("/forces", FORCE)

    def move(self, t: float, fading: float) -> None:
        """Show everything at time `t`; impulses are visible for `fading` [s]."""
        x, Q = poses_at(self.show.frames, t)
        for part, handle in zip(self.show.parts, self.bodies):
            if part.look == "static":
                continue
            handle.batched_positions = x[part.bodies].astype(np.float32)
            handle.batched_wxyzs = Q[part.bodies].astype(np.float32)
        if self.links is not None:
            self.links.points = _ends(self.show, t)
        number, time = self.show.strikes.number, self.show.solution.impacts.time
        age = t - time[number]
        seen = (age >= 0.0) & (age < fading)
        longest = self.show.longest * self.length
        point = self.show.solution.impacts.point[number[seen]]
        self._point(self.impulses, point, self.show.strikes.arrow[seen], longest, self.strongest)
        persistent = self.show.persistent
        s = max(int(np.searchsorted(persistent.time, t, side="right")) - 1, 0)
        rows = slice(persistent.first[s], persistent.first[s + 1])
        point, force = persistent.point[rows], persistent.force[rows]
        self._point(self.forces, point, force, 0.7 * longest, self.largest_force)

    def see_through(self, on: bool) -> None:
        """Make bodies transparent, so that arrows in them are seen."""
        for handle in self.bodies:
            handle.opacity = 0.45 if on else None

    def nearest_impact(self, origin, direction) -> int:
        """Return which shown impact is nearest to a ray."""
        points = self.show.solution.impacts.point[self.show.strikes.number] - np.asarray(origin)
        along = np.asarray(direction) / np.linalg.norm(direction)
        away = np.linalg.norm(points - np.outer(points @ along, along), axis=1)
        return int(np.argmin(away))

    def _part(self, k: int, part, x: np.ndarray, Q: np.ndarray):
        if part.look == "static":
            x, Q = np.zeros((1, 3)), np.array([[1.0, 0, 0, 0]])
        colours = [_rgb(one) for one in colours_of(part, self.show.solution.scene)]
        return self.stage.add_batched_meshes_simple(
            f"/bodies/{k}", part.vertices.astype(np.float32), part.triangles.astype(np.uint32),
            Q[part.bodies], x[part.bodies], batched_colors=np.array(colours, dtype=np.uint8),
            flat_shading=part.look in ("solid", "static"), lod="off",
        )  # fmt: skip

    def _paths(self) -> list:
        """Draw the paths of the mass centres, unless there are too many."""
        position = self.show.frames.position
        if position.shape[1] > PATHS:
            return []
        paths = [
            np.stack([position[:-1, b], position[1:, b]], axis=1) for b in range(position.shape[1])
        ]
        return [
            self.stage.add_line_segments(
                f"/paths/{b}", path.astype(np.float32), FAINT, thickness=2e-3 * self.radius
            )
            for b, path in enumerate(paths)
        ]

    def show_paths(self, on: bool) -> None:
        """Show or hide the paths."""
        for path in self.paths:
            path.visible = on

    def _plane(self, plane) -> None:
        fan = np.array([(0, k, k + 1) for k in range(1, len(plane.corners) - 1)])
        name = f"/planes/{plane.name}"
        shade = tuple(bytes.fromhex(plane.colour[1:])) if plane.colour else SHADE
        self.stage.add_mesh_simple(
            name, plane.corners.astype(np.float32), fan, color=shade, side="front",
            cast_shadow=False,
        )  # fmt: skip
        if plane.normal @ self.show.place.up < 0.5:
            return  # a wall: its lines would be seen from behind too
        cell = round_length(self.radius / 9.0)
        lines = grid_lines(plane, cell) + 1e-3 * self.radius * plane.normal
        self.stage.add_line_segments(
            f"{name}/grid", lines.astype(np.float32), FAINT, thickness=2e-3 * self.radius
        )

    def _marks(self, points: np.ndarray):
        vertices, triangles = surface(Sphere(0.009 * self.radius), 4)  # an octahedron
        return self.stage.add_batched_meshes_simple(
            "/marks", vertices.astype(np.float32), triangles.astype(np.uint32),
            np.tile([1.0, 0, 0, 0], (len(points), 1)), points,
            batched_colors=_rgb(JOINT), lod="off", cast_shadow=False,
        )  # fmt: skip

    def _arrows(self, name: str, colour: str):
        return self.stage.add_arrows(
            name, np.zeros((1, 2, 3)), _rgb(colour), shaft_radius=0.02 * self.show.longest,
            head_radius=0.045 * self.show.longest, head_length=0.1 * self.show.longest, visible=False,
        )  # fmt: skip

    def _point(self, handle, start, vectors, longest: float, greatest: float) -> None:
        """Show arrows from `start` (A, 3) with lengths in proportion, the greatest as long as `longest`."""
        sizes = np.linalg.norm(vectors, axis=1)
        seen = sizes > 1e-3 * greatest
        handle.visible = bool(self.arrows_on and np.any(seen))
        if not handle.visible:
            return
        scale = longest / np.maximum(sizes[seen], greatest)  # a few beyond the greatest are cut
        ends = start[seen] + scale[:, None] * vectors[seen]
        handle.points = np.stack([start[seen], ends], axis=1).astype(np.float32)


def _rgb(colour: str) -> tuple[int, int, int]:
    """Return red, green and blue of ``"#rrggbb"``, linear in light: so viser takes them for batches."""
    red, green, blue = (round(255 * (part / 255) ** 2.2) for part in bytes.fromhex(colour[1:]))
    return red, green, blue


def _ends(show: Show, t: float) -> np.ndarray:
    """Return both ends (L, 2, 3) of springs and rods; they are one point of what is not there at a time."""
    x, Q = poses_at(show.frames, t)
    ends = np.array([link.ends(x, Q) for link in show.links], dtype=np.float32)
    gone = [not link.is_there(t) for link in show.links]
    ends[gone, 1] = ends[gone, 0]
    return ends
