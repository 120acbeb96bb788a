"""The picture of the page of the bicycle: modes over the speed, and motions after a push.

Run ``python docs/pictures/bicycle.py`` to make ``docs/_static/bicycle.png``.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from carom.visual.plots import style

DOCS = Path(__file__).parents[1]
PAGE, OUT = DOCS / "published" / "bicycle.md", DOCS / "_static" / "bicycle.png"
#: of the published linear equations M q'' + v C1 q' + (g K0 + v^2 K2) q = 0 of lean and steer
M = np.array([[80.81722, 2.31941332208709], [2.31941332208709, 0.29784188199686]])
K0 = np.array([[-80.95, -2.59951685249872], [-2.59951685249872, -0.80329488458618]])
K2 = np.array([[0, 76.59734589573222], [0, 2.65431523794604]])
C1 = np.array([[0, 33.86641391492494], [-0.85035641456978, 1.68540397397560]])


def published(v: float) -> np.ndarray:
    """Return the modes of the published equations at a speed."""
    lower = np.hstack([-np.linalg.solve(M, 9.81 * K0 + v * v * K2), -np.linalg.solve(M, v * C1)])
    upper = np.hstack([np.zeros((2, 2)), np.eye(2)])
    return np.sort_complex(np.linalg.eigvals(np.vstack([upper, lower])))


def page() -> dict:
    """Return the names that the code of the page defines."""
    space: dict = {}
    for code in re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S):
        exec(re.sub(r"^print.*", "", code, flags=re.M), space)
    return space


def main() -> None:
    """Make the picture."""
    names = page()
    with style.style():
        figure = Figure(figsize=(style.PAGE, 4.8), layout="constrained")
        axes = figure.subplot_mosaic(
            [["modes"] * 3, ["slow", "right", "fast"]], height_ratios=[1.4, 1]
        )
        panel = axes["modes"]
        speeds = np.linspace(0, 10, 801)
        exact = np.array([published(v) for v in speeds])
        waves = np.abs(exact.imag) > 1e-9
        panel.plot(speeds, np.where(waves, np.nan, exact.real), ".", color=style.GREY, ms=1.0)
        panel.plot(speeds, np.where(waves, exact.real, np.nan), ".", color=style.SKY, ms=1.0)
        for v in np.arange(0.5, 10.01, 0.5):
            every = 0.01 if v > 5 else 0.05  # the castering mode decays fast
            panel.plot(
                v * np.ones(4),
                names["modes"](v, every=every).real,
                "o",
                mfc="none",
                color=style.BLUE,
                ms=4,
            )
        panel.axvspan(4.29238253634111, 6.02426201538837, color="0.9", lw=0)
        panel.axhline(0.0, color=style.BLACK, lw=0.4)
        panel.set(
            xlabel="speed [m/s]",
            ylabel="real parts of the modes [1/s]",
            xlim=(0, 10),
            ylim=(-10, 10),
        )
        panel.annotate("stable", (5.16, 8.5), ha="center")
        for where, text in (
            ((2.4, 4.6), "weave"),
            ((8.5, 1.0), "capsize"),
            ((2.8, -9.3), "castering"),
        ):
            panel.annotate(text, where)
        for name, v, long in (("slow", 3.5, 4.0), ("right", 5.0, 8.0), ("fast", 8.0, 8.0)):
            motion = np.degrees(names["lean_and_steer"](v, 0.1, 0.0, long, 0.02))
            t = 0.02 * np.arange(len(motion))
            axes[name].plot(t, motion[:, 0], color=style.BLUE, label="lean")
            axes[name].plot(t, motion[:, 1], color=style.RED, label="steer")
            axes[name].axhline(0.0, color=style.BLACK, lw=0.4)
            axes[name].set(title=f"{v:g} m/s", xlabel="time [s]", xlim=(0, t[-1]))
        axes["slow"].set_ylabel("angle [degrees]")
        axes["slow"].legend(loc="upper left")
        style.write(figure, OUT)
    print(OUT)


if __name__ == "__main__":
    main()
