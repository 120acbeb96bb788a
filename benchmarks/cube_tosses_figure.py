"""Picture of a real toss and its simulation from one start."""

from __future__ import annotations

from typing import Any

import numpy as np

from carom.geometry import quaternion
from carom.studies.identify.errors import distances
from carom.visual.plots import style

# x y z -x -y -z
FACES = style.BLUE, style.ORANGE, style.GREEN, style.SKY, style.RED, style.PURPLE
ELEVATION = np.radians(20.0)  # of the camera
LIGHT = np.array([-0.3, -0.45, 0.85])
POSES = 6
EDGE = 0.1048  # [m]
#: half width, and heights below and above the table under the real cube, of a picture [m]
WIDE, BELOW, ABOVE = 0.125, 0.06, 0.225


def draw(recording, run, half: float) -> Any:
    """Return a figure: real poses, below them simulated poses at the same times, and then both over time.

    Parameters
    ----------
    recording, run
        Measured and simulated motion of one cube, `Recording` and `RollOut`.
    half
        Half of its edge [m].
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(style.PAGE, 5.0), layout="constrained")
    parts: Any = figure.subfigures(2, 1, height_ratios=[1.3, 1.0])
    above, below = parts
    strip = above.subplots(2, POSES, gridspec_kw={"wspace": 0.03, "hspace": 0.03})
    camera = _camera(recording.position[:, 0])
    t = recording.t - recording.t[0]
    for column, k in enumerate(_picked(recording)):
        middle = camera @ (recording.position[k, 0] * [1, 1, 0])
        for row, motion in enumerate((recording, run)):
            _pose(strip[row, column], motion, k, half, camera, middle)
        strip[0, column].set_title(f"{t[k]:.2f} s", fontsize=8, pad=2)
    for row, name in enumerate(("real", "simulated")):
        strip[row, 0].annotate(
            name, (-0.08, 0.5), xycoords="axes fraction", rotation=90, ha="center", va="center"
        )
    left, right = below.subplots(1, 2)
    _positions(left, recording, run)
    _errors(right, recording, run)
    return figure


def _camera(x: np.ndarray) -> np.ndarray:
    """Return the rows right, up, and towards the viewer, so that the motion is from left to right."""
    along = x[-1] - x[0]
    along[2] = 0.0
    right = along / np.linalg.norm(along)
    front = np.cross(right, [0.0, 0.0, 1.0])
    towards = np.cos(ELEVATION) * front + np.sin(ELEVATION) * np.array([0.0, 0.0, 1.0])
    return np.stack([right, np.cross(towards, right), towards])


def _picked(recording) -> np.ndarray:
    """Return the samples to draw, at about equal distances along the path of a corner."""
    x, q = recording.position[:, 0], recording.orientation[:, 0]
    turn = np.linalg.norm(quaternion.between(q[:-1], q[1:]), axis=-1)
    step = np.linalg.norm(np.diff(x, axis=0), axis=1) + 0.5 * EDGE * turn
    path = np.insert(np.cumsum(np.where(step > 5e-4, step, 0.0)), 0, 0.0)
    return np.searchsorted(path, np.linspace(0.0, path[-1] * (1.0 - 1e-6), POSES))


def _pose(axes, motion, k: int, half: float, camera, middle) -> None:
    """Draw the cube of sample k on the table; the camera points at `middle`."""
    from matplotlib.collections import LineCollection, PolyCollection
    from scipy.spatial import ConvexHull

    x, q = motion.position[k, 0], motion.orientation[k, 0]

    def seen(points):
        return (points @ camera.T - middle)[..., :2]

    lines = 0.05 * np.arange(-40, 41)
    ends = np.array([-2.0, 2.0])
    grid = [[(a, b, 0.0) for b in ends] for a in lines] + [
        [(a, b, 0.0) for a in ends] for b in lines
    ]
    marks = LineCollection(list(seen(np.array(grid))), colors="white", linewidths=0.7, zorder=0)
    axes.add_collection(marks)
    corners = x + quaternion.rotate(q, half * (2.0 * np.indices((2, 2, 2)).reshape(3, 8).T - 1.0))
    shadow = corners[:, :2][ConvexHull(corners[:, :2]).vertices]
    axes.fill(*seen(np.insert(shadow, 2, 0.0, axis=1)).T, color="#b4b4af", lw=0, zorder=0.5)
    polygons, colours = [], []
    for face, colour in enumerate(FACES):
        ring, normal = _face(face, half)
        outward = quaternion.rotate(q, normal)
        if outward @ camera[2] > 0.0:
            polygons.append(seen(x + quaternion.rotate(q, ring)))
            lit = max(0.0, float(outward @ LIGHT) / float(np.linalg.norm(LIGHT)))
            colours.append(_shade(colour, 0.6 + 0.4 * lit))
    cube = PolyCollection(polygons, facecolors=colours, edgecolors="black", linewidths=0.6)
    cube.set_joinstyle("round")
    axes.add_collection(cube)
    axes.set(xlim=(-WIDE, WIDE), ylim=(-BELOW, ABOVE), aspect="equal", xticks=[], yticks=[])
    axes.set_facecolor("#e6e6e2")
    for spine in axes.spines.values():
        spine.set_visible(False)


def _face(face: int, half: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the corners (4, 3) of a face of the cube, in order, and its outward normal."""
    axis, sign = face % 3, 1.0 if face < 3 else -1.0
    ring = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], dtype=float)
    return np.insert(ring, axis, sign, axis=1) * half, sign * np.eye(3)[axis]


