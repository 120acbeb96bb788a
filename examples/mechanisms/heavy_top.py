r"""
A gyroscope nods as it goes round
=================================

A fast top whose axle is let go level does not fall: it goes round, and nods. The height :math:`u` of the axle obeys
:math:`\dot u^2 = (1 - u^2)(\omega^2 - \beta u) - (\omega - b u)^2`, where :math:`b = C n / A`, :math:`\beta = 2 m g a / A` and
:math:`\omega` is the rate at which it is sent off, so that time and way of a nod follow by quadrature.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import quad

import carom
from carom.paper import style

g, m, arm, spin, C = 9.81, 1.0, 0.1, 180.0, 2e-3
A = C + m * arm**2  # moment about the foot, across the axle
b, beta = C * spin / A, 2 * m * g * arm / A


def nod(w):
    """Time of a nod and how far (rad) the axle has gone round, of a top sent off at the rate w."""
    p, q = (
        w**2 + b**2,
        2 * w * b - beta,
    )  # u'^2 = u (beta u^2 - p u + q) = beta u (u - low) (u - high)
    root = np.sqrt(p**2 - 4 * beta * q)
    low, high = (p - root) / (2 * beta), (p + root) / (2 * beta)

    def over(f):  # u = low sin^2 s
        return quad(lambda s: 4 * f(low * np.sin(s) ** 2) / np.sqrt(beta * (high - low * np.sin(s) ** 2)), 0, np.pi / 2)[0]  # fmt: skip

    return over(lambda u: 1.0), over(lambda u: (w - b * u) / (1 - u**2))


def top(w):
    scene = carom.Scene(gravity=(0, 0, -g))
    rate = np.array([spin, 0, w])
    body = scene.add_body(
        mass=m,
        inertia=(C, C, C),
        position=(arm, 0, 0),
        velocity=(0, w * arm, 0),
        angular_velocity=rate,
    )
    scene.add_joint(carom.joints.Spherical((0, 0, 0)), carom.GROUND, body)
    return carom.simulate(scene, 1.0, step=1e-3, method="rk8")


def main(out="out/examples"):
    with style.style():
        figure, rows = style.new(style.PAGE, 3.0, rows=3, sharex=True, sharey=True)
        for axes, w, colour, name in zip(
            rows,
            (-3.0, 0.0, 3.0),
            (style.RED, style.BLUE, style.GREEN),
            ("sent back", "let go", "sent on"),
        ):
            s, (time, way) = top(w), nod(w)
            x, y, z = s.position[:, 0].T / arm
            at = s.evaluate(time)[0][0] / arm
            error = max(abs(at[2]), abs(np.arctan2(at[1], at[0]) - way))
            print(
                f"{name}: a nod takes {time:.6f} s and {np.degrees(way):.4f} degrees; error {error:.0e}"
            )
            turn = np.degrees(np.unwrap(np.arctan2(y, x)))
            axes.plot(turn, np.degrees(np.arcsin(z)), color=colour)
            axes.plot(np.degrees(way), 0, "k.")
            axes.text(-9, -14, name, color=colour)
            assert error < 1e-8
        rows[1].set(ylabel="height of the axle / degrees")
        rows[2].set(xlabel="way round / degrees", xlim=(-10, 130), ylim=(-24, 6))
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "heavy_top.png", dpi=style.DPI)


if __name__ == "__main__":
    main()
