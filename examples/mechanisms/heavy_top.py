r"""A gyroscope nods as it goes round
=================================

A fast top whose axle is let go level does not fall: it goes round, and nods. The height :math:`u` of the axle
obeys :math:`\dot u^2 = (1 - u^2)(\omega^2 - \beta u) - (\omega - b u)^2`, where :math:`b = C n / A`,
:math:`\beta = 2 m g a / A` and :math:`\omega` is the rate at which it is sent off, so that time and way of a
nod follow by quadrature.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import quad

import carom
from carom.visual.plots import style

g, m, arm, spin, C = 9.81, 1.0, 0.1, 180.0, 2e-3
A = C + m * arm**2  # moment about the foot, across the axle
b, beta = C * spin / A, 2 * m * g * arm / A


def nod(w):  # time of a nod, and angle of the way round in it
    p, q = w**2 + b**2, 2 * w * b - beta  # u'^2 = u (beta u^2 - p u + q)
    root = np.sqrt(p**2 - 4 * beta * q)
    low, high = (p - root) / (2 * beta), (p + root) / (2 * beta)

    def over(s, way):  # u = low sin^2 s
        u = low * np.sin(s) ** 2
        return 4 * ((w - b * u) / (1 - u**2) if way else 1.0) / np.sqrt(beta * (high - u))

    return [quad(over, 0, np.pi / 2, args=(way,))[0] for way in (False, True)]


def top(w):
    scene = carom.Scene(gravity=(0, 0, -g))
    body = scene.add_body(mass=m, inertia=(C, C, C), position=(arm, 0, 0), velocity=(0, w * arm, 0),
                          angular_velocity=(spin, 0, w))  # fmt: skip
    scene.add_joint(carom.joints.Spherical((0, 0, 0)), carom.GROUND, body)
    return carom.simulate(scene, 1.0, step=1e-3, method="rk8")


def main(out="out/examples"):
    with style.style():
        figure, rows = style.new(style.PAGE, 3.0, rows=3, sharex=True, sharey=True)
        for axes, (w, name) in zip(rows, ((-3, "sent back"), (0, "let go"), (1.5, "sent on"))):
            s, (time, way) = top(w), nod(w)
            (x, y, z), at = s.position[:, 0].T / arm, s.evaluate(time)[0][0] / arm
            error = max(abs(at[2]), abs(np.arctan2(at[1], at[0]) - way))
            print(
                f"{name}: a nod of {time:.6f} s, {np.degrees(way):.3f} degrees, error {error:.0e}"
            )
            turn = np.degrees(np.unwrap(np.arctan2(y, x)))
            axes.plot(turn, np.degrees(np.arcsin(z)), color=style.BLUE)
            axes.plot(np.degrees(way), 0, "o", color=style.RED)
            axes.set_title(name, loc="left", pad=2)
            assert error < 1e-8
        rows[2].set(xlabel="way round / degrees", xlim=(-6, 130), ylim=(-24, 3))
        rows[1].set(ylabel="height of the axle / degrees")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "heavy_top.png", dpi=style.DPI)


if __name__ == "__main__":
    main()
