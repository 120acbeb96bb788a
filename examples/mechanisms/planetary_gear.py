r"""A planetary gear
================

A sun, three planets on a carrier, and a fixed ring: two couplings for each planet, of which one in three would
do. The sun turns :math:`1 + z_r/z_s` times as fast as the carrier (Willis, 1841), and under a torque
:math:`\tau` the whole gains speed as one inertia,

.. math:: J = I_s + \left( I_c + 3 m a^2 + 3 I_p (1 - z_r/z_p)^2 \right) / (1 + z_r/z_s)^2 .
"""

from pathlib import Path

import numpy as np

import carom
from carom.visual.plots import style

z_s, z_p, z_r = 20, 16, 52  # teeth
module, m, torque = 2e-3, 0.05, 5e-3  # radius = module z / 2
a, ratio = module * (z_s + z_p) / 2, 1 + z_r / z_s
I_s, I_c, I_p, up = 2e-5, 3e-4, 6e-6, (0, 0, 1)


def main(out="out/examples"):
    scene = carom.Scene(gravity=(0, 0, 0))
    sun, carrier = (scene.add_body(mass=0.1, inertia=(I, I, I)) for I in (I_s, I_c))
    bearing = carom.joints.Revolute((0, 0, 0), up)
    shaft, output = (scene.add_joint(bearing, carom.GROUND, body) for body in (sun, carrier))
    around = 2 * np.pi / 3 * np.arange(3)
    for place in a * np.stack([np.cos(around), np.sin(around), 0 * around], axis=1):
        planet = scene.add_body(mass=m, inertia=(I_p, I_p, I_p), position=place)
        pin = scene.add_joint(carom.joints.Revolute(place, up), carrier, planet)
        scene.add_constraint(carom.constraints.Coupling({shaft: z_s, output: -z_s, pin: z_p}))
        scene.add_constraint(carom.constraints.Coupling({output: z_r, pin: z_p}))
    scene.add_force(carom.forces.JointForce(shaft, torque))
    s = carom.simulate(scene, 0.5, step=1e-3)
    sun_turn, turn = (s.joint_coordinates(n)[0][:, 0] for n in (shaft, output))
    J = I_s + (I_c + 3 * m * a**2 + 3 * I_p * (1 - z_r / z_p) ** 2) / ratio**2
    exact = torque * s.t**2 / (2 * J)
    error, slip = (np.max(np.abs(sun_turn - other)) for other in (exact, ratio * turn))
    print(scene.check())
    print(f"sun: {sun_turn[-1]:.6f} rad, error {error:.0e}; ratio {ratio:g} kept to {slip:.0e} rad")
    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.8, columns=2)
        spin = 2 * np.arctan2(*s.orientation[at := 300, :, [3, 0]])
        wheels = [(0, z_s, spin[0], style.RED), (0, z_r, np.pi / z_r, "k")]
        mesh = np.pi + around - (np.pi - z_s * around) / z_p  # a tooth in a gap of the sun
        wheels += [(2 + k, z_p, spin[2 + k] + mesh[k], style.BLUE) for k in range(3)]
        for k, z, turned, colour in wheels:
            b = np.linspace(0, 2 * np.pi, 40 * z)
            r = 1e3 * module * (z / 2 + 0.45 * np.tanh(4 * np.cos(z * (b - turned))))
            x, y = 1e3 * s.position[at, k, :2]
            left.plot(x + r * np.cos(b), y + r * np.sin(b), color=colour, lw=0.8)
        left.set(aspect="equal", xlabel="x / mm", ylabel="y / mm")
        right.plot(s.t, sun_turn / (2 * np.pi), color=style.RED, label="sun")
        right.plot(s.t, turn / (2 * np.pi), "k", label="carrier")
        right.plot(s.t[::50], exact[::50] / (2 * np.pi), ".", color=style.RED, label="closed form")
        right.set(xlabel="time / s", ylabel="turns"), right.legend()
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "planetary_gear.png", dpi=style.DPI)
    assert max(error, slip) < 1e-8


if __name__ == "__main__":
    main()
