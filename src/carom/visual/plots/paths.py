"""Plot of the paths of bodies, seen along a coordinate axis."""

from __future__ import annotations

import numpy as np

from carom import checks
from carom.arguments import known
from carom.geometry import quaternion
from carom.scene.surface_definition import SurfaceDefinition
from carom.visual.bodies import ground_curves, outline_of, parts_of
from carom.visual.plots import figure
from carom.visual.plots import style as looks

GROUND = "#ececec"
FLAT = 0.02  # height by width of motion on a level table
OUTLINES = 200  # outlines: more would cover each other


@known
def trajectory(
    solution,
    bodies=None,
    *,
    plane: str | None = None,
    outlines=None,
    ground=True,
    ax=None,
    figsize=None,
    style="carom",
):
    """Draw the paths of mass centres, seen along a coordinate axis.

    A square is the start of a path, and dots are impacts of the body. Static bodies, and half-spaces whose
    surface is seen edge-on, are drawn as ground.

    Parameters
    ----------
    solution : Solution
        The run.
    bodies : str or sequence of str, optional
        Bodies, as names or objects. Default: all.
    plane : str, optional
        Two of "x", "y", "z": the axis to the right and the axis upwards. Default: upwards opposite to gravity,
        and to the right the other axis with more motion; for motion on a horizontal table the plane of the
        table, seen from above.
    outlines : (m,) or int, optional
        Times [s] at which the outlines of the bodies are drawn, or their number, evenly spaced over the run; at
        most 200. Default: none.
    ground : bool
        True (default): draw half-spaces and static bodies.
    ax : Axes, optional
        Axes to draw into. Default: a new figure.
    figsize : (float, float), optional
        Width and height of a new figure [in].
    style : optional
        Style of the plot: "carom" (default), None for your own settings of matplotlib, a mapping of settings to
        add to those of carom, or what `matplotlib.style.use` takes.

    Returns
    -------
    Axes
        The axes.

    Raises
    ------
    ValueError
        If there is no body with this name, or `plane` is invalid.
    """
    figure.need_bodies(solution, "trajectory")
    checks.flag("ground", ground)
    chosen = figure.bodies(solution, bodies)
    t = figure.with_impacts(solution)
    x = solution._curve(t)[0]
    axes = _plane(plane, solution, x[:, [b.index for b in chosen]])
    seen, times = list(axes), _times(outlines, solution)
    wide, high = np.ptp(x[:, [b.index for b in chosen]][..., seen].reshape(-1, 2), axis=0)
    scene, parts, colours = solution.scene, [], {}
    if len(times) or scene.statics:
        size = max(outline_of(scene, body).radius for body in scene.bodies)
        region = 0.5 * float(np.hypot(wide, high)) + size
        parts = parts_of(scene, region, 48, x.reshape(-1, 3).mean(axis=0))
    inches = np.clip(2.8 * high / max(wide, 1e-300), 1.0, 3.4) + 0.6  # nearly as the axes are to be
    with figure.drawing(figure.Canvas(ax, figsize, style), 1, (looks.COLUMN, inches)) as drawn:
        many = len(chosen) > 12
        for body, (colour, line) in zip(chosen, figure.colours()):
            colours[body.index] = colour = body.color or colour
            path = x[:, body.index][:, seen]
            drawn.plot(*path.T, line, color=colour, lw=0.6 if many else 1.2, label=body.name)
            drawn.plot(*path[0], "s", color=colour, ms=2 if many else 3.5)
            struck = np.isin(t, _impact_times(solution, body))
            drawn.plot(*path[struck].T, "o", color=colour, ms=1.5 if many else 2.5)
        for part in parts:
            for b in colours.keys() & set(part.bodies) if part.look != "pip" else ():
                _outlines(drawn, solution, part, b, times, seen, colours[b])
        drawn.set(xlabel=f"${'xyz'[axes[0]]}$ [m]", ylabel=f"${'xyz'[axes[1]]}$ [m]")
        drawn.set_aspect("equal", adjustable="datalim")
        drawn.margins(0.08)
        drawn.autoscale_view()
        if ground:
            for half_space in scene.half_spaces:
                _ground(drawn, half_space, seen)
            for part in parts:
                if isinstance(part.shape, SurfaceDefinition):
                    _section(drawn, part, seen, float(np.mean(x[..., 3 - sum(seen)])))
                elif part.look == "static" and part.shape is not None:
                    _static(drawn, part, seen)
            for curve in ground_curves(scene):
                still = {"scalex": False, "scaley": False}  # the view is that of the motion
                drawn.plot(*curve[:, seen].T, color=GROUND, lw=2, zorder=0, **still)
        figure.legend(drawn, loc="best")
    return drawn


