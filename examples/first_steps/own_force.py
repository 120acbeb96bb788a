r"""A force of your own: a ball with backspin loops the loop
========================================================

Drag and Magnus force, by a function that Numba compiles. With :math:`u = \dot x + \mathrm{i} \dot z` and
:math:`\lambda = -\gamma + \mathrm{i} \Omega` both are linear, with :math:`u_\infty = \mathrm{i} g / \lambda`:

.. math:: \dot u = \lambda u - \mathrm{i} g, \qquad u = u_\infty + (u_0 - u_\infty)\, e^{\lambda t}.
"""

from pathlib import Path

import numba
import numpy as np

import carom
from carom.visual.plots import style

g, mass, drag, lift = 9.81, 0.0027, 0.7, 0.03  # a table tennis ball; [1/s], and by spin [1]
start = 14 * np.exp(0.3j)  # [m/s]


@numba.njit
def air(t, states):
    wrench = np.zeros((1, 6))  # force and torque
    v, w = states[0, 7:10], states[0, 10:13]
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        wrench[0, i] = mass * (-drag * v[i] + lift * (w[j] * v[k] - w[k] * v[j]))
    return wrench


def fly(spin):
    scene = carom.Scene(gravity=(0, 0, -g))
    ball = scene.add_body(
        mass=mass, inertia=3 * [2 / 3 * mass * 0.02**2], position=(0, 0, 2),
        velocity=(start.real, 0, start.imag), angular_velocity=(0, -spin, 0),
    )  # fmt: skip
    scene.add_force(carom.forces.UserForce(ball, air))
    return carom.simulate(scene, 1.7, step=2e-3, method="rk5")


def exact(t, spin):
    final = 1j * g / (rate := -drag + 1j * lift * spin)
    return 2j + final * t + (start - final) * (np.exp(rate * t) - 1) / rate


def main(out="out/examples"):
    errors = []
    with style.style():
        figure, axes = style.new(style.PAGE, 3.0)
        for spin, colour in ((0, style.GREY), (50, style.GREEN), (100, style.RED)):
            true = exact((s := fly(spin)).t, spin)
            path = s.position[:, 0, 0] + 1j * s.position[:, 0, 2]
            errors.append(np.max(np.abs(path - true)))
            axes.plot(path.real, path.imag, color=colour, label=f"{spin} rad/s")
            axes.plot(true[::50].real, true[::50].imag, "o", ms=2.5, color=colour)
        axes.set(xlabel="x / m", ylabel="height / m", aspect="equal")
        axes.legend(title="backspin", loc="center left", bbox_to_anchor=(1.0, 0.5))
    print(f"place, at all times up to 1.7 s: error {max(errors):.1e} m")
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "own_force.png", dpi=style.DPI)
    assert max(errors) < 1e-9


if __name__ == "__main__":
    main()
