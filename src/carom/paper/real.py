"""First impacts of a real cube: the impact laws against motion capture.

Data: 285 tosses of an acrylic cube at 148 Hz (ContactNets, Pfrommer, Halm and Posa 2020; licence
beside the file), cut to the first impact of each toss: the state one sample before the first
sample at which a corner is at the table or below, and the state three samples after that sample. Velocities
are backward differences, so they belong to a time half a sample earlier; attitudes belong to the sample.

Assumptions:

- only clean impacts count: the second-lowest corner is at least 15 mm above the table;
- the corner reaches the table within the sample interval, dt + z/|u_n| after its beginning, where z is its
  height at the end (not above zero); the attitude at that time follows with constant angular velocity;
- gravity acts all the time: before the impact on the approach, after it on the measured velocities. There are
  four samples between the two recorded velocities.
"""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import NamedTuple

import numpy as np

import carom
from carom.geometry import quaternion

GRAVITY, DT = 9.81, 1.0 / 148.0
MASS, INERTIA, HALF = 0.37, 8.1e-4, 0.0524  # [kg], [kg m^2], [m]
NOMINAL = (0.125, 0.18)  # e, mu: drop test and tilt test by the authors of the data
LAWS = ("newton", "poisson", "stronge")
CLEAN = 0.015  # least height of the second corner [m]
SAMPLES_BETWEEN = 4  # samples between the two recorded velocities

_AXES = np.array([[0, 0, 1.0], [1, 0, 0], [0, 1, 0]])  # n, t1, t2
_CORNERS = HALF * np.array(np.meshgrid(*[(-1, 1)] * 3)).reshape(3, 8).T
_INVERSE = np.repeat((1.0 / MASS, 1.0 / INERTIA), 3)


class Tosses(NamedTuple):
    """K impacts, all in world axes."""

    toss: np.ndarray  # (K,) number of the toss
    before: np.ndarray  # (K, 6) v [m/s], w [rad/s] at the impact
    after: np.ndarray  # (K, 6) measured, `flight` later
    attitude: np.ndarray  # (K, 4) at the impact
    height: np.ndarray  # (K,) height of the centre at the impact [m]
    jacobian: np.ndarray  # (K, 3, 6) G of the corner that strikes
    flight: np.ndarray  # (K,) time from the impact to the measured velocity [s]


@cache
def load() -> Tosses:
    """Read the clean single-corner impacts and build the state just before each."""
    path = files("carom.paper") / "data" / "first_impacts_even.csv"
    with path.open(encoding="utf-8") as file:
        table = np.genfromtxt(file, delimiter=",", names=True)
    table = table[table["gap_to_2nd_corner"] > CLEAN]

    def columns(when, names):
        return np.stack([table[f"{when}_{name}"] for name in names.split()], axis=1)

    q, q_after = (quaternion.normalize(columns(w, "qw qx qy qz")) for w in ("pre", "post"))
    v, v_after = (columns(w, "vx vy vz") for w in ("pre", "post"))
    w, w_after = (columns(w, "wxb wyb wzb") for w in ("pre", "post"))
    w, w_after = quaternion.rotate(q, w), quaternion.rotate(q_after, w_after)

    since = np.full(len(table), DT)  # time from the earlier sample to the impact
    for _ in range(3):  # the approach speed depends slightly on the corner
        now = quaternion.multiply(quaternion.exp(w * since[:, None]), q)
        arms = np.einsum("kij,cj->kci", quaternion.matrix(now), _CORNERS)
        arm = arms[np.arange(len(arms)), np.argmin(arms[:, :, 2], axis=1)]
        fall = v - np.outer(GRAVITY * (since + 0.5 * DT), _AXES[0])
        approach = (fall + np.cross(w, arm))[:, 2]
        since = np.clip(DT + np.minimum(table["min_corner_z"], 0.0) / -approach, 0.0, DT)
    G = np.concatenate(
        [np.broadcast_to(_AXES, (len(arm), 3, 3)), np.cross(arm[:, None], _AXES)], axis=2
    )
    return Tosses(
        table["toss"].astype(int),
        np.hstack([fall, w]),
        np.hstack([v_after, w_after]),
        now,
        -arm[:, 2],
        G,
        SAMPLES_BETWEEN * DT - (since + 0.5 * DT),
    )


def predict(restitution: float, friction: float, law: str = "newton") -> np.ndarray:
    """Return (v, w) (K, 6) at the time of measurement, after one impact and free flight."""
    tosses = load()
    result = tosses.before.copy()
    for k, (G, state) in enumerate(zip(tosses.jacobian, tosses.before)):
        W = (G * _INVERSE) @ G.T
        impulse = carom.resolve_impact(W, G @ state, friction, restitution, law).impulse
        result[k] += _INVERSE * (G.T @ impulse)
    return _fly(result)


def simulated(restitution: float, friction: float, law: str = "newton") -> np.ndarray:
    """Return the result of `predict` by `carom.simulate` from the impact on, which includes later impacts."""
    tosses = load()
    result = np.empty_like(tosses.before)
    for k, state in enumerate(tosses.before):
        scene = carom.Scene(gravity=(0, 0, -GRAVITY))
        table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
        cube = scene.add_body(
            shape=carom.Box(2 * HALF, 2 * HALF, 2 * HALF),
            mass=MASS,
            inertia=np.full(3, INERTIA),
            position=(0, 0, tosses.height[k] + 1e-9),
            orientation=tosses.attitude[k],
            velocity=state[:3],
            angular_velocity=state[3:],
        )
        scene.add_contact(cube, table, restitution=restitution, friction=friction, impact_law=law)
        run = carom.simulate(scene, tosses.flight[k], step=1e-3, throw=False)
        result[k] = np.concatenate([run.velocity[-1, 0], run.angular_velocity[-1, 0]])
    return result


def no_impact() -> np.ndarray:
    """Return the velocities (K, 6) that the cubes would have without a table."""
    return _fly(load().before.copy())


def _fly(states: np.ndarray) -> np.ndarray:
    states[:, 2] -= GRAVITY * load().flight
    return states


def errors(predicted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return |dv| [m/s] and |dw| [rad/s] of each impact (K,)."""
    difference = predicted - load().after
    return np.linalg.norm(difference[:, :3], axis=1), np.linalg.norm(difference[:, 3:], axis=1)


def objective(parameters, law: str) -> float:
    """Return the mean of |dv| + r |dw| [m/s], not squared; r = sqrt(J / m) is the radius of gyration."""
    e, mu = parameters
    if not (0.0 <= e <= 1.0 and mu >= 0.0):
        return np.inf
    dv, dw = errors(predict(e, mu, law))
    return float(np.mean(dv + np.sqrt(INERTIA / MASS) * dw))


@cache
def fit(law: str) -> tuple[float, float]:
    """Return (e, mu) that minimise `objective` (Nelder and Mead, from the nominal values)."""
    from scipy.optimize import minimize

    start = np.array([NOMINAL, (0.35, 0.18), (0.125, 0.24)])
    options = {"initial_simplex": start, "xatol": 5e-4, "fatol": 1e-6}
    best = minimize(objective, NOMINAL, args=(law,), method="Nelder-Mead", options=options)
    return float(best.x[0]), float(best.x[1])


def medians(predicted: np.ndarray) -> tuple[float, float]:
    """Return the medians of |dv| [m/s] and |dw| [rad/s]."""
    dv, dw = errors(predicted)
    return float(np.median(dv)), float(np.median(dw))
