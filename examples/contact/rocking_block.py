r"""A block rocks, and loses a known part of its spin each time
===========================================================

Housner (1963): a block that rocks from corner to corner, without bounce or slip, keeps the part :math:`1 -
\frac{3}{2} \sin^2\alpha` of its spin at each impact, where :math:`\tan\alpha = b / h`. Nothing of that is put
in: it follows from plastic impacts of two corners, one of which is let go.
"""

from pathlib import Path

import numpy as np

import carom
from carom.visual.plots import style

g, b, h, tilt = 9.81, 0.1, 0.4, 0.5  # half width, half height, start as a part of alpha
alpha, R = np.arctan2(b, h), np.hypot(b, h)
kept = 1 - 1.5 * np.sin(alpha) ** 2


def main(out="out/examples"):
    scene = carom.Scene(gravity=(0, 0, -g))
    floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    lean = tilt * alpha  # about the corner at x = b
    centre = R * np.array([-np.sin(alpha - lean), 0, np.cos(alpha - lean)])
    block = scene.add_body(
        carom.Box(2 * b, 2 * b, 2 * h), mass=50.0, position=centre,
        orientation=(np.cos(lean / 2), 0, np.sin(lean / 2), 0), name="block",
    )  # fmt: skip
    scene.add_contact(block, floor, restitution=0.0, friction=1.0)
    s = carom.simulate(scene, 6.0, step=1e-3)

    times = np.unique(s.impacts.time)
    spins = np.array(
        [[s.evaluate(t, side=side)[3][0, 1] for side in ("left", "right")] for t in times]
    )
    ratio = spins[:, 1] / spins[:, 0]
    first = np.arccosh(1 / (1 - tilt)) / np.sqrt(3 * g / (4 * R))  # of the linear equation
    error = np.max(np.abs(ratio[:8] - kept))
    print(
        f"{len(times)} impacts; each keeps {ratio[0]:.9f} of the spin, Housner {kept:.9f}, error {error:.0e}"
    )
    print(f"the first after {times[0]:.4f} s; Housner, small angles: {first:.4f} s")

    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.5, columns=2, width_ratios=(1.6, 1))
        q = s.orientation[:, 0]
        left.plot(s.t, np.degrees(2 * np.arctan2(q[:, 2], q[:, 0])), color=style.BLUE)
        left.set(xlabel="time / s", ylabel="lean / degrees")
        left.plot(times, 0 * times, "o", color=style.RED, ms=2.5, label="impacts")
        left.legend(loc="upper right")
        k = np.arange(12)
        right.semilogy(k + 1, np.abs(spins[:12, 0]), "o", color=style.RED, label="carom")
        right.semilogy(k + 1, abs(spins[0, 0]) * kept**k, "k", lw=0.8, label="Housner 1963")
        right.set(xlabel="impact", ylabel="spin before it / rad s$^{-1}$"), right.legend()
        right.set(yticks=[0.3, 0.5, 0.9], yticklabels=["0.3", "0.5", "0.9"])
        right.minorticks_off()
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "rocking_block.png", dpi=style.DPI)
    assert error < 1e-9
    assert abs(times[0] / first - 1) < 0.02


if __name__ == "__main__":
    main()
