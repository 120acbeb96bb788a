"""Systems in coordinates of the user's own: rods, tables, pucks, rows of blocks, pendulums, closed loops."""

from __future__ import annotations

import numpy as np
import sympy as sp

import carom
from campaigns.case import Case

G = 9.81
LAWS = "newton", "poisson", "stronge"


def symbols(names: str):
    """Return coordinates and their rates."""
    return sp.symbols(names), sp.symbols(" ".join(f"d{name}" for name in names.split()))


def rate(f, q, v):
    """Return the rate of a function of the coordinates."""
    return sum(sp.diff(f, one) * speed for one, speed in zip(q, v))


def contact(rng) -> dict:
    """Return a random law of a contact."""
    return {
        "restitution": float(rng.choice([0.0, 1.0, rng.uniform(0.0, 0.9)])),
        "friction": float(rng.choice([0.0, rng.uniform(0.0, 1.0)])),
        "impact_law": str(rng.choice(LAWS)),
    }


def rod(rng):
    """Return a rod over a floor: two contacts of its ends."""
    q, v = symbols("x z a")
    x, z, a = q
    system = carom.GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(1, 1, sp.Rational(1, 12)), potential=G * z,
        position=[0, rng.uniform(0.6, 1.0), rng.uniform(-1.5, 1.5)],
        velocity=rng.uniform(-2.0, 2.0, 3),
    )  # fmt: skip
    law = contact(rng)
    for k in (-1, 1):
        end = x + k * sp.cos(a) / 2, z + k * sp.sin(a) / 2
        system.add_contact(end[1], tangent=rate(end[0], q, v), **law)
    return system


def table(rng):
    """Return a table on four legs that slides on a floor, for small angles."""
    q, v = symbols("z a b x y")
    third = sp.Rational(1, 3)
    system = carom.GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(1, third, third, 1, 1), potential=G * q[0],
        position=[rng.uniform(0.05, 0.3), *rng.uniform(-0.03, 0.03, 2), 0, 0],
        velocity=[0, *rng.uniform(-0.3, 0.3, 2), *rng.uniform(-1.0, 1.0, 2)],
    )  # fmt: skip
    law, slip = contact(rng), [v[3] + v[2] / 5, v[4] - v[1] / 5]
    for x, y in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
        system.add_contact(q[0] + x * q[1] + y * q[2], tangent=slip, **law)
    return system


def puck(rng):
    """Return a puck on a floor in a wind that turns."""
    q, v = symbols("x y z")
    t, force = sp.Symbol("t", real=True), rng.uniform(0.0, 4.0)
    w = rng.uniform(0.0, 8.0)
    system = carom.GeneralizedSystem.from_sympy(
        q, v, metric=sp.eye(3), potential=G * q[2], time=t,
        forces=[force * sp.cos(w * t), force * sp.sin(w * t), 0],
        position=[0, 0, rng.choice([0.0, 0.1])], velocity=[*rng.uniform(-1.0, 1.0, 2), 0],
    )  # fmt: skip
    system.add_contact(q[2], tangent=v[:2], **contact(rng))
    return system


def row(rng):
    """Return a row of blocks on a line, joined by springs, that a wall and each other stop."""
    n = int(rng.integers(2, 6))
    q, v = symbols(" ".join(f"x{k}" for k in range(n)))
    masses = 10.0 ** rng.uniform(-1.0, 1.0, n)
    V = sum(
        rng.uniform(1.0, 200.0) * (q[k + 1] - q[k] - 1) ** 2 / 2
        for k in range(n - 1)
        if rng.random() < 0.5
    )
    system = carom.GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(*masses.tolist()), potential=V + rng.uniform(0.0, 5.0) * sum(q),
        position=np.cumsum(rng.uniform(1.0, 1.5, n)), velocity=rng.uniform(-2.0, 2.0, n),
    )  # fmt: skip
    law = contact(rng) | {"friction": 0.0}
    system.add_contact(q[0] - sp.Rational(1, 2), **law)
    for k in range(n - 1):
        system.add_contact(q[k + 1] - q[k] - sp.Rational(9, 10), **law)
    return system


def pendulum(rng):
    """Return a double pendulum that strikes a wall and a floor."""
    q, v = symbols("a b")
    a, b = q
    x, z = sp.sin(a) + sp.sin(b), -sp.cos(a) - sp.cos(b)
    elbow = sp.sin(a), -sp.cos(a)
    T = (rate(x, q, v) ** 2 + rate(z, q, v) ** 2) / 2
    T += rng.uniform(0.2, 5.0) * (rate(elbow[0], q, v) ** 2 + rate(elbow[1], q, v) ** 2) / 2
    system = carom.GeneralizedSystem.from_sympy(
        q, v, kinetic_energy=sp.expand(T), potential=G * (z + elbow[1]),
        position=rng.uniform(-1.5, 0.2, 2), velocity=rng.uniform(-3.0, 3.0, 2),
    )  # fmt: skip
    system.add_contact(sp.Float(rng.uniform(0.9, 1.5)) - x, tangent=rate(z, q, v), **contact(rng))
    return system


