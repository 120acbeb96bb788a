"""Figure and page of the real impacts."""

from __future__ import annotations

import csv
from functools import cache
from pathlib import Path

import numpy as np

from carom.paper import real
from carom.paper.figure import FigureOfPaper, page, table
from carom.visual.plots import style

_LAW_COLOURS = dict(zip(real.LAWS, (style.BLUE, style.GREEN, style.RED)))


@cache
def cases() -> dict[str, tuple]:
    """Return each prediction: (law, e, mu, predicted velocities (K, 6))."""
    found: dict[str, tuple] = {"no impact": ("", None, None, real.no_impact())}
    for law in real.LAWS:
        found[f"{law}, nominal"] = (law, *real.NOMINAL, real.predict(*real.NOMINAL, law))
    for law in real.LAWS:
        e, mu = real.fit(law)
        found[f"{law}, fitted"] = (law, e, mu, real.predict(e, mu, law))
    return found


def _scatter(axes, part: slice, unit: str, reach: float):
    """Draw predicted against measured components after the impact, with Stronge's law fitted."""
    predicted = cases()["stronge, fitted"][3][:, part]
    measured = real.load().after[:, part]
    axes.plot([-reach, reach], [-reach, reach], color=style.BLACK, lw=0.5)
    for k, colour in enumerate((style.BLUE, style.ORANGE, style.RED)):
        label = ("$%s_x$", "$%s_y$", "$%s_z$")[k] % ("v" if unit == "m/s" else r"\omega")
        axes.plot(measured[:, k], predicted[:, k], "o", color=colour, ms=2.0, mew=0, alpha=0.75,
                  label=label)  # fmt: skip
    axes.set(xlabel=f"measured [{unit}]", ylabel=f"predicted [{unit}]", aspect="equal",
             xlim=(-reach, reach), ylim=(-reach, reach))  # fmt: skip
    axes.legend(loc="upper left", handletextpad=0.1, markerscale=1.8)


def _spread(axes, which: int, label: str, reach: float):
    """Draw the fraction of impacts with an error below the abscissa."""
    for name, (law, *_, predicted) in cases().items():
        error = np.sort(real.errors(predicted)[which])
        share = np.arange(1, error.size + 1) / error.size
        colour = _LAW_COLOURS.get(law, style.GREY)
        line = "--" if "nominal" in name else "-"
        axes.step(error, 100 * share, line, color=colour, lw=1.0, where="post")
    axes.set(xlabel=label, ylabel="share of impacts [%]", xlim=(0, reach), ylim=(0, 100))


def _draw():
    figure, axes = style.new(style.PAGE, 5.6, 2, 2)
    speed = 1.02 * float(np.max(np.abs(real.load().after[:, :3])))
    spin = 1.02 * float(np.max(np.abs(real.load().after[:, 3:])))
    _scatter(axes[0, 0], slice(0, 3), "m/s", speed)
    _scatter(axes[0, 1], slice(3, 6), "rad/s", spin)
    _spread(axes[1, 0], 0, r"error of velocity $|\Delta v|$ [m/s]", 1.6)
    _spread(axes[1, 1], 1, r"error of angular velocity $|\Delta\omega|$ [rad/s]", 12.0)
    for law, colour in _LAW_COLOURS.items():
        axes[1, 1].plot([], [], color=colour, label=law.capitalize())
    axes[1, 1].plot([], [], color=style.BLACK, label="fitted $e$, $\\mu$")
    axes[1, 1].plot([], [], "--", color=style.BLACK, label="nominal $e$, $\\mu$")
    axes[1, 1].plot([], [], color=style.GREY, label="no impact")
    axes[1, 1].legend(loc="lower right")
    return figure


def _numbers() -> dict:
    """Return the numbers of the text: medians of errors, and the fitted parameters."""
    e, mu = real.fit("stronge")
    names = {"nominal": "stronge, nominal", "fitted": "stronge, fitted", "nothing": "no impact"}
    return {"e": e, "mu": mu, **{k: real.medians(cases()[name][3]) for k, name in names.items()}}


FIGURES = (FigureOfPaper("real_impacts", _draw, _numbers),)


def rows() -> list[tuple]:
    """Return (case, e, mu, median |dv|, median |dw|) of all predictions."""
    found = [(name, e, mu, *real.medians(p)) for name, (_, e, mu, p) in cases().items()]
    found.insert(4, ("newton, e = 0.3", 0.3, 0.18, *real.medians(real.predict(0.3, 0.18))))
    for name, (e, mu) in (("nominal", real.NOMINAL), ("fitted", real.fit("stronge"))):
        medians = real.medians(real.simulated(e, mu, "stronge"))
        found.append((f"stronge, {name}, simulated", e, mu, *medians))
    return found


def write(folder: Path) -> list[Path]:
    """Write real_impacts.md and real_impacts.csv."""
    found = rows()
    files = [folder / "real_impacts.csv", folder / "real_impacts.md"]
    with files[0].open("w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows(
            [("prediction", "e", "mu", "median |dv| [m/s]", "median |dw| [rad/s]"), *found]
        )
    shown = [
        (name, *(("-", "-") if e is None else (f"{e:.3f}", f"{mu:.3f}")), f"{dv:.3f}", f"{dw:.2f}")
        for name, e, mu, dv, dw in found
    ]
    head = ("prediction", "e", "mu", "median of dv [m/s]", "median of dw [rad/s]")
    lifted = np.zeros(6)
    lifted[2] = real.GRAVITY * real.SAMPLES_BETWEEN * real.DT
    nominal, nothing = (cases()[name][3] for name in ("stronge, nominal", "no impact"))
    text = page(
        "real_impacts",
        count=len(real.load().toss),
        table=table(head, shown),
        span=1e3 * real.SAMPLES_BETWEEN * real.DT,
        gravity=lifted[2],
        wrong_v=real.medians(nominal + lifted)[0],
        still_v=real.medians(nothing + lifted)[0],
        radius=np.sqrt(real.INERTIA / real.MASS),
        seen=FIGURES[0].seen(),
    )
    files[1].write_text(text, encoding="utf-8")
    return files
