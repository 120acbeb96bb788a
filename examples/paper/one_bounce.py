r"""Where the error of time stepping comes from
===========================================

One bounce of a die, on the way to 0.22 s, by time steps of which one holds the impact (Moreau and Jean), by the
paper's, which brings the step back to the surface, and by steps that end at the impact. The first two err by
what the body moves in a part of a step, and by chance; the last is exact in flight, for any step.
"""

from pathlib import Path

import numpy as np

import carom
from carom.baselines import moreau_jean
from carom.visual.plots import style

mass, edge, e, mu, T = 0.016, 0.02, 0.5, 0.05, 0.21
STEPS = 2e-3 / 2.0 ** np.arange(6)
ROUGH = carom.Options(energy_tolerance=0.1)  # a return to the surface gives energy
PAPER = {"method": "paper", "impact_location": "project", "options": ROUGH}


def throw():
    scene = carom.Scene(gravity=(0, 0, -9.81))
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    die = scene.add_body(
        carom.Box(edge, edge, edge), mass=mass, position=(0, 0, 0.3), velocity=(0.5, 0, -0.5),
        angular_velocity=(0, 10, 0), name="die",
    )  # fmt: skip
    scene.add_contact(die, table, restitution=e, friction=mu)
    return scene


def exact():  # free fall, Routh's impulse of an edge that slips, free fall
    s = carom.simulate(throw(), T, step=1e-3)
    t, W, u = s.impacts.time[0], s.impacts.inverse_mass[0], s.impacts.relative_velocity_before[0]
    P = (1 + e) * -u[0] / (W[0, 0] - mu * np.sign(u[1]) * W[0, 1])
    v = np.array([0.5 - mu * np.sign(u[1]) * P / mass, -0.5 - 9.81 * t + P / mass])
    x = np.array([0.5 * t, 0.3 - 0.5 * t - 9.81 * t**2 / 2])
    return x + v * (T - t) - [0, 9.81 * (T - t) ** 2 / 2]


def main(out="out/examples"):
    true, errors = exact(), {}
    for h in STEPS:
        runs = {
            "Moreau-Jean": moreau_jean(throw(), T, step=h),
            "paper, projected": carom.simulate(throw(), T, step=h, **PAPER),
            "located": carom.simulate(throw(), T, step=h),
        }
        for name, run in runs.items():
            errors.setdefault(name, []).append(np.linalg.norm(run.position[-1, 0, [0, 2]] - true))
    print(*(f"{name}: {np.array(error)} m" for name, error in errors.items()), sep="\n")
    with style.style():
        figure, axes = style.new(style.PAGE, 2.9)
        for (name, error), colour in zip(errors.items(), (style.RED, style.PURPLE, style.BLUE)):
            axes.loglog(1e3 * STEPS, error, "o-", color=colour, label=name)
        axes.set(xlabel="step / ms", ylabel="error after one bounce / m"), axes.legend(loc="center")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "one_bounce.png", dpi=style.DPI)
    assert max(errors["located"]) < 1e-12


if __name__ == "__main__":
    main()
