r"""
A force of your own: a ball with backspin loops the loop
========================================================

Drag and Magnus force, as a function that Numba compiles. With both linear in the velocity, the
velocity :math:`u = \dot x + \mathrm{i} \dot z` has a closed form: with :math:`\lambda = -\gamma + \mathrm{i} \Omega`,

.. math:: \dot u = \lambda u - \mathrm{i} g, \qquad u = u_\infty + (u_0 - u_\infty)\, e^{\lambda t}, \qquad u_\infty = \mathrm{i} g / \lambda .
"""

from pathlib import Path

import numba
import numpy as np

import carom
from carom.paper import style

g, mass, drag, lift = 9.81, 0.0027, 0.7, 0.03  # a table tennis ball; [1/s], and by spin [1]
start = 14 * np.exp(0.3j)  # [m/s]


@numba.njit
def air(t, states):
    wrench = np.zeros((1, 6))  # force and torque
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        v, w = states[0, 7:10], states[0, 10:13]
        wrench[0, i] = mass * (-drag * v[i] + lift * (w[j] * v[k] - w[k] * v[j]))
    return wrench


def fly(spin):
    scene = carom.Scene(gravity=(0, 0, -g))
    ball = scene.add_body(
        mass=mass, inertia=3 * [2 / 3 * mass * 0.02**2], position=(0, 0, 2),
        velocity=(start.real, 0, start.imag), angular_velocity=(0, -spin, 0),
    )  # fmt: skip
    scene.add_force(carom.forces.UserForce(ball, air))
    return carom.simulate(scene, 2.0, step=2e-3, method="rk5")


def exact(t, spin):
    rate = -drag + 1j * lift * spin
    final = 1j * g / rate
    return 2j + final * t + (start - final) * (np.exp(rate * t) - 1) / rate


def main(out="out/examples"):
    errors = []
    with style.style():
        figure, axes = style.new(style.PAGE, 3.0)
        for spin, colour in (
            (0, style.GREY),
            (60, style.GREEN),
            (120, style.BLUE),
            (240, style.RED),
        ):
            s = fly(spin)
            true = exact(s.t, spin)
            path = s.position[:, 0, 0] + 1j * s.position[:, 0, 2]
            errors.append(np.max(np.abs(path - true)))
            axes.plot(path.real, path.imag, color=colour, label=f"{spin} rad/s")
            axes.plot(true[::20].real, true[::20].imag, "o", ms=2.5, color=colour)
        print(f"place after up to 2 s: error {max(errors):.1e} m")
        axes.set(xlabel="x / m", ylabel="height / m", aspect="equal")
        axes.legend(title="backspin", loc="center left", bbox_to_anchor=(1.0, 0.5))
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "own_force.png", dpi=style.DPI)
    assert max(errors) < 1e-9


if __name__ == "__main__":
    main()
