"""The picture of the tutorial of a thousand dice: where they lie, and how often each face came up.

Run ``python docs/pictures/thousand_dice.py`` to make ``docs/_static/thousand_dice.png``.
"""

from __future__ import annotations

from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from scipy.spatial.transform import Rotation

import carom
from carom.studies.ensembles.dice import face_up, fairness

EDGE = 0.02  # [m]
COLOURS = np.array(["#0072B2", "#E69F00", "#009E73", "#CC79A7", "#D55E00", "#56B4E9"])
OUT = Path(__file__).parents[1] / "_static" / "thousand_dice.png"
WEIGHT = [(carom.Box(EDGE, EDGE, EDGE), (0, 0, 0)), (carom.Sphere(0.002), (0, 0, -0.007))]


def throw(shape) -> carom.Ensemble:
    """Throw a die a thousand times in random orientation."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    die = scene.add_body(
        shape, mass=0.016, position=(0, 0, 0.3),
        velocity=(0.5, 0, -0.5), angular_velocity=(0, 10, 0), name="die",
    )  # fmt: skip
    scene.add_contact(die, table, restitution=0.5, friction=0.2)
    vary = {"die.orientation": carom.UniformOrientation()}
    return carom.ensemble(scene, 2.0, step=2e-3, runs=1000, vary=vary)


def draw_table(ax, thrown: carom.Ensemble, count: int) -> None:
    """Draw the first dice from above, in the colours of their faces."""
    box = EDGE / 2 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    turns = Rotation.from_quat(thrown.orientation[:count, 0], scalar_first=True)
    outlines = []
    for centre, turn in zip(thrown.position[:count, 0], turns):
        corners = turn.apply(box)
        top = corners[corners[:, 2] > 0, :2]
        order = np.argsort(np.arctan2(top[:, 1], top[:, 0]))
        outlines.append(100 * (centre[:2] + top[order]))
    faces = face_up(thrown.orientation[:count, 0])
    ax.add_collection(
        PolyCollection(
            outlines, facecolors=COLOURS[faces - 1], edgecolors="white", lw=0.5, alpha=0.85
        )
    )
    ax.plot(0, 0, "+", color="0.1", ms=11, mew=1.6)
    for face in range(1, 7):
        ax.plot([], [], "s", color=COLOURS[face - 1], label=str(face))
    ax.legend(title="face up", loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    ax.set(xlabel="$x$ [cm]", ylabel="$y$ [cm]", aspect="equal")
    ax.autoscale_view()


def draw_shares(ax, thrown: carom.Ensemble, shift: float, label: str, **style) -> None:
    """Draw how often each face came up, with 95 % intervals."""
    found = fairness(face_up(thrown.orientation[:, 0]))
    bars = np.abs(np.array([found.low, found.high]) - found.share)
    ax.errorbar(
        np.arange(1, 7) + shift, found.share, bars, fmt="o", capsize=3, label=label, **style
    )
    print(label, found.counts, f"p = {found.p_value:.3g}")


def main() -> None:
    """Make the picture."""
    plt.rcParams.update({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False})
    fair = throw(carom.Box(EDGE, EDGE, EDGE))
    loaded = throw(carom.Compound(WEIGHT, masses=[0.008, 0.008]))
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(9.2, 4.0), width_ratios=[1.35, 1], layout="constrained"
    )
    draw_table(left, fair, 300)
    right.axhline(1 / 6, color="0.6", ls="--", lw=1.2)
    draw_shares(right, fair, -0.1, "fair", color="#0072B2")
    draw_shares(right, loaded, 0.1, "loaded", color="#D55E00", mfc="white")
    right.text(6.5, 1 / 6 + 0.006, "1/6", color="0.4")
    right.set(xlabel="face up", ylabel="share of 1000 throws", ylim=(0, None), xlim=(0.5, 6.9))
    right.legend(frameon=False, loc="upper left")
    figure.savefig(OUT, dpi=160)
    print(OUT)


if __name__ == "__main__":
    main()
