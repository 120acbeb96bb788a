r"""Follow, stun and draw: a ball slides until it rolls
===================================================

A billiard ball is struck with top spin, none, or back spin. Friction acts until it rolls, at 5/7 of its speed
plus 2/7 of its spin times the radius, reached after :math:`\frac{2}{7} |v_0 - \omega_0 r| / (\mu g)` (Coriolis,
1835). With enough back spin it comes back. The instant at which slip ends is found in time, and friction is
then exactly zero.
"""

from pathlib import Path

import numpy as np

import carom
from carom.visual.plots import style

g, r, mu, v_0 = 9.81, 0.028, 0.2, 1.5
SHOTS = (("follow", 3.0, style.GREEN), ("stun", 0.0, style.BLUE), ("draw", -7.0, style.RED))


def shot(spin):
    scene = carom.Scene(gravity=(0, 0, -g))
    cloth = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="cloth")
    ball = scene.add_body(
        carom.Sphere(r), mass=0.17, position=(0, 0, r), velocity=(v_0, 0, 0),
        angular_velocity=(0, spin / r, 0), name="ball",
    )  # fmt: skip
    scene.add_contact(ball, cloth, restitution=0.5, friction=mu)
    return carom.simulate(scene, 2.0, step=0.01)


def main(out="out/examples"):
    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.5, columns=2)
        for name, spin, colour in SHOTS:  # spin: omega r [m/s]
            s = shot(spin)
            time, rolling = 2 / 7 * abs(v_0 - spin) / (mu * g), (5 * v_0 + 2 * spin) / 7
            way = v_0 * time - np.sign(v_0 - spin) * mu * g * time**2 / 2 + rolling * (2.0 - time)
            sticks = s.events.time[s.events.kind == "sticks"][0]
            error = max(
                abs(sticks - time),
                abs(s.velocity[-1, 0, 0] - rolling),
                abs(s.position[-1, 0, 0] - way),
            )
            print(
                f"{name:6} rolls from {sticks:.9f} s on at {s.velocity[-1, 0, 0]:+.6f} m/s, error {error:.0e}"
            )
            left.plot(s.t, s.position[:, 0, 0], color=colour, label=name)
            left.plot(time, s.evaluate(time)[0][0, 0], "o", color=colour)
            right.plot(s.t, s.velocity[:, 0, 0], color=colour)
            right.plot(s.t, r * s.angular_velocity[:, 0, 1], color=colour, ls="--")
            assert error < 1e-12
        left.set(xlabel="time / s", ylabel="way / m"), left.legend()
        right.set(
            xlabel="time / s",
            ylabel="m s$^{-1}$",
            title="speed (solid), spin times radius (dashed)",
        )
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "draw_shot.png", dpi=style.DPI)


if __name__ == "__main__":
    main()
