r"""Newton's cradle, by two models of its impact
============================================

Three balls hang side by side, the first strikes. What comes out is a matter of physics, not of balance: energy
and momentum leave one number open. Blow after blow the last ball takes all. This is the textbook's motion, of
balls that do not quite touch. Balls that touch are pressed together, and obey Hertz's law: the default. The
velocities after are those of forces :math:`d^{3/2}`, integrated.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

import carom
from carom.visual.plots import style

g, radius, length, angle = 9.81, 0.02, 0.2, np.radians(20)

# %%
# What is expected of balls that touch: forces :math:`d^{3/2}` between them, integrated by SciPy.


def hertz():  # speeds in the end, as parts of the first at the start, with forces d^(3/2)
    def rates(t, y):
        first, second = np.maximum(y[:2] - y[1:3], 0) ** 1.5
        return [*y[3:], -first, first - second, second]

    return solve_ivp(rates, (0, 50), [0, 0, 0, 1, 0, 0], rtol=1e-10, atol=1e-12).y[3:, -1]


# %%
# The cradle itself: three balls on hinges, elastic, with one of two models for impacts that happen together.


def swing(multiple):
    scene = carom.Scene(gravity=(0, 0, -g))
    for k in range(3):
        pivot = np.array([2 * radius * k, 0, length])
        place = pivot - length * np.array([0, 0, 1] if k else [np.sin(angle), 0, np.cos(angle)])
        ball = scene.add_body(carom.Sphere(radius), mass=0.1, position=place)
        scene.add_joint(carom.joints.Revolute(pivot, (0, 1, 0)), carom.GROUND, ball)
    scene.set_contact_default(restitution=1, multiple=multiple)
    return carom.simulate(scene, 1.5, step=1e-3)


# %%
# Both models, and what each ball has after the first impact, beside the exact values.


def main(out="out/examples"):
    with style.style():
        figure, rows = style.new(style.PAGE, 2.4, columns=2, sharey=True)
        models = {"sequential": [0, 0, 1], "simultaneous": hertz()}
        for axes, (multiple, true) in zip(rows, models.items()):
            s = swing(multiple)
            before, v = (s.evaluate(s.impacts.time[0], side)[2][:, 0] for side in ("left", "right"))
            print(f"{multiple:12} {(v / before[0]).round(6)}, exact {np.round(true, 6)}")
            for k, colour in enumerate((style.BLUE, style.GREEN, style.RED)):
                x = 1e3 * (s.position[:, k, 0] - 2 * radius * k)
                axes.plot(s.t, x, color=colour, label=f"ball {k + 1}")
            axes.set(xlabel="time / s", title=f'multiple="{multiple}"', ylim=(-80, 110))
            assert np.allclose(v / before[0], true, atol=1e-6)
        rows[0].set(ylabel="displacement / mm"), rows[0].legend(ncols=3, loc="upper center")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "newtons_cradle.png", dpi=style.DPI)


if __name__ == "__main__":
    main()