def _plane(plane, solution, x) -> tuple[int, int]:
    """Return the numbers of the axes to the right and up."""
    if plane is not None:
        checks.choice("plane", plane, (a + b for a in "xyz" for b in "xyz" if a != b))
        return "xyz".index(plane[0]), "xyz".index(plane[1])
    gravity = solution.scene.gravity
    moved = np.ptp(x, axis=0).max(axis=0)
    up = int(np.argmax(np.abs(gravity))) if np.any(gravity) else 2
    first, second = sorted({0, 1, 2} - {up})
    if moved[up] < FLAT * min(moved[first], moved[second]):
        return first, second
    if not np.any(gravity) and moved[2] < 1e-9 * moved.max():
        up = 1
    return max((k for k in range(3) if k != up), key=lambda k: moved[k] * (1 - 1e-9 * k)), up


def _impact_times(solution, body) -> np.ndarray:
    """Return the times of the impacts of a body."""
    pairs = solution.pairs
    mine = np.flatnonzero((pairs.body == body.index) | (pairs.other == body.index))
    return solution.impacts.time[np.isin(solution.impacts.contact, mine)]


def _times(outlines, solution) -> np.ndarray:
    """Return the times of outlines."""
    if outlines is None:
        return np.zeros(0)
    if checks.real_array("outlines", outlines, "() or (m,)").ndim == 0:
        return np.linspace(
            solution.t[0],
            solution.t[-1],
            checks.integer("outlines", outlines, least=1, most=OUTLINES),
        )
    times = checks.finite_array("outlines", outlines, (None,), "s")
    (first, last) = solution.t[[0, -1]]
    if len(times) > OUTLINES:
        raise ValueError(f"outlines must be at most {OUTLINES} times, got {len(times)}")
    if not np.all((times >= first) & (times <= last)):
        raise ValueError(
            f"outlines must be times within [{first:g}, {last:g}] s, got {checks.shown(outlines)}"
        )
    return times


def _outlines(axes, solution, part, b: int, times, seen, colour) -> None:
    """Draw the edges of a part of body b between faces that are turned to the viewer and faces that are not."""
    from matplotlib.collections import LineCollection

    vertices, triangles = part.vertices, part.triangles
    sides = {(int(f[k]), int(f[k - 2])): n for n, f in enumerate(triangles) for k in range(3)}
    pairs = np.array([(a, b, n, sides[b, a]) for (a, b), n in sides.items() if a < b])
    x, Q, _, _ = solution._curve(times)
    for place, turn in zip(x[:, b], Q[:, b]):
        flat = (place + quaternion.rotate(turn, vertices))[:, seen]
        a, b, c = (flat[triangles[:, k]] for k in range(3))
        (p, q), (r, s) = (b - a).T, (c - a).T
        towards = p * s - q * r > 0.0
        edge = pairs[towards[pairs[:, 2]] != towards[pairs[:, 3]], :2]
        axes.add_collection(
            LineCollection(list(flat[edge]), colors=colour, linewidths=0.6, capstyle="round")
        )


def _static(axes, part, seen) -> None:
    """Draw a static body as the ground: the shadow of all its triangles."""
    from matplotlib.collections import PolyCollection

    shadow = PolyCollection(
        list(part.vertices[:, seen][part.triangles]),
        facecolor=part.colour or GROUND,
        edgecolor=part.colour or GROUND,
        lw=0.5,
        zorder=0,
    )
    axes.add_collection(shadow, autolim=False)  # as of the ground, the view is that of the motion


def _section(axes, part, seen, depth: float) -> None:
    """Draw the line in which curved ground cuts the plane of the picture, at the mean depth of the paths."""
    from matplotlib.collections import LineCollection

    sides = part.vertices[part.triangles[:, [[0, 1], [1, 2], [2, 0]]]]  # (F, 3, 2, 3)
    away = sides[..., 3 - sum(seen)] - depth
    cut = (away[..., 0] > 0.0) != (away[..., 1] > 0.0)
    sides, away = sides[cut], away[cut]
    f = (away[:, 0] / (away[:, 0] - away[:, 1]))[:, None]
    ends = ((1.0 - f) * sides[:, 0] + f * sides[:, 1])[:, seen].reshape(-1, 2, 2)  # two a triangle
    line = LineCollection(list(ends), colors=looks.BLACK, linewidths=0.8, zorder=0)
    axes.add_collection(line, autolim=False)


def _ground(axes, half_space, seen) -> None:
    """Draw a half-space whose plane is seen edge-on: a line, and the matter behind it shaded."""
    normal = half_space.normal[seen]
    if not np.linalg.norm(normal) > 1.0 - 1e-9:
        return
    from matplotlib.patches import Polygon

    extent, colour = axes.dataLim.get_points(), half_space.color or GROUND
    centre, reach = extent.mean(axis=0), 50.0 * np.ptp(extent, axis=0).max()
    point = centre - ((centre - half_space.point[seen]) @ normal) * normal
    along, down = reach * np.array([-normal[1], normal[0]]), -reach * normal
    corners = np.array([point - along, point + along, point + along + down, point - along + down])
    # not through add_patch: the matter has no end, and must not count for the limits
    axes.add_artist(Polygon(corners, facecolor=colour, edgecolor=looks.BLACK, lw=0.8, zorder=0))
