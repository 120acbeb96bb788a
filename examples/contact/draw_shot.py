r"""Follow, stun and draw: a ball slides until it rolls
===================================================

A billiard ball starts with top spin, without spin, or with back spin. It slides at first, until friction has
made it roll; with enough back spin it comes back. The instant at which slip ends, the velocity and the place
at the end are compared with their closed form, to round-off.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, r, mu, v_0, T = 9.81, 0.028, 0.2, 1.5, 2.0
SHOTS = {"follow": 3.0, "stun": 0.0, "draw": -7.0}  # spin times radius [m/s]

# %%
# The ball touches the cloth from the start. Its velocity is always the same, its spin is not.


def shot(spin):
    scene = carom.Scene(gravity=(0, 0, -g))
    cloth = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="cloth")
    ball = scene.add_body(
        carom.Sphere(r), mass=0.17, position=(0, 0, r), velocity=(v_0, 0, 0),
        angular_velocity=(0, spin / r, 0), name="ball",
    )  # fmt: skip
    scene.add_contact(ball, cloth, restitution=0.5, friction=mu)
    return carom.simulate(scene, T, step=0.01)


# %%
# Friction is constant while the ball slides. It ends the slip after
# :math:`\frac{2}{7} |v_0 - \omega_0 r| / (\mu g)` (Coriolis, 1835). Then the ball rolls at
# :math:`\frac{5}{7} v_0 + \frac{2}{7} \omega_0 r`, and friction is exactly zero.


def exact(spin):
    time, rolling = 2 / 7 * abs(v_0 - spin) / (mu * g), (5 * v_0 + 2 * spin) / 7
    slid = v_0 * time - np.sign(v_0 - spin) * mu * g * time**2 / 2
    return np.array([time, rolling, slid + rolling * (T - time)])


# %%
# The event ``"sticks"`` is the end of slip. In the picture the velocity (solid) and the spin times the radius
# (dashed) meet there.


def main(out="out/examples"):
    with picture(f"{out}/draw_shot.png", columns=2) as (left, right):
        for (name, spin), colour in zip(SHOTS.items(), ("C2", "C0", "C1")):
            s = shot(spin)
            sticks = s.events.time[s.events.kind == "sticks"][0]
            found = np.array([sticks, s.velocity[-1, 0, 0], s.position[-1, 0, 0]])
            error = np.max(np.abs(found - exact(spin)))
            print(
                f"{name:6} rolls from {sticks:.9f} s on at {found[1]:+.6f} m/s, error {error:.0e}"
            )
            left.plot(s.t, s.position[:, 0, 0], colour, label=name)
            right.plot(s.t, s.velocity[:, 0, 0], colour)
            right.plot(s.t, r * s.angular_velocity[:, 0, 1], colour, ls="--")
            assert error < 1e-12
        left.set(xlabel="time / s", ylabel="place / m"), left.legend()
        right.set(xlabel="time / s", ylabel="velocity, spin times radius / m s$^{-1}$")


if __name__ == "__main__":
    main()
