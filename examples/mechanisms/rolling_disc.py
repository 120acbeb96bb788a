r"""A wheel that rolls in a circle, and one that was pushed
=======================================================

A thin disc can roll without slip in a circle for ever, with a constant lean. Pushed, it wobbles about this
motion, and its foot draws a rosette. The lean of the steady motion is compared with its closed form; the
energy of both is constant, because the foot does no work.
"""

import numpy as np

import carom
from carom.geometry import quaternion
from carom.visual.plots.style import picture

g, r, m, alpha, rho = 9.81, 0.3, 1.0, np.radians(25), 0.6
up = np.array([0.0, 0.0, 1.0])

# %%
# Let :math:`\alpha` be the lean from the vertical, :math:`\Omega` the rate about the vertical, and
# :math:`\rho` the radius of the circle of the centre. The motion is steady if
#
# .. math:: \Omega^2 \cos\alpha \left( 6 \rho + r \sin\alpha \right) = 4 g \sin\alpha .

Omega = np.sqrt(4 * g * np.sin(alpha) / (np.cos(alpha) * (6 * rho + r * np.sin(alpha))))

# %%
# A `RollingDisc` is a joint that forbids slip. The spin is such that the centre has the velocity
# :math:`\Omega \rho`. A push adds an angular velocity that changes the lean. The film shows the pushed wheel.


def roll(push):
    spoke = r * np.array([-np.sin(alpha), 0, np.cos(alpha)])  # from the foot to the centre
    axle = np.array([np.cos(alpha), 0, np.sin(alpha)])
    w = Omega * up - Omega * (rho + r * np.sin(alpha)) / r * axle + push * np.cross(axle, spoke) / r
    scene, half = carom.Scene(gravity=(0, 0, -g)), (np.pi / 2 - alpha) / 2
    scene.add_half_space(point=(0, 0, 0), normal=up, name="floor")
    wheel = scene.add_body(
        carom.Disc(r), mass=m, position=(rho, 0, spoke[2]), name="wheel", velocity=np.cross(w, spoke),
        angular_velocity=w, orientation=(np.cos(half), 0, np.sin(half), 0),
    )  # fmt: skip
    scene.add_joint(carom.joints.RollingDisc(r, axle), carom.GROUND, wheel)
    return carom.simulate(scene, 10.0, step=5e-3)


# %%
# From the orientation we find the lean, and from both the place of the foot.


def main(out="out/examples"):
    with picture(f"{out}/rolling_disc.png", height=3.0, columns=2, width_ratios=(1, 1.2)) as (
        left,
        right,
    ):
        for push, name in ((0.6, "pushed"), (0.0, "steady")):
            s = roll(push)
            axle = np.array([quaternion.rotate(q, up) for q in s.orientation[:, 0]])
            lean, drift = np.arcsin(axle[:, 2]), np.ptp(s.total_energy)
            foot = s.position[:, 0, :2] + r * np.tan(lean)[:, None] * axle[:, :2]
            left.plot(*foot.T, lw=0.8)
            right.plot(s.t, np.degrees(lean), label=name)
            low, high = np.degrees([np.min(lean), np.max(lean)])
            print(f"{name}: lean {low:.7f} to {high:.7f} degrees, energy kept to {drift:.0e} J")
            if push:
                carom.film(s, f"{out}/rolling_disc.gif", size=(400, 300), fps=15, end=3)
            assert drift < 1e-7
        left.set(xlabel="x / m", ylabel="y / m", aspect="equal", title="path of the foot")
        right.set(xlabel="time / s", ylabel="lean / degrees", ylim=(17, 34)), right.legend(ncols=2)
    assert np.max(np.abs(lean - alpha)) < 1e-8
    assert np.max(np.abs(np.linalg.norm(foot, axis=1) - rho - r * np.sin(alpha))) < 1e-8


if __name__ == "__main__":
    main()
