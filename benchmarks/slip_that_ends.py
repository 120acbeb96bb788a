"""Round bodies that slide by laws of friction until they roll: true errors of place and arc by tolerance.

    python benchmarks/slip_that_ends.py ball 50             balls on a plane or in a bowl, which may turn
    python benchmarks/slip_that_ends.py other 50            cylinders, discs and ellipsoids on a plane

The reference of balls is an integration of its own of Newton's and Euler's equations, to 1e-13; that of others
is the run at `rtol=1e-12`. An error is the greatest of a place or an arc at the end, divided by atol + rtol of
the size. A line names a scene with more than ten.
"""

from __future__ import annotations

import argparse
import warnings
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import carom
from true_errors import error

TOLERANCES, FINE = (1e-4, 1e-6, 1e-8, 1e-10), 1e-12
G = np.array([0.0, 0.0, -9.81])
END_OF_SLIP = 1e-9  # [m/s] of the reference, which an impulse then takes away


def a_law(rng):
    """Return a number, a law by two coefficients or of Stribeck, or a table."""
    mu, kind = rng.uniform(0.05, 0.5), int(rng.integers(5))
    if kind == 0:
        return mu
    if kind == 1:
        return carom.Friction(1.4 * mu, mu)
    if kind < 4:
        speed, exponent = 10 ** rng.uniform(-1.2, 0.0), rng.choice([0.7, 1.0, 2.0])
        return carom.Friction(rng.uniform(1.1, 2.5) * mu, mu, speed=speed, exponent=exponent)
    speeds = np.append(0.0, np.sort(rng.uniform(0.05, 1.5, 3)))
    return carom.Friction.table(speeds, rng.uniform(0.05, 0.5, 4))


@dataclass
class Ball:
    """A ball of radius r in a sphere of radius R about the origin that turns with `spin`; R = inf: z = 0."""

    r: float
    R: float
    spin: np.ndarray
    law: object
    y: np.ndarray  # place, velocity, attitude (vector first), angular velocity

    def at(self, y):
        """Return normal, its rate, slip, and N/m."""
        x, v, w = y[:3], y[3:6], y[10:]
        n, turn = np.array([0.0, 0.0, 1.0]), np.zeros(3)
        if np.isfinite(self.R):
            n, turn = -x / np.linalg.norm(x), -v / (self.R - self.r)
        slip = v - self.r * np.cross(w, n) - np.cross(self.spin, x - self.r * n)
        return n, turn, slip - n * (n @ slip), -v @ turn - G @ n

    def held(self, y):
        """Return the friction that keeps the ball rolling, over its mass: du/dt = 0, 1/m + r^2/I = 7/(2 m)."""
        n, turn, _, _ = self.at(y)
        c = G - self.r * np.cross(y[10:], turn) - np.cross(self.spin, y[3:6] - self.r * turn)
        return -(c - n * (n @ c)) / 3.5

    def rate(self, y, rolls):
        n, _, slip, N = self.at(y)
        if rolls:
            T = self.held(y)
        else:
            speed = np.linalg.norm(slip)
            T = -(self.law(speed) if callable(self.law) else self.law) * N * slip / speed
        q, w = y[6:10], y[10:]
        turned = 0.5 * np.append(q[3] * w + np.cross(w, q[:3]), -w @ q[:3])
        return np.concatenate([y[3:6], G + N * n + T, turned, -np.cross(n, T) / (0.4 * self.r)])

    def run(self, duration):
        """Return the end, and whether slip ends and friction holds the ball from then on."""

        def ends(t, y):
            return np.linalg.norm(self.at(y)[2]) - END_OF_SLIP

        ends.terminal = True
        fine = dict(method="DOP853", rtol=1e-13, atol=1e-15)
        slides = solve_ivp(
            lambda t, y: self.rate(y, False), (0, duration), self.y, events=ends, **fine
        )
        y, bound = slides.y[:, -1], self.law.bound if callable(self.law) else self.law
        if slides.status == 0:
            return y, False
        n, _, slip, _ = self.at(y)
        y[3:6] -= slip / 3.5
        y[10:] += np.cross(n, slip) / (3.5 * 0.4 * self.r)
        rolls = solve_ivp(lambda t, y: self.rate(y, True), (slides.t[-1], duration), y, **fine)
        used = [np.linalg.norm(self.held(y)) / (bound * self.at(y)[3]) for y in rolls.y.T]
        return rolls.y[:, -1], max(used) < 0.99 and min(self.at(y)[3] for y in rolls.y.T) > 0.0

    def scene(self):
        scene = carom.Scene(gravity=G)
        axis, rate = (0, 0, 1), float(self.spin[2])
        if np.isfinite(self.R):
            ground = scene.add_surface(
                carom.surfaces.InsideSphere(self.R), surface_spin=(axis, rate)
            )
        else:
            ground = scene.add_half_space((0, 0, 0), (0, 0, 1), surface_spin=(axis, rate))
        q = self.y[[9, 6, 7, 8]]
        ball = scene.add_body(
            carom.Sphere(self.r), mass=0.7, position=self.y[:3], orientation=q, velocity=self.y[3:6],
            angular_velocity=self.y[10:],
        )  # fmt: skip
        scene.add_contact(ball, ground, restitution=0.0, friction=self.law)
        return scene


