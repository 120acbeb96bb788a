r"""
Newton's cradle, by two models of its impact
============================================

Three balls hang side by side, the first strikes. What comes out is a matter of physics, not of balance: energy and
momentum leave one number open. Blow after blow the last ball takes all. If the contacts are springs of equal
stiffness, passed together, modes :math:`\cos \omega t` and :math:`\cos \sqrt{3} \omega t` of the row say what each ball gets.
"""

from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import carom
from carom.paper import style

g, radius, length, angle = 9.81, 0.02, 0.2, np.radians(20)
COLOURS = (style.BLUE, style.GREEN, style.RED)


def springs():
    """Speeds in the end, of the first at the start; the stiffness sets the scale of time alone."""

    def v(t):  # both springs pressed
        a, b = np.cos(t), np.cos(np.sqrt(3) * t)
        return np.array([1 / 3 + a / 2 + b / 6, 1 / 3 - b / 3, 1 / 3 - a / 2 + b / 6])

    def press(t):
        a, b = np.sin(t), np.sin(np.sqrt(3) * t) / np.sqrt(3)
        return np.array([a / 2 + b / 2, a / 2 - b / 2])  # of the first spring, of the second

    end = brentq(lambda t: press(t)[0], 1.5, 3.0)  # the first lets go; then the last two alone
    first, second, third = v(end)
    half, squeeze = (second - third) / 2, press(end)[1] / np.sqrt(2)
    back = np.hypot(half, squeeze)  # half the relative speed when the second lets go
    mean = (second + third) / 2
    return np.array([first, mean - back, mean + back])


def swing(multiple):
    scene = carom.Scene(gravity=(0, 0, -g))
    for k in range(3):
        pivot = np.array([2 * radius * k, 0, length])
        turn = angle if k == 0 else 0.0
        place = pivot - length * np.array([np.sin(turn), 0, np.cos(turn)])
        ball = scene.add_body(carom.Sphere(radius), mass=0.1, position=place, name=f"ball {k + 1}")
        scene.add_joint(carom.joints.Revolute(pivot, (0, 1, 0)), carom.GROUND, ball)
        if k:
            scene.add_contact(ball, scene.bodies[k - 1], restitution=1)
    return carom.simulate(scene, 1.5, step=1e-3, options=carom.Options(multiple=multiple))


def main(out="out/examples"):
    with style.style():
        figure, rows = style.new(style.PAGE, 2.4, columns=2, sharey=True)
        for axes, multiple, true in zip(
            rows, ("sequential", "simultaneous"), ([0, 0, 1], springs())
        ):
            s = swing(multiple)
            blow = s.impacts.time[0]
            v = s.evaluate(blow)[2][:, 0] / s.evaluate(blow, side="left")[2][0, 0]
            print(f"{multiple:12} {v.round(6)}, exact {np.round(true, 6)}")
            for k, colour in enumerate(COLOURS):
                x = s.position[:, k, 0] - 2 * radius * k
                axes.plot(s.t, 1e3 * x, color=colour, label=f"ball {k + 1}")
            axes.set(xlabel="time / s", title=multiple, ylim=(-80, 110))
            assert np.allclose(v, true, atol=1e-6)
    rows[0].set(ylabel="displacement / mm"), rows[0].legend(ncols=3, loc="upper center")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "newtons_cradle.png", dpi=style.DPI)


if __name__ == "__main__":
    main()
