r"""The handle that turns over
==========================

A body that spins about its middle axis of inertia turns over, again and again. Dzhanibekov saw it in space in
1985 with a wing nut; a handle or a tennis racket does it, too. The motion is compared with the closed form of
Jacobi's elliptic functions.
"""

import numpy as np
from scipy.special import ellipj, ellipkinc

import carom
from carom.geometry import quaternion
from carom.visual.plots.style import picture

I = np.array([1.0, 2.0, 3.0])
w = np.array([0.01, 1.0, 0.01])  # nearly about the middle axis

# %%
# The body is a handle in the shape of a T. Nothing touches it, so the shape is only there to be seen, and the
# inertia is given. The handle spins about its stem, its middle axis, with a small error.


def spin():
    scene = carom.Scene(gravity=(0, 0, 0))
    bar, stem = (carom.Box(2.4, 0.4, 0.3), (0, 0.3, 0)), (carom.Box(0.3, 1.4, 0.3), (0, -0.6, 0))
    handle = carom.Compound([bar, stem], centroid=(0, 0, 0))
    scene.add_body(handle, mass=1.0, inertia=I, angular_velocity=w, name="handle")
    return carom.simulate(scene, 100.0, step=0.02)


# %%
# With :math:`I_1 < I_2 < I_3` and :math:`L^2 > 2 E I_2` the angular velocity in the axes of the body is
# (Landau and Lifshitz, *Mechanics*, section 37)
#
# .. math::
#    \omega_1 = a_1\,\mathrm{cn}\,\tau,\ \omega_2 = a_2\,\mathrm{sn}\,\tau,\ \omega_3 = a_3\,\mathrm{dn}\,\tau.
#
# The amplitudes and the rate of :math:`\tau` follow from energy and angular momentum at the start.


def exact(t):
    twice, square = I @ w**2, (I * w) @ (I * w)  # 2 E and L^2
    high, low = twice * I[2] - square, square - twice * I[0]
    a1, a2 = np.sqrt(high / (I[0] * (I[2] - I[0]))), np.sqrt(high / (I[1] * (I[2] - I[1])))
    a3 = np.sqrt(low / (I[2] * (I[2] - I[0])))
    m = (I[1] - I[0]) * high / ((I[2] - I[1]) * low)
    rate = np.sqrt((I[2] - I[1]) * low / np.prod(I))
    sn, cn, dn, _ = ellipj(rate * t + ellipkinc(np.arcsin(w[1] / a2), m), m)
    return np.stack([a1 * cn, a2 * sn, a3 * dn], axis=-1)


# %%
# A solution has angular velocities in world axes. We turn them into the axes of the body, and compare them
# with the closed form over 100 s. The film shows two of the turns, eight times as fast.


def main(out="out/examples"):
    s = spin()
    pairs = zip(s.orientation[:, 0], s.angular_velocity[:, 0])
    seen = np.array([quaternion.rotate_back(q, omega) for q, omega in pairs])
    error = np.max(np.abs(seen - exact(s.t)))
    print(f"angular velocity in body axes: error {error:.1e} rad/s of {w[1]:g} after 100 s")
    with picture(f"{out}/dzhanibekov.png") as axes:
        axes.plot(s.t, seen, label=[rf"$\omega_{k}$" for k in (1, 2, 3)])
        axes.plot(s.t[::100], exact(s.t[::100]), "k.", ms=2)
        axes.set(xlabel="time / s", ylabel="angular velocity / rad s$^{-1}$", ylim=(-1.1, 1.8))
        axes.legend(ncols=3, loc="upper center", title="lines: carom, dots: closed form")
    carom.film(s, f"{out}/dzhanibekov.gif", size=(320, 320), fps=15, speed=8, end=40)
    assert error < 1e-6


if __name__ == "__main__":
    main()
