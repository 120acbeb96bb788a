r"""The wing nut that turns over
============================

A body that spins about its middle axis of inertia turns over, again and again (Dzhanibekov, 1985; the tennis
racket). With :math:`I_1 < I_2 < I_3` and :math:`L^2 > 2 E I_2` the motion is known in Jacobi's elliptic
functions (Landau and Lifshitz, *Mechanics*, section 37):

.. math::
   \omega_1 = a_1\,\mathrm{cn}\,\tau,\ \omega_2 = a_2\,\mathrm{sn}\,\tau,\ \omega_3 = a_3\,\mathrm{dn}\,\tau.
"""

from pathlib import Path

import numpy as np
from scipy.special import ellipj, ellipkinc

import carom
from carom.geometry import quaternion
from carom.visual.plots import style

I = np.array([1.0, 2.0, 3.0])
w = np.array([0.01, 1.0, 0.01])  # nearly about the middle axis


def exact(t):
    twice, square = I @ w**2, (I * w) @ (I * w)  # 2 E and L^2
    high, low = twice * I[2] - square, square - twice * I[0]
    a1, a2 = np.sqrt(high / (I[0] * (I[2] - I[0]))), np.sqrt(high / (I[1] * (I[2] - I[1])))
    a3 = np.sqrt(low / (I[2] * (I[2] - I[0])))
    m = (I[1] - I[0]) * high / ((I[2] - I[1]) * low)
    rate = np.sqrt((I[2] - I[1]) * low / np.prod(I))
    sn, cn, dn, _ = ellipj(rate * t + ellipkinc(np.arcsin(w[1] / a2), m), m)
    return np.stack([a1 * cn, a2 * sn, a3 * dn], axis=-1)


def main(out="out/examples"):
    scene = carom.Scene(gravity=(0, 0, 0))
    scene.add_body(mass=1.0, inertia=I, angular_velocity=w, name="nut")
    solution = carom.simulate(scene, 100.0, step=0.02)

    attitude = solution.orientation[:, 0]
    seen = np.array(
        [quaternion.rotate_back(*row) for row in zip(attitude, solution.angular_velocity[:, 0])]
    )
    momentum = I * w / np.linalg.norm(I * w)
    points = np.array([quaternion.rotate_back(q, momentum)[1] for q in attitude])
    error = np.max(np.abs(seen - exact(solution.t)))
    print(f"angular velocity in body axes: error {error:.1e} rad/s of {w[1]:g} after 100 s")

    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.4, columns=2)
        for k, colour in enumerate((style.RED, style.BLUE, style.GREEN)):
            left.plot(solution.t, seen[:, k], color=colour, label=rf"$\omega_{k + 1}$")
            left.plot(solution.t[::100], exact(solution.t[::100])[:, k], ".", color=colour)
        left.set(xlabel="time / s", ylabel="angular velocity / rad s$^{-1}$", ylim=(-1.1, 1.8))
        left.legend(ncols=3, loc="upper center", title="lines: carom, dots: closed form")
        right.plot(solution.t, points, color=style.BLUE)
        right.set(xlabel="time / s", ylabel="cosine: axis 2, momentum", ylim=(-1.1, 1.1))
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "dzhanibekov.png", dpi=style.DPI)
    assert error < 1e-6


if __name__ == "__main__":
    main()
