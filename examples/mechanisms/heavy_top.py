r"""
A gyroscope, let go: it nods as it goes round
=============================================

A fast top with its axle level does not fall: it goes round, and nods in arches (cusps up) if it is let go at rest.
Its height :math:`u = \cos\theta` obeys :math:`\dot u^2 = f(u)` with a cubic f, so that the depth and the time of a nod are known by quadrature.
"""

from pathlib import Path

import numpy as np
from scipy.integrate import quad

import carom
from carom.paper import style

g, m, arm, spin = 9.81, 1.0, 0.1, 180.0
across, along = 2e-3 , 2e-3  # moments about the mass centre [kg m^2]


def nod(theta_0, rate):
    """Lowest u = cos theta and time of a nod, of a top let go with the precession `rate`."""


def main(out="out/examples"):
    A = across + m * arm**2
    for rate in (0.0,):
        scene = carom.Scene(gravity=(0, 0, -g))
        w = np.array([spin, 0, rate])
        top = scene.add_body(mass=m, inertia=(along, across, across), position=(arm, 0, 0), velocity=np.cross(w, [arm, 0, 0]), angular_velocity=w)
        scene.add_joint(carom.joints.Spherical((0, 0, 0)), carom.GROUND, top)
        s = carom.simulate(scene, 2.0, step=1e-3, method="rk8")
        p = s.position[:, 0] / arm
        print(p[:, 2].min(), np.degrees(np.unwrap(np.arctan2(p[:, 1], p[:, 0])))[-1])

if __name__ == "__main__":
    main()