def loop(rng):
    """Return a slider-crank of three coordinates and two constraints, whose slider a stop stops."""
    q, v = symbols("a b x")
    a, b, x = q
    long = rng.uniform(1.3, 3.0)
    angle = rng.uniform(-3.0, 3.0)
    other = -np.arcsin(np.sin(angle) / long)
    place = np.cos(angle) + long * np.cos(other)
    J = np.array(
        [[-np.sin(angle), -long * np.sin(other), -1.0], [np.cos(angle), long * np.cos(other), 0]]
    )
    speed = rng.uniform(-6.0, 6.0)
    rates = np.linalg.solve(J[:, 1:], -J[:, 0] * speed)
    system = carom.GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(*(10.0 ** rng.uniform(-1.0, 1.0, 3)).tolist()), potential=G * sp.sin(a),
        constraints=[sp.cos(a) + long * sp.cos(b) - x, sp.sin(a) + long * sp.sin(b)],
        position=[angle, other, place], velocity=[speed, *rates],
    )  # fmt: skip
    stop = rng.uniform(long - 0.9, long + 0.9)
    gap = x - min(stop, place - 0.01) if rng.random() < 0.5 else max(stop, place + 0.01) - x
    system.add_contact(gap, **contact(rng) | {"friction": 0.0})
    return system


def chart(rng):
    """Return a particle in polar coordinates, outside or inside of a circle, in units of its own."""
    q, v = symbols("r a")
    units = 10.0 ** rng.uniform(-4.0, 4.0, 2)
    r, a = (sp.Float(unit) * one for unit, one in zip(units.tolist(), q))
    inside = rng.random() < 0.5
    start = np.array(
        [rng.uniform(0.3, 0.95) if inside else rng.uniform(1.0, 1.5), rng.uniform(-3.0, 3.0)]
    )
    system = carom.GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(float(units[0]) ** 2, (float(units[1]) * r) ** 2), potential=G * r * sp.cos(a),
        position=start / units, velocity=rng.uniform(-1.0, 1.0, 2) / units, scale=1.0 / units,
    )  # fmt: skip
    tangent = r * float(units[1]) * v[1]
    system.add_contact(1 - r if inside else r - 1, tangent=tangent, **contact(rng))
    return system


def sled(rng):
    """Return a sleigh on a blade, a nonholonomic row, that strikes a wall."""
    q, v = symbols("x y a")
    x, _, a = q
    c = rng.uniform(-0.4, 0.4)
    vx, vy = v[0] - c * v[2] * sp.sin(a), v[1] + c * v[2] * sp.cos(a)
    angle, speed = rng.uniform(-1.0, 1.0), rng.uniform(0.2, 3.0)
    system = carom.GeneralizedSystem.from_sympy(
        q, v, kinetic_energy=(vx**2 + vy**2 + rng.uniform(0.1, 1.0) * v[2] ** 2) / 2,
        rates=[v[1] * sp.cos(a) - v[0] * sp.sin(a)], position=[0, 0, angle],
        velocity=[speed * np.cos(angle), speed * np.sin(angle), rng.uniform(-3.0, 3.0)],
    )  # fmt: skip
    # another place would be on the line of the blade, which it cannot leave sideways
    law = contact(rng)
    system.add_contact(sp.Float(rng.uniform(0.6, 1.5)) - x - c * sp.cos(a), tangent=vy, **law)
    return system


def functions(rng):
    """Return coupled masses over stops by plain functions without derivatives, in units from 1e-3 to 1e3."""
    n = int(rng.integers(2, 4))
    scale = 10.0 ** rng.uniform(-3.0, 3.0, n)
    m = 10.0 ** rng.uniform(-1.0, 1.0, n) / scale**2
    couple = rng.uniform(-0.4, 0.4)

    def metric(q):
        M = np.diag(m)
        M[0, 1] = M[1, 0] = couple * np.sqrt(m[0] * m[1]) * np.cos(q[0] / scale[0])
        return M

    system = carom.GeneralizedSystem(
        metric, scale * rng.uniform(0.2, 1.0, n), scale * rng.uniform(-1.0, 1.0, n), scale=scale,
        potential=lambda q: float(np.sum(G * m * scale * q)),
    )  # fmt: skip
    for k in range(n):
        system.add_contact(lambda q, k=k: q[k], **contact(rng) | {"friction": 0.0})
    return system


KINDS = {
    "rod": rod,
    "table": table,
    "puck": puck,
    "row": row,
    "pendulum": pendulum,
    "loop": loop,
    "chart": chart,
    "sled": sled,
    "functions": functions,
}


def case(seed: int) -> Case:
    """Return system number `seed`: kinds in turn, the rest at random."""
    rng = np.random.default_rng([77, seed])
    kind = list(KINDS)[seed % len(KINDS)]
    system = KINDS[kind](rng)
    step = float(rng.choice([1e-3, 5e-3, 2e-2]))
    return Case(system, 1.2, step, {"kind": kind, "step": step}, deep=depth)


def depth(s: carom.generalized.GeneralizedSolution) -> float:
    """Return the greatest depth of a gap at a saved time, by the greatest size of a coordinate above 1."""
    size = max(1.0, float(np.max(s.system.scale)))
    return max(0.0, *(-float(np.min(s.system.gaps(q))) for q in s.q)) / size