def _shade(colour: str, bright: float):
    from matplotlib.colors import to_rgb

    return tuple(bright * np.array(to_rgb(colour)))


def _positions(axes, recording, run) -> None:
    """Draw the three coordinates: measured as dots, simulated as lines."""
    t = recording.t - recording.t[0]
    axes.plot([], [], "o", color=style.GREY, ms=2.2, mew=0, label="real")
    axes.plot([], [], color=style.GREY, lw=1.0, label="simulated")
    colours, ends = (style.BLUE, style.ORANGE, style.RED), run.position[-1, 0]
    places, apart = ends.copy(), 0.08 * float(np.ptp(recording.position))  # for the labels
    for lower, upper in np.argsort(ends)[[[0, 1], [1, 2]]]:
        places[upper] = max(ends[upper], places[lower] + apart)
    for k, colour in enumerate(colours):
        measured = recording.position[::2, 0, k]
        axes.plot(t[::2], measured, "o", color=colour, ms=2.2, mew=0, alpha=0.65)
        axes.plot(t, run.position[:, 0, k], color=colour, lw=1.0)
        where = {"xy": (1.015, places[k]), "xycoords": ("axes fraction", "data")}
        axes.annotate(f"${'xyz'[k]}$", **where, color=colour, va="center")
    axes.set(xlabel="time [s]", ylabel="centre of the cube [m]", xlim=(0, t[-1]))
    axes.legend(loc="lower right")


def _errors(axes, recording, run) -> None:
    """Draw the distance and the angle between the two motions over time, and their means."""
    t = recording.t - recording.t[0]
    distance, angle = (part[:, 0] for part in distances(run, recording))
    distance, angle = 100.0 * distance / EDGE, np.degrees(angle)
    axes.plot(
        t,
        distance,
        color=style.GREEN,
        label=f"position [% of the edge], mean {distance.mean():.1f}",
    )
    axes.plot(t, angle, color=style.PURPLE, label=f"rotation [deg], mean {angle.mean():.1f}")
    top = 1.45 * max(distance.max(), angle.max())
    axes.set(xlabel="time [s]", ylabel="simulated from real", xlim=(0, t[-1]), ylim=(0, top))
    axes.legend(loc="upper left")