def ball(seed: int) -> Ball:
    """Return a random ball that slides."""
    rng = np.random.default_rng([59, seed])
    r, hollow = 10 ** rng.uniform(-1.7, -0.7), rng.random() < 0.5
    R = r * rng.uniform(3, 12) if hollow else np.inf
    spin = np.array([0.0, 0.0, rng.normal() * 4.0 if rng.random() < 0.5 else 0.0])
    x = np.array([0.1, 0.0, r])
    if hollow:
        n = np.append(0.4 * rng.normal(size=2), -1.0)
        x = (R - r) * n / np.linalg.norm(n)
    n = -x / np.linalg.norm(x) if hollow else np.array([0.0, 0.0, 1.0])
    v = 0.5 * rng.normal(size=3) * (np.sqrt(10 * r) if hollow else 1.0)
    w = 0.5 * rng.normal(size=3) * np.sqrt(10 / r)
    return Ball(r, R, spin, a_law(rng), np.concatenate([x, v - n * (n @ v), [0, 0, 0, 1], w]))


def run(scene, duration, rtol):
    """Return a run of which only the end is saved."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return carom.simulate(scene, duration, rtol=rtol, save_at=duration, throw=False)


def error_of_ball(one: Ball, end: np.ndarray, solution, rtol: float) -> float:
    """Return the greater error of place and arc by the tolerance."""
    found = Rotation.from_quat(solution.orientation[-1, 0][[1, 2, 3, 0]])
    arc = one.r * (found.inv() * Rotation.from_quat(end[6:10])).magnitude()
    return max(np.linalg.norm(solution.position[-1, 0] - end[:3]), arc) / (2.0 * one.r * rtol)


def other(seed: int):
    """Return the scene of a random round body that slides on a plane."""
    rng = np.random.default_rng([60, seed])
    scene = carom.Scene(gravity=G)
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    kind, r, q = ("cylinder", "disc", "ellipsoid")[seed % 3], rng.uniform(0.03, 0.2), (1, 0, 0, 0)
    v, w = 0.5 * rng.normal(size=3) * [1, 1, 0], rng.normal(size=3) * [3, 3, 10]
    if kind == "cylinder":  # lying, or standing and spinning
        shape = carom.Cylinder(r, r * rng.uniform(0.5, 3.0))
        low, w = 0.5 * shape.length, w * [0, 0, 1]
        if rng.random() < 0.5:
            q, low, v, w = (
                carom.euler("x", [90]),
                r,
                v * [1, 0, 0],
                np.array([0.0, 6.0 * rng.normal(), 0.0]),
            )
    elif kind == "disc":
        shape, q = carom.Disc(r), carom.euler("x", [rng.uniform(40, 90)])
        low = r * abs(Rotation.from_quat(np.asarray(q)[[1, 2, 3, 0]]).as_matrix()[2, 1])
        w = w * 0.3
        v = np.append(v[:2], -np.cross(w, (0, 0, -low))[2])
    else:
        shape = carom.Ellipsoid(r, r * rng.uniform(0.6, 1.2), r * rng.uniform(0.6, 1.2))
        low = shape.c
    body = scene.add_body(
        shape, mass=1.0, position=(0, 0, low), orientation=q, velocity=v, angular_velocity=w
    )
    scene.add_contact(body, floor, restitution=0.0, friction=a_law(rng))
    return scene


def errors(kind: str, seed: int, duration: float) -> list[float] | None:
    """Return the errors at all tolerances; None if a ball does not come to roll."""
    if kind == "ball":
        one = ball(seed)
        end, rolls = one.run(duration)
        if not rolls:
            return None
        return [error_of_ball(one, end, run(one.scene(), duration, tol), tol) for tol in TOLERANCES]
    exact = run(other(seed), duration, FINE)
    return [error(run(other(seed), duration, tol), exact, tol) for tol in TOLERANCES]


def main() -> None:
    """Print the scenes above ten, and how many there are by tolerance."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("kind", choices=["ball", "other"])
    parser.add_argument("count", type=int)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--duration", type=float, default=0.8, help="of a run [s]")
    given = parser.parse_args()
    rows = []
    for seed in range(given.first, given.first + given.count):
        found = errors(given.kind, seed, given.duration)
        if found is None:
            continue
        rows.append(found)
        if max(found) > 10.0:
            print(seed, ", ".join(f"{e:.2g}" for e in found), flush=True)
    table = np.array(rows)
    for k, rtol in enumerate(TOLERANCES):
        e = table[:, k]
        print(
            f"{given.kind}, rtol {rtol:g}: of {len(e)} median {np.median(e):.2g}, above ten {np.sum(e > 10)}"
        )


if __name__ == "__main__":
    main()
