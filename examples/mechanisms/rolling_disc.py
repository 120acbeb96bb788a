r"""
A wheel that rolls in a circle, and one that has been pushed
============================================================

A disc that rolls without slip can lean at a constant angle and go round for ever, if its rates fit: with the lean
:math:`\alpha` from the vertical, turning rate :math:`\Omega` and radius of the circle :math:`\rho` of its centre

.. math:: \Omega^2 \left( 6 \rho \cos\alpha + r \sin\alpha \cos\alpha \right) = 4 g \sin\alpha .

Pushed a little it wobbles about that, and its foot draws a rosette. A ball would do neither.
"""

from pathlib import Path

import numpy as np

import carom
from carom.geometry import quaternion
from carom.paper import style

g, r, m, alpha, rho = 9.81, 0.3, 1.0, np.radians(25), 0.6


def roll(push, duration=8.0):
    Omega = np.sqrt(4 * g * np.sin(alpha) / (np.cos(alpha) * (6 * rho + r * np.sin(alpha))))
    # the centre at (rho, 0), going along y, the top leaning inwards; u points from the foot to the centre
    u = np.array([-np.sin(alpha), 0, np.cos(alpha)])
    axis = np.array([np.cos(alpha), 0, np.sin(alpha)])
    v = np.array([0, rho * Omega, 0])
    # v = w x r u, with w = Omega z + s axis
    z = np.array([0, 0, 1.0])
    s = (v[1] - np.cross(Omega * z, r * u)[1]) / np.cross(axis, r * u)[1]
    w = Omega * z + s * axis
    push_w = push * np.cross(axis, u)
    scene = carom.Scene(gravity=(0, 0, -g))
    turn = (np.pi / 2 - alpha) / 2
    wheel = scene.add_body(mass=m, inertia=(m * r**2 / 4, m * r**2 / 4, m * r**2 / 2), position=(rho, 0, r * np.cos(alpha)),
        orientation=(np.cos(turn), 0, np.sin(turn), 0), velocity=np.cross(w + push_w, r * u), angular_velocity=w + push_w)
    scene.add_joint(carom.joints.RollingDisc(r, axis), carom.GROUND, wheel)
    return carom.simulate(scene, duration, step=5e-3)


def main(out="out/examples"):
    for push in (0.0, 0.6):
        s = roll(push)
        a = np.array([quaternion.rotate(q, np.array([0, 0, 1.0])) for q in s.orientation[:, 0]])
        lean = np.degrees(np.arcsin(a[:, 2]))
        print(lean[::100], np.hypot(*s.position[::100, 0, :2].T), np.ptp(s.total_energy))

if __name__ == "__main__":
    main()
