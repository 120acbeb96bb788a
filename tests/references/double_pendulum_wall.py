"""The tip of a double pendulum strikes a wall with friction: two coordinates, scipy only.

Two uniform rods (length 1 m, mass 1 kg), hinged at the origin and at each other, in the plane
y = 0, gravity 9.81 m/s^2 along -z. Coordinates: the angles a, b of the rods from the downward
vertical, positive towards +x: rod 1 ends at (sin a, 0, -cos a), rod 2 adds (sin b, 0, -cos b). A
rod's angular velocity is -da/dt (or -db/dt) about +y. Released from rest. The wall is the plane
x = X with all free space at x < X: normal n = (-1, 0, 0), tangents t1 = (0, 0, 1), t2 = (0, 1, 0).
The hinges hold the tip in the plane, so the third row and column of W are zero.

Run this file to write ``tests/data/double_pendulum_wall.json`` again.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from references.planar_routh import impact

G, AFTER = 9.81, 0.2
DATA = Path(__file__).parents[1] / "data" / "double_pendulum_wall.json"
CASES = {  # degrees, m
    "slip": dict(a0=-75.0, b0=30.0, wall=-0.2, friction=0.2, restitution=0.5),
    "reversal": dict(a0=-60.0, b0=0.0, wall=0.3, friction=0.3, restitution=0.5),
    "stick": dict(a0=-75.0, b0=30.0, wall=0.8, friction=0.6, restitution=0.6),
    "frictionless elastic": dict(a0=-60.0, b0=-30.0, wall=1.2, friction=0.0, restitution=1.0),
}


def mass(q):
    """M = [[m l^2 (1/3 + 1), c], [c, m l^2/3]] with c = m l^2 cos(a - b)/2."""
    c = 0.5 * np.cos(q[0] - q[1])
    return np.array([[4.0 / 3.0, c], [c, 1.0 / 3.0]])


def rates(t, y):
    """Lagrange's equations, solved for the accelerations."""
    a, b, da, db = y
    s = 0.5 * np.sin(a - b)
    force = [-s * db * db - 1.5 * G * np.sin(a), s * da * da - 0.5 * G * np.sin(b)]
    return [da, db, *np.linalg.solve(mass(y[:2]), force)]


def energy(y):
    """Kinetic and potential energy [J], zero potential at the hinge."""
    potential = -G * (1.5 * np.cos(y[0]) + 0.5 * np.cos(y[1]))
    return 0.5 * y[2:] @ mass(y[:2]) @ y[2:] + potential


def tip(q):
    """Place of the tip (x, y, z)."""
    return np.array([np.sin(q[0]) + np.sin(q[1]), 0.0, -np.cos(q[0]) - np.cos(q[1])])


def contact_rows(q):
    """J (2, 2): the tip's velocity along n = -x and t1 = z from the two rates."""
    return np.array([-np.cos(q), np.sin(q)])


def rods(y):
    """Return for each rod centre, its velocity, the turn about +y from hanging, its rate.

    A rod is uniform: mass 1, inertia 1/12 about any axis through its centre and normal to it.
    """
    out, joint, drift = [], np.zeros(3), np.zeros(3)
    for angle, rate in zip(y[:2], y[2:]):
        along = np.array([np.sin(angle), 0.0, -np.cos(angle)])
        swing = rate * np.array([np.cos(angle), 0.0, np.sin(angle)])
        out.append((joint + 0.5 * along, drift + 0.5 * swing, -angle, -rate))
        joint, drift = joint + along, drift + swing
    return out


def integrate(y, duration, rtol=2.3e-14):
    """Return the state after `duration`."""
    return _solve(y, duration, rtol).y[:, -1]


def first_impact(case, rtol=2.3e-14):
    """Return time and state at which the tip first reaches the wall."""

    def gap(t, y):
        return case["wall"] - np.sin(y[0]) - np.sin(y[1])

    gap.terminal = True
    start = [np.radians(case["a0"]), np.radians(case["b0"]), 0.0, 0.0]
    run = _solve(start, 2.0, rtol, gap)
    t, y = run.t_events[0][0], run.y_events[0][0]
    for _ in range(3):  # Newton on the gap, with exact short integrations
        step = gap(t, y) / (np.cos(y[:2]) @ y[2:])
        y, t = (integrate(y, step) if step else y), t + step
    return t, y


def strike(case, y, law):
    """Return the impact and the rates after it: ``dq+ = dq- + M^-1 J^T P``."""
    J, M = contact_rows(y[:2]), mass(y[:2])
    W = J @ np.linalg.solve(M, J.T)
    result = impact(W, J @ y[2:], case["friction"], case["restitution"], law)
    return W, result, y[2:] + np.linalg.solve(M, J.T @ result["impulse"])


def compute(case):
    """Return everything about one case, in plain numbers."""
    t, y = first_impact(case)
    J = contact_rows(y[:2])
    W = strike(case, y, "newton")[0]
    out = dict(
        input=case,
        impact_time=t,
        angles=y[:2].tolist(),
        rates_before=y[2:].tolist(),
        tip=tip(y[:2]).tolist(),
        inverse_mass=np.pad(W, (0, 1)).tolist(),
        contact_velocity_before=[*(J @ y[2:]), 0.0],
        energy_before=energy(y),
        laws={},
    )
    for law in ("newton", "poisson", "stronge"):
        result, after = strike(case, y, law)[1:]
        end = integrate(np.array([*y[:2], *after]), AFTER)
        out["laws"][law] = dict(
            slip=result["slip"],
            rates_after=after.tolist(),
            contact_velocity_after=[*result["velocity"], 0.0],
            impulse=[*result["impulse"], 0.0],
            compression_impulse=result["compression_impulse"],
            compression_work=result["compression_work"],
            restitution_work=result["restitution_work"],
            energy_change=energy(np.array([*y[:2], *after])) - energy(y),
            angles_end=end[:2].tolist(),
            rates_end=end[2:].tolist(),
            tip_end=tip(end[:2]).tolist(),
        )
    return out


def _solve(y, duration, rtol, events=None):
    return solve_ivp(
        rates, (0.0, duration), y, "DOP853", rtol=rtol, atol=1e-15, max_step=0.01, events=events
    )


def main():
    """Write the data file."""
    cases = {name: compute(case) for name, case in CASES.items()}
    made = (
        "tests/references/double_pendulum_wall.py: Lagrange's equations in two angles, DOP853 of "
        "scipy, rtol 2.3e-14, max_step 0.01 s, event refined by Newton; impact by Routh's closed "
        f"form; then {AFTER} s of free motion. Conventions in that file. Good to 1e-12."
    )
    DATA.parent.mkdir(exist_ok=True)
    rod = dict(length=1.0, mass=1.0, inertia=1.0 / 12.0)
    data = dict(made_by=made, rod=rod, gravity=G, after=AFTER, cases=cases)
    DATA.write_text(json.dumps(data, indent=1) + "\n")


if __name__ == "__main__":
    main()
