r"""A tippe top turns over and keeps its Jellett constant
=====================================================

A spinning ball whose mass centre is off its middle stands up on its head: friction of the slipping foot does
it. Whatever that friction does, the angular momentum along the line from the mass centre to the foot, :math:`J
= -\mathbf{L} \cdot \mathbf{a}`, stays what it is (Jellett, 1872).
"""

from pathlib import Path

import numpy as np

import carom
from carom.geometry import quaternion
from carom.visual.plots import style

g, radius, mass, offset = 9.81, 0.02, 0.02, 0.004
I = np.array([3.1e-6, 3.1e-6, 3.2e-6])  # about the mass centre


def main(out="out/examples"):
    scene = carom.Scene(gravity=(0, 0, -g))
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="table")
    stud = (carom.Sphere(1e-3), (0, 0, -offset))  # inside; it draws the mass centre down
    ball = carom.Compound([(carom.Sphere(radius), (0, 0, offset)), stud], masses=[1, 1])
    lean = 0.1
    top = scene.add_body(
        ball, mass=mass, inertia=I, position=(0, 0, radius - offset * np.cos(lean)), name="top",
        orientation=(np.cos(lean / 2), np.sin(lean / 2), 0, 0), angular_velocity=(0, 0, 150),
    )  # fmt: skip
    scene.add_contact(top, table, restitution=0.0, friction=0.3)
    s = carom.simulate(scene, 2.5, step=1e-3)

    up, jellett = np.array([0.0, 0.0, 1.0]), []
    q, w = s.orientation[:, 0], s.angular_velocity[:, 0]
    axis = np.array([quaternion.rotate(a, up) for a in q])
    for a, b, along in zip(q, w, axis):
        L = quaternion.rotate(a, I * quaternion.rotate_back(a, b))
        jellett.append(-L @ (offset * along - radius * up))
    change = np.ptp(jellett) / jellett[0]
    tilt = np.degrees(np.arccos(axis[:, 2]))
    print(
        f"its axis is at {tilt[-1]:.1f} degrees in the end; Jellett's constant kept to {change:.1e}"
    )

    with style.style():
        figure, (left, right) = style.new(style.PAGE, 2.4, columns=2)
        left.plot(s.t, tilt, color=style.BLUE)
        left.set(xlabel="time / s", ylabel="angle of its axis / degrees", ylim=(0, 180))
        right.plot(s.t, 1e3 * s.kinetic_energy, color=style.RED, label="kinetic")
        right.plot(s.t, -1e3 * s.ledger.friction, color=style.GREEN, label="taken by friction")
        rise = 1e3 * (s.potential_energy - s.potential_energy[0])
        right.plot(s.t, rise, color=style.BLUE, label="lifted")
        right.set(xlabel="time / s", ylabel="energy / mJ"), right.legend()
    Path(out).mkdir(parents=True, exist_ok=True)
    figure.savefig(Path(out) / "tippe_top.png", dpi=style.DPI)
    assert change < 1e-4
    assert tilt[-1] > 150


if __name__ == "__main__":
    main()
