"""A motion, prepared so that each of its times can be drawn."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from carom import arguments, checks
from carom.geometry import quaternion
from carom.scene.shapes.revolved import Cylinder
from carom.visual.bodies import (
    Part,
    ground_points,
    links_in,
    moving,
    outline_of,
    static_part,
    turn_to,
)
from carom.visual.films import marks
from carom.visual.films.camera import Camera, axes_of, fitted, vertical
from carom.visual.films.models import Model, joined, model_of, models, rgb
from carom.visual.plots.figure import bodies as named_bodies
from carom.visual.plots.figure import need_bodies
from carom.visual.surfaces import surface
from carom.visual.viewer.planes import round_length

BACKGROUND = rgb("#ffffff")
PLANE, GRID, LINK = rgb("#ededed"), rgb("#cfcfcf"), rgb("#6b6b6b")
SHADOW = 0.80  # brightness in it
DIM = 0.85  # brightness of a plane that turns away from the light
FINER = 2  # pixels of the buffer per pixel of the picture, in each direction
LINE = 0.0022  # width of an edge, as a fraction of the height of the picture
RECENT = 0.01  # fraction of the run for which a single picture shows an impulse
AROUND = 8.0  # distance within which bodies at rest are seen with what is there, in their extents
FAR = 60.0  # the same of floors and walls, whose nearest points are seen
SAMPLES = 400  # times at which the positions of bodies are used to place the camera


class Stage:
    """The parts of a film that are the same in all pictures."""

    def __init__(
        self, solution, size=(1280, 720), view="oblique", follow=None, span=None, zoom=1.0
    ):
        self.solution, scene = solution, solution.scene
        self.size = checked_size(size)
        self.zoom = checks.number("zoom", zoom, least=1e-3, most=1e3)
        self.followed = None if follow is None else named_bodies(solution, follow, "follow")
        if self.followed is not None and len(self.followed) != 1:
            raise ValueError(f"follow must be one body or None, got {checks.shown(follow)}")
        begin, end = span or (float(solution.t[0]), float(solution.t[-1]))
        times = np.linspace(begin, end, SAMPLES)
        places, turns = solution._curve(times)[:2]
        self.outlines = [outline_of(scene, body) for body in scene.bodies]
        self.radii = np.array([outline.radius for outline in self.outlines])
        self.axes = axes_of(view, scene)
        self.camera = self._camera(places, turns)
        self.length = self.camera.distance * 0.46  # approximate height of the view
        self._place_models()
        self._place_planes(places)
        self.marks = marks.Marks(solution, self.length)
        self._kept = None

    def _camera(self, places, turns) -> Camera:
        """Return the camera that sees all moving bodies and all small ones, or the body that it follows."""
        width, height = (FINER * n for n in self.size)
        if self.followed is None:
            seen = moving(places, turns)
            ends = ground_points(self.solution.scene)
            if np.any(seen):
                seen |= self.radii <= np.max(
                    np.ptp(places[:, seen], axis=(0, 1)) + self.radii[seen].max()
                )
            else:
                seen[:] = True
                ends += self._around(places[0])
            points = [(b, p) for b in np.flatnonzero(seen) for p in self.outlines[b].points]
            reached = [places[:, b] + quaternion.rotate(turns[:, b], p) for b, p in points]
            sizes = np.repeat([self.outlines[b].size for b, _ in points], len(places))
            flat = np.vstack([*reached, *ends])
            radii = np.append(sizes, np.zeros(len(flat) - len(sizes)))
        else:
            k = self.followed[0].index
            flat, radii = places[:1, k], 4.0 * self.radii[k : k + 1]
        camera = fitted(self.axes, flat, radii, (width, height))
        return camera._replace(distance=camera.distance / self.zoom)

    def _around(self, places: np.ndarray) -> list[np.ndarray]:
        """Return points of what bodies at rest at `places` (N, 3) stand near: static bodies, half-spaces.

        They are the points of floors and walls that are nearest to bodies, as far as bodies stay large enough
        to be seen, and the corners of static bodies that are nearer.
        """
        scene, middle = self.solution.scene, places.mean(axis=0)
        size = float(np.max(np.linalg.norm(places - middle, axis=1) + self.radii))
        fixed = [static_part(s, 32, middle, AROUND * size).vertices for s in scene.statics]
        beside = [np.clip(places, p.min(axis=0), p.max(axis=0)) for p in fixed if len(p)]
        beside += [
            places + np.outer((h.point - places) @ h.normal, h.normal) for h in scene.half_spaces
        ]
        near = [(points, AROUND) for points in fixed] + [(points, FAR) for points in beside]
        away = [np.linalg.norm(points - middle, axis=1) for points, _ in near]
        return [points[one < size * most] for (points, most), one in zip(near, away)]

    def _place_models(self) -> None:
        scene = self.solution.scene
        self.all, self.owner = models(scene, self.length, self.camera.centre)
        self.links = links_in(self.solution)
        rod = model_of(Part(*surface(Cylinder(1.0, 1.0), 12), [], "joint"))
        self.rod = rod._replace(colours=rod.colours + LINK)

    def _place_planes(self, places) -> None:
        up, _, _ = vertical(self.solution.scene)
        self.up = up
        light = 1.2 * self.axes.towards + 0.6 * self.axes.up - 0.5 * self.axes.right
        light = light / np.linalg.norm(light) + 0.8 * up
        self.light = light / np.linalg.norm(light)
        flat = places.reshape(-1, 3)
        self.spacing = round_length(0.2 * self.length)
        self.planes = []
        for half_space in self.solution.scene.half_spaces:
            n = half_space.normal
            if not n @ (self.camera.eye - half_space.point) > 0.0:
                continue  # seen from behind: it would hide the motion
            middle = self.camera.centre - ((self.camera.centre - half_space.point) @ n) * n
            reach = float(np.linalg.norm(flat - self.camera.centre, axis=1).max()) + self.length
            begin, end = 0.35 * reach, 1.6 * reach
            u = np.eye(3)[np.argmin(np.abs(n))]
            u = u - (u @ n) * n
            u /= np.linalg.norm(u)
            v = np.cross(n, u)
            # lines go through the point of the half-space, whatever the camera looks at
            middle = half_space.point + _steps(middle - half_space.point, (u, v), self.spacing)
            tint = rgb(half_space.color or "#ffffff")
            grid = np.array([self.spacing, begin, end])
            self.planes.append((np.array([middle, n, u, v]), grid, tint))

    def draw(self, t: float, clock: bool = True) -> np.ndarray:
        """Return the picture (height, width, 3), uint8, at a time within the run."""
        from carom.visual.films.raster import paint, shade

        camera = self.camera
        x, Q, _, _ = self.solution._curve(t)
        if self.followed is not None:
            camera = camera._replace(centre=x[self.followed[0].index])
        world, buffer = self._world(x, Q, t), self._empty(camera)
        for number, (plane, *_) in enumerate(self.planes, 1):
            falls = self.light @ plane[1]
            if falls > 0.1:
                above = (world.corners - plane[0]) @ plane[1]
                cast = world.corners - (np.maximum(above, 0.0) / falls)[..., None] * self.light
                shade(camera.project(cast), SHADOW, number, buffer)
        halfway = self.light + camera.axes.towards
        halfway /= max(float(np.linalg.norm(halfway)), 1e-12)
        half_line = max(0.5, 0.5 * LINE * camera.height)
        seen = world._replace(corners=camera.project(world.corners))
        paint(seen, self.light, halfway, half_line, buffer)
        return self._finished(buffer, camera, t, clock)

    def _empty(self, camera):
        """Return a buffer with only the planes; it is painted once if the camera does not move."""
        from carom.visual.films.raster import Buffer, ground

        if self.followed is not None or self._kept is None:
            shape = camera.height, camera.width
            image, depth = np.full((*shape, 3), 255, np.uint8), np.zeros(shape, np.float32)
            self._kept = Buffer(image, depth, np.zeros(shape, np.uint8))
            for number, (plane, grid, tint) in enumerate(self.planes, 1):
                middle = plane[0]
                if self.followed is not None:
                    middle = middle + _steps(camera.centre - middle, plane[2:], grid[0])
                bright = DIM + (1.0 - DIM) * max(0.0, float(plane[1] @ self.light))
                bright = bright * tint
                colours = np.array([bright * PLANE, bright * GRID, BACKGROUND])
                eye, sight = plane[1:] @ (camera.eye - middle), plane[1:] @ camera.rays
                ground(eye, sight, grid, colours, number, self._kept)
        return Buffer(*(one.copy() for one in self._kept))

    def _world(self, x, Q, t: float) -> Model:
        """Return all triangles at their present positions."""
        x, Q = np.vstack([x, np.zeros(3)]), np.vstack([Q, [1.0, 0.0, 0.0, 0.0]])  # the last: static
        turn = quaternion.matrix(Q)[self.owner]
        corners = np.einsum("fij,fkj->fki", turn, self.all.corners) + x[self.owner][:, None]
        normals = np.einsum("fij,fkj->fki", turn, self.all.normals)
        lines = [link.line(x, Q, self.up) for link in self.links if link.is_there(t)]
        links = [self._link(*pair) for line in lines for pair in itertools.pairwise(line)]
        return joined([self.all._replace(corners=corners, normals=normals), *links])

    def _link(self, a, b) -> Model:
        """Return a thin rod from one point to another."""
        length = float(np.linalg.norm(b - a))
        if not length > 0.0:
            return Model(*(column[:0] for column in self.rod))
        turn, radius = quaternion.matrix(turn_to((b - a) / length)).T, 0.004 * self.length
        corners = self.rod.corners * (radius, radius, length) @ turn + 0.5 * (a + b)
        return self.rod._replace(corners=corners, normals=self.rod.normals @ turn)

    def _finished(self, buffer, camera, t: float, clock: bool) -> np.ndarray:
        """Return the picture with arrows and clock, in its own size."""
        Image, ImageDraw, ImageFont = pillow()
        large = Image.fromarray(buffer.image)
        pen = ImageDraw.Draw(large)
        self.marks.draw(pen, camera, buffer.depth, t)
        if clock:
            height = max(12, camera.height // 20)
            font = ImageFont.load_default(height)
            words = f"{t:.{self.digits}f} s"
            pen.text((0.7 * height, 0.55 * height), words, fill="#404040", font=font)
        return np.asarray(large.resize(self.size, Image.Resampling.BOX))

    @property
    def digits(self) -> int:
        """Decimals of the clock, enough to read a hundredth of the run."""
        span = float(self.solution.t[-1] - self.solution.t[0])
        return int(np.clip(np.ceil(2.0 - np.log10(max(span, 1e-9))), 0, 9))


@arguments.known
def still(
    solution,
    t: float | None = None,
    *,
    size=(1280, 720),
    view="oblique",
    follow=None,
    zoom=1.0,
    clock=True,
) -> np.ndarray:
    """Draw one picture of a motion, as in a film.

    Impulses of impacts are shown for a hundredth of the duration of the run.

    Parameters
    ----------
    solution : Solution
        The run.
    t : float, optional
        Time within the run [s]. Default: its end.
    size, view, follow, zoom
        As for `carom.film`.
    clock : bool
        True (default): write the time in a corner.

    Returns
    -------
    ndarray, shape (height, width, 3), uint8
        Red, green and blue of each pixel.
    """
    need_bodies(solution, "still")
    last = float(solution.t[-1])
    t = (
        last
        if t is None
        else checks.number("t", t, least=float(solution.t[0]), most=last, unit="s")
    )
    checks.flag("clock", clock)
    stage = Stage(solution, size, view, follow, zoom=zoom)
    stage.marks.linger = RECENT * (last - float(solution.t[0]))
    return stage.draw(t, clock)


def checked_size(size) -> tuple[int, int]:
    """Return width and height, which must be even for the encoder of films."""
    if (
        not isinstance(size, (list, tuple, np.ndarray))
        or len(checks.listed("size", size, "two")) != 2
    ):
        raise ValueError(f"size must be (width, height) in pixels, got {checks.shown(size)}")
    for name, n in zip(("width", "height"), size):
        checks.integer(f"size, {name},", n, least=16, most=8192)
        if n % 2:
            raise ValueError(f"size must be even numbers of pixels, got {checks.shown(size)}")
    return int(size[0]), int(size[1])


def pillow() -> tuple[Any, Any, Any]:
    """Return the parts of Pillow that are used, or raise an error that says how to install it."""
    parts = ("PIL.Image", "PIL.ImageDraw", "PIL.ImageFont")
    image, draw, font = (checks.need(part, "a film or a still", "film", "pillow") for part in parts)
    return image, draw, font


def _steps(apart, directions, spacing: float) -> np.ndarray:
    """Return the displacement nearest to `apart` that moves a grid onto itself."""
    steps = [spacing * np.round(apart @ e / spacing) * e for e in directions]
    return np.sum(steps, axis=0)
