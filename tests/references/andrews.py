"""Andrews' squeezing mechanism in absolute coordinates, from the published minimal ones.

Seven plane bodies (IVP test set; Hairer and Wanner II), no gravity, a motor torque on body 1, one
spring. All angles in the x-y plane, turning about +z, SI units. With the published angles
q = (beta, Theta, gamma, Phi, delta, Omega, epsilon), c(x) = (cos x, sin x),
s(x) = (sin x, -cos x)::

    fixed points   O = (0, 0)   A = (xa, ya)   B = (xb, yb)   spring's fixed end C = (xc, yc)
    F = rr c(beta)                               body 1 (OF): turns with beta
    E = F - d c(beta + Theta)                    body 2 (FE): turns with beta + Theta
    E = B + ss s(gamma)                          body 3 (BE D): turns with gamma
    D = B + sc s(gamma) + sd c(gamma)            spring from C to D
    G = A + zt c(delta)                          body 5 (AG): turns with delta
    E = G + e s(Phi + delta)                     body 4 (GE): turns with Phi + delta
    H = A + u s(epsilon)                         body 7 (AH): turns with epsilon
    E = H + zf c(Omega + epsilon)                body 6 (HE): turns with Omega + epsilon

Three closures (E of bodies 3, 4, 6 = E of body 2) are the six published constraints. Mass centres
of bodies 1, 2, 4, 6 are on the line of the joints; of 3, 5, 7, which turn about fixed points, the
published equations hold only the distance from that point: the side is a choice that changes no
motion (it does change the reactions).
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

PARAMETERS = json.loads((Path(__file__).parents[1] / "data" / "andrews.json").read_text())
BODIES = ("K1", "K2", "K3", "K4", "K5", "K6", "K7")


def _c(x):
    return np.array([np.cos(x), np.sin(x)])


def _s(x):
    return np.array([np.sin(x), -np.cos(x)])


def points(q, p=None):
    """Return the joints and the spring's ends in the plane, each (2,); E as body 2 carries it."""
    p = p or PARAMETERS["params"]
    beta, theta, gamma, _, delta, _, epsilon = q
    A, B = np.array([p["xa"], p["ya"]]), np.array([p["xb"], p["yb"]])
    F = p["rr"] * _c(beta)
    return dict(
        O=np.zeros(2), A=A, B=B, C=np.array([p["xc"], p["yc"]]), F=F,
        E=F - p["d"] * _c(beta + theta),
        D=B + p["sc"] * _s(gamma) + p["sd"] * _c(gamma),
        G=A + p["zt"] * _c(delta),
        H=A + p["u"] * _s(epsilon),
    )  # fmt: skip


def centres(q, p=None):
    """Return mass centres (7, 2) and angles (7,) of the bodies."""
    p = p or PARAMETERS["params"]
    at = points(q, p)
    beta, theta, gamma, phi, delta, omega, epsilon = q
    centre = np.array(
        [
            p["ra"] * _c(beta),
            at["F"] - p["da"] * _c(beta + theta),
            at["B"] + p["sa"] * _s(gamma) + p["sb"] * _c(gamma),
            at["G"] + (p["e"] - p["ea"]) * _s(phi + delta),
            at["A"] + p["ta"] * _c(delta) - p["tb"] * _s(delta),
            at["H"] + (p["zf"] - p["fa"]) * _c(omega + epsilon),
            at["A"] + p["ua"] * _s(epsilon) - p["ub"] * _c(epsilon),
        ]
    )
    angle = [beta, beta + theta, gamma, phi + delta, delta, omega + epsilon, epsilon]
    return centre, np.array(angle)


def closures(q, p=None):
    """Return the six constraints: E of bodies 3, 4, 6 against E of body 2."""
    p = p or PARAMETERS["params"]
    at = points(q, p)
    _, _, gamma, phi, delta, omega, epsilon = q
    others = (
        at["B"] + p["ss"] * _s(gamma),
        at["G"] + p["e"] * _s(phi + delta),
        at["H"] + p["zf"] * _c(omega + epsilon),
    )
    return np.concatenate([at["E"] - E for E in others])


def andrews_data() -> dict:
    """Return the mechanism at t = 0 in absolute coordinates, as plain numbers and names.

    Returns
    -------
    dict
        ``bodies``: list of name, mass [kg], inertia about z through the mass centre [kg m^2],
        centre (x, y) [m], angle about z [rad]; all at rest. ``joints``: list of name, parent, child
        ("ground" or a body), anchor (x, y); all are revolutes about z. ``spring``: stiffness, rest
        length, the ground point, the body and its point in the world. ``torque``: value about z
        [N m] and body (constant, reaction on the ground). ``minimal``: the published angles at
        t = 0 (7).
        ``reference``: angles, rates and accelerations (7 each) at ``t_end``, as published.
    """
    p, q = PARAMETERS["params"], np.array(PARAMETERS["q0"])
    at = {name: value.tolist() for name, value in points(q).items()}
    centre, angle = centres(q)
    joints = [
        ("O", "ground", "K1"), ("F", "K1", "K2"), ("B", "ground", "K3"), ("E", "K2", "K3"),
        ("E", "K2", "K4"), ("E", "K2", "K6"), ("G", "K5", "K4"), ("A", "ground", "K5"),
        ("H", "K7", "K6"), ("A", "ground", "K7"),
    ]  # fmt: skip
    return dict(
        bodies=[
            dict(
                name=name, mass=p[f"m{k}"], inertia=p[f"i{k}"],
                centre=centre[k - 1].tolist(), angle=float(angle[k - 1]),
            )
            for k, name in enumerate(BODIES, 1)
        ],
        joints=[
            dict(name=f"{point}-{parent}-{child}", parent=parent, child=child, anchor=at[point])
            for point, parent, child in joints
        ],
        spring=dict(
            stiffness=p["c0"], length=p["l0"], ground_point=at["C"], body="K3", body_point=at["D"]
        ),
        torque=dict(body="K1", value=p["mom"]),
        minimal=q.tolist(),
        t_end=PARAMETERS["t_end"],
        reference=dict(
            angles=PARAMETERS["reference"][:7],
            rates=PARAMETERS["reference"][7:14],
            accelerations=PARAMETERS["reference"][14:21],
        ),
    )  # fmt: skip


def minimal_from_absolute(angle):
    """Return the published angles (7,) from the bodies' angles about z (7,), unwrapped."""
    k1, k2, k3, k4, k5, k6, k7 = angle
    return np.array([k1, k2 - k1, k3, k4 - k5, k5, k6 - k7, k7])
