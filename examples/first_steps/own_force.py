r"""A force of your own: a ball with backspin loops the loop
========================================================

A fast table tennis ball with backspin rises, and with enough spin it flies a loop. Drag and Magnus force are
a function of yours, which Numba compiles. The path is compared with its closed form.
"""

import numba
import numpy as np

import carom
from carom.visual.plots.style import picture

g, mass, drag, lift = 9.81, 0.0027, 0.7, 0.03  # a table tennis ball; [1/s], and by spin [1]
start = 14 * np.exp(0.3j)  # [m/s]

# %%
# The function gets time and states of the bodies, and returns force and torque of each. The drag is against
# the velocity v, the Magnus force is along :math:`\omega \times v`.


@numba.njit
def air(t, states):
    wrench = np.zeros((1, 6))  # force and torque
    v, w = states[0, 7:10], states[0, 10:13]
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        wrench[0, i] = mass * (-drag * v[i] + lift * (w[j] * v[k] - w[k] * v[j]))
    return wrench


# %%
# The force is added to the scene like those that carom has.


def fly(spin):
    scene = carom.Scene(gravity=(0, 0, -g))
    ball = scene.add_body(
        mass=mass, inertia=3 * [2 / 3 * mass * 0.02**2], position=(0, 0, 2),
        velocity=(start.real, 0, start.imag), angular_velocity=(0, -spin, 0),
    )  # fmt: skip
    scene.add_force(carom.forces.UserForce(ball, air))
    return carom.simulate(scene, 1.7, step=2e-3, method="rk5")


# %%
# Both forces are linear in the velocity. With :math:`u = \dot x + \mathrm{i} \dot z`,
# :math:`\lambda = -\gamma + \mathrm{i} \Omega` and :math:`u_\infty = \mathrm{i} g / \lambda` we have
#
# .. math:: \dot u = \lambda u - \mathrm{i} g, \qquad u = u_\infty + (u_0 - u_\infty)\, e^{\lambda t},
#
# and the place is the integral of u.


def exact(t, spin):
    final = 1j * g / (rate := -drag + 1j * lift * spin)
    return 2j + final * t + (start - final) * (np.exp(rate * t) - 1) / rate


# %%
# Three balls, which differ in spin: the one without spin falls, the one with most spin loops.


def main(out="out/examples"):
    errors = []
    with picture(f"{out}/own_force.png", height=3.0) as axes:
        for spin in (0, 50, 100):
            true = exact((s := fly(spin)).t, spin)
            path = s.position[:, 0, 0] + 1j * s.position[:, 0, 2]
            errors.append(np.max(np.abs(path - true)))
            axes.plot(path.real, path.imag, label=f"{spin} rad/s")
            axes.plot(true[::50].real, true[::50].imag, "k.")
        axes.set(xlabel="x / m", ylabel="height / m", aspect="equal")
        axes.legend(title="backspin", loc="lower left")
    print(f"place, at all times up to 1.7 s: error {max(errors):.1e} m")
    assert max(errors) < 1e-9


if __name__ == "__main__":
    main()
