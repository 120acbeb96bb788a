r"""A block rocks and loses a known part of its spin
================================================

A block rocks from one lower edge to the other, without bounce and without slip. At each impact it loses the
same part of its spin (Housner, 1963). No law of this kind is put in: the loss follows from plastic impacts at
the corners, and is compared with Housner's.
"""

import numpy as np

import carom
from carom.visual.plots.style import picture

g, b, h, tilt = 9.81, 0.1, 0.4, 0.5  # half width, half height, start as a part of alpha
alpha, R = np.arctan2(b, h), np.hypot(b, h)

# %%
# The block starts at rest on one edge, half as far from its unstable position as when it stands.


def rock():
    scene = carom.Scene(gravity=(0, 0, -g))
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    lean = tilt * alpha  # about the edge at x = b
    block = scene.add_body(
        carom.Box(2 * b, 2 * b, 2 * h), mass=50.0, name="block",
        position=R * np.array([-np.sin(alpha - lean), 0, np.cos(alpha - lean)]),
        orientation=(np.cos(lean / 2), 0, np.sin(lean / 2), 0),
    )  # fmt: skip
    scene.add_contact(block, floor, restitution=0.0, friction=1.0)
    return carom.simulate(scene, 6.0, step=1e-3)


# %%
# With :math:`\tan\alpha = b / h` the part of the spin that is left after an impact is
# :math:`1 - \frac{3}{2} \sin^2\alpha`. For small angles Housner also gives the time of the first impact, with
# R half the diagonal: :math:`\cosh\left(\sqrt{3 g / 4 R}\; t_1\right) = 1/(1 - \text{tilt})`.

kept = 1 - 1.5 * np.sin(alpha) ** 2
first = np.arccosh(1 / (1 - tilt)) / np.sqrt(3 * g / (4 * R))

# %%
# For each impact we evaluate the spin just before it and just after it.


def main(out="out/examples"):
    s = rock()
    times = np.unique(s.impacts.time)
    before, after = (s.evaluate(times, side)[3][:, 0, 1] for side in ("left", "right"))
    ratio = after / before
    error = np.max(np.abs(ratio[:8] - kept))
    print(f"{len(times)} impacts; each keeps {ratio[0]:.9f} of the spin, Housner {kept:.9f}")
    print(f"the first after {times[0]:.4f} s; Housner, small angles: {first:.4f} s")

    with picture(f"{out}/rocking_block.png", columns=2, width_ratios=(1.6, 1)) as (left, right):
        q = s.orientation[:, 0]
        left.plot(s.t, np.degrees(2 * np.arctan2(q[:, 2], q[:, 0])))
        left.plot(times, 0 * times, ".", label="impacts")
        left.set(xlabel="time / s", ylabel="lean / degrees"), left.legend(loc="upper right")
        k = np.arange(12)
        right.semilogy(k + 1, np.abs(before[:12]), "o", label="carom")
        right.semilogy(k + 1, abs(before[0]) * kept**k, "k", lw=0.8, label="Housner, 1963")
        right.set(xlabel="impact", ylabel="spin before it / rad s$^{-1}$"), right.legend()
    assert error < 1e-9
    assert abs(times[0] / first - 1) < 0.02


if __name__ == "__main__":
    main()
