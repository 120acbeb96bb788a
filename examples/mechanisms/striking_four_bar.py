r"""A closed loop that strikes
==========================

A parallelogram of rods tips over onto a stop in one of its hinges. All four are spatial (three rows are
redundant). With the angle a of the bars on the ground from upright, :math:`T = \frac{5}{6} \dot a^2` and
:math:`V = 2 g (\cos a - 1)`: the stop at a = 1.2 is first struck with :math:`\dot a^2 = 1 + \frac{12}{5} g (1 -
\cos 1.2)`, and throws back with e = 0.7. Its impulse reaches every hinge: both bars on the ground turn back at
once.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import carom

g, e, END = 9.81, 0.7, 1.2
out_of_plane = (0, 0, 1)


def mechanism():
    scene, J = carom.Scene(gravity=(0, -g, 0)), carom.joints
    upright, level = (1 / 12, 1e-3, 1 / 12), (1e-3, 1 / 12, 1 / 12)
    rows = ((0, 0.5, upright, 0.5, -1), (0.5, 1, level, 1.0, 0), (1, 0.5, upright, 0.5, -1))
    left, top, right = (
        scene.add_body(mass=1, inertia=inertia, position=(x, y, 0), velocity=(v, 0, 0),
                       angular_velocity=(0, 0, w))
        for x, y, inertia, v, w in rows
    )  # fmt: skip
    scene.add_joint(J.Revolute((0, 0, 0), out_of_plane), carom.GROUND, left, name="foot")
    scene.add_joint(J.Revolute((0, 1, 0), out_of_plane), left, top)
    stopped = scene.add_joint(J.Revolute((1, 1, 0), out_of_plane), top, right)
    scene.add_joint(J.Revolute((1, 0, 0), out_of_plane), carom.GROUND, right)
    scene.add_stop(stopped, lower=-END, restitution=e)
    return scene


def main(out="out/examples"):
    s = carom.simulate(mechanism(), 3.0, step=4e-3, method="rk8")
    hit, ledger = s.impacts, s.ledger
    speed = np.sqrt(1 + 12 / 5 * g * (1 - np.cos(END)))
    error = abs(-hit.relative_velocity_before[0, 0] - speed)
    kept = max(np.max(part) for part in s.constraint_errors)
    closed = np.max(np.abs(ledger.residual))
    print(f"{len(hit)} impacts; first at {-hit.relative_velocity_before[0, 0]:.9f} rad/s, error {error:.0e}; "
          f"ledger closes to {closed:.0e} J, joints to {kept:.0e}")  # fmt: skip

    figure = Figure(figsize=(6.5, 5.5), layout="constrained")
    angle, *energy = figure.subplots(3, 1, sharex=True, height_ratios=(2, 2, 1))
    angle.plot(s.t, -s.joint_coordinates("foot")[0], lw=1.2)
    angle.axhspan(END, 1.35, color="0.85")
    angle.set(ylabel="angle of the bars [rad]", ylim=(0, 1.35))
    carom.plots.energy(s, ax=energy)
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "striking_four_bar.png", dpi=150)
    assert max(error, closed, kept) < 1e-9


if __name__ == "__main__":
    main()
