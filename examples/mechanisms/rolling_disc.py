r"""A wheel that rolls in a circle, and one that was pushed
=======================================================

A thin disc that rolls without slip goes round for ever at a constant lean, if its rates fit: with the lean
:math:`\alpha` from the vertical, the turning rate :math:`\Omega` and the radius :math:`\rho` of the circle of
its centre

.. math:: \Omega^2 \cos\alpha \left( 6 \rho + r \sin\alpha \right) = 4 g \sin\alpha .

Pushed, it wobbles about that motion and its foot draws a rosette; energy is kept, for the foot does no work.
"""

from pathlib import Path

import numpy as np

import carom
from carom.geometry import quaternion
from carom.visual.plots import style

g, r, m, alpha, rho = 9.81, 0.3, 1.0, np.radians(25), 0.6
up = np.array([0.0, 0.0, 1.0])
Omega = np.sqrt(4 * g * np.sin(alpha) / (np.cos(alpha) * (6 * rho + r * np.sin(alpha))))


def roll(push):
    spoke = r * np.array([-np.sin(alpha), 0, np.cos(alpha)])  # from the foot to the centre
    axle = np.array([np.cos(alpha), 0, np.sin(alpha)])
    spin = -Omega * (rho + r * np.sin(alpha)) / r  # so that the centre goes at Omega rho
    w = Omega * up + spin * axle + push * np.cross(axle, spoke) / r
    scene, half = carom.Scene(gravity=(0, 0, -g)), (np.pi / 2 - alpha) / 2
    wheel = scene.add_body(
        mass=m, inertia=m * r**2 * np.array([0.25, 0.25, 0.5]), position=(rho, 0, spoke[2]),
        orientation=(np.cos(half), 0, np.sin(half), 0), velocity=np.cross(w, spoke), angular_velocity=w,
    )  # fmt: skip
    scene.add_joint(carom.joints.RollingDisc(r, axle), carom.GROUND, wheel)
    return carom.simulate(scene, 10.0, step=5e-3)


def main(out="out/examples"):
    with style.style():
        figure, (left, right) = style.new(style.PAGE, 3.0, columns=2, width_ratios=(1, 1.2))
        for push, colour, name in ((0.6, style.RED, "pushed"), (0.0, style.BLUE, "steady")):
            s = roll(push)
            axle = np.array([quaternion.rotate(q, up) for q in s.orientation[:, 0]])
            lean = np.arcsin(axle[:, 2])
            level = axle[:, :2] / np.cos(lean)[:, None]
            foot = s.position[:, 0, :2] + r * np.sin(lean)[:, None] * level
            left.plot(*foot.T, color=colour, lw=0.8)
            right.plot(s.t, np.degrees(lean), color=colour, label=name)
            drift = np.ptp(s.total_energy)
            print(f"{name}: lean {np.degrees(np.min(lean)):.7f} to {np.degrees(np.max(lean)):.7f} degrees, "
                  f"energy kept to {drift:.0e} J")  # fmt: skip
            assert drift < 1e-7
        left.set(xlabel="x / m", ylabel="y / m", aspect="equal", title="path of the foot")
        right.set(xlabel="time / s", ylabel="lean / degrees", ylim=(17, 34)), right.legend(ncols=2)
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "rolling_disc.png", dpi=style.DPI)
    assert np.max(np.abs(lean - alpha)) < 1e-8
    assert np.max(np.abs(np.linalg.norm(foot, axis=1) - rho - r * np.sin(alpha))) < 1e-8


if __name__ == "__main__":
    main()
