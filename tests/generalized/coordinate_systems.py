"""Systems in coordinates that several tests use, and their twins as scenes of bodies."""

import numpy as np
import sympy as sp

import carom
from carom import GROUND, GeneralizedSystem, Scene, joints

GRAVITY = 9.81


def symbols(names):
    """Coordinates and velocities: x -> x, dx."""
    q = sp.symbols(names, real=True)
    return list(q), [sp.Symbol(f"d{one}", real=True) for one in q]


def rate(expression, q, v):
    return sum(sp.diff(expression, a) * b for a, b in zip(q, v))


def turned(angle, axis=(0, 1, 0)):
    return (np.cos(angle / 2), *(np.sin(angle / 2) * np.array(axis, dtype=float)))


def double_pendulum(position, velocity):
    """Two uniform rods of 1 m and 1 kg, angles from straight down; returns (system, tip x, tip z, rate)."""
    q, v = symbols("a b")
    a, b = q
    centres = [
        (sp.sin(a) / 2, -sp.cos(a) / 2),
        (sp.sin(a) + sp.sin(b) / 2, -sp.cos(a) - sp.cos(b) / 2),
    ]
    T = sum(rate(c, q, v) ** 2 for one in centres for c in one) / 2
    T += sp.Rational(1, 24) * (v[0] ** 2 + v[1] ** 2)
    V = GRAVITY * sum(z for _, z in centres)
    system = GeneralizedSystem.from_sympy(
        q, v, kinetic_energy=T, potential=V, position=position, velocity=velocity
    )
    tip = sp.sin(a) + sp.sin(b), -sp.cos(a) - sp.cos(b)
    return system, *tip, lambda expression: rate(expression, q, v)


def double_pendulum_scene(position, velocity):
    (a, b), (da, db) = position, velocity
    scene = Scene(gravity=(0, 0, -GRAVITY))
    elbow, drift = np.array([np.sin(a), 0, -np.cos(a)]), da * np.array([np.cos(a), 0, np.sin(a)])
    half = np.array([np.sin(b), 0, -np.cos(b)]) / 2
    own = db * np.array([np.cos(b), 0, np.sin(b)]) / 2
    upper = scene.add_body(
        mass=1.0, inertia=[1 / 12, 1 / 12, 1e-4], position=elbow / 2, velocity=drift / 2,
        orientation=turned(-a), angular_velocity=(0, -da, 0), name="upper",
    )  # fmt: skip
    lower = scene.add_body(
        mass=1.0, inertia=[1 / 12, 1 / 12, 1e-4], position=elbow + half, velocity=drift + own,
        orientation=turned(-b), angular_velocity=(0, -db, 0), name="lower",
    )  # fmt: skip
    scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, upper)
    scene.add_joint(joints.Revolute(elbow, (0, 1, 0)), upper, lower)
    return scene


CRANK, ROD, MASSES = 0.3, 0.8, (1.0, 1.5, 0.7)
STOP = {"at": 1.02, "restitution": 0.6}


def slider_crank(turn, speed, reduced, stop=True):
    """Crank, rod and slider; in the crank's turn alone, or in three coordinates that close a loop."""
    m1, m2, m3 = MASSES
    q, v = symbols("th ph s") if not reduced else symbols("th,")
    th = q[0]
    if reduced:
        ph = sp.asin(-CRANK / ROD * sp.sin(th))
        s = CRANK * sp.cos(th) + ROD * sp.cos(ph)
    else:
        _, ph, s = q
    x, z = CRANK * sp.cos(th) + ROD / 2 * sp.cos(ph), CRANK * sp.sin(th) + ROD / 2 * sp.sin(ph)
    T = m1 * CRANK**2 / 3 * v[0] ** 2 + m3 * rate(s, q, v) ** 2
    T += m2 * (rate(x, q, v) ** 2 + rate(z, q, v) ** 2 + ROD**2 / 12 * rate(ph, q, v) ** 2)
    V = GRAVITY * (m1 * CRANK / 2 * sp.sin(th) + m2 * z)
    phi = -np.arcsin(CRANK / ROD * np.sin(turn))
    phi_rate = -CRANK * np.cos(turn) * speed / (ROD * np.cos(phi))
    slide = CRANK * np.cos(turn) + ROD * np.cos(phi)
    slide_rate = -CRANK * np.sin(turn) * speed - ROD * np.sin(phi) * phi_rate
    start = dict(position=[turn], velocity=[speed])
    if not reduced:
        start = dict(position=[turn, phi, slide], velocity=[speed, phi_rate, slide_rate])
        start["constraints"] = [
            CRANK * sp.cos(th) + ROD * sp.cos(ph) - s,
            CRANK * sp.sin(th) + ROD * sp.sin(ph),
        ]
    system = GeneralizedSystem.from_sympy(q, v, kinetic_energy=T / 2, potential=V, **start)
    if stop:
        system.add_contact(STOP["at"] - s, restitution=STOP["restitution"], name="stop")
    return system


def slider_crank_scene(turn, speed, stop=True):
    m1, m2, m3 = MASSES
    phi = -np.arcsin(CRANK / ROD * np.sin(turn))
    phi_rate = -CRANK * np.cos(turn) * speed / (ROD * np.cos(phi))
    scene, axis = Scene(gravity=(0, 0, -GRAVITY)), (0, -1, 0)

    def arm(angle):
        return np.array([np.cos(angle), 0, np.sin(angle)])

    def across(angle):
        return np.array([-np.sin(angle), 0, np.cos(angle)])

    pin, drift = CRANK * arm(turn), CRANK * speed * across(turn)
    end, end_drift = pin + ROD * arm(phi), drift + ROD * phi_rate * across(phi)
    crank = scene.add_body(
        mass=m1, inertia=[1e-3, m1 * CRANK**2 / 12, 1e-3 + m1 * CRANK**2 / 12],
        position=pin / 2, velocity=drift / 2,
        orientation=turned(turn, axis), angular_velocity=speed * np.array(axis), name="crank",
    )  # fmt: skip
    rod = scene.add_body(
        mass=m2, inertia=[1e-3, m2 * ROD**2 / 12, 1e-3 + m2 * ROD**2 / 12],
        position=(pin + end) / 2, velocity=(drift + end_drift) / 2,
        orientation=turned(phi, axis), angular_velocity=phi_rate * np.array(axis), name="rod",
    )  # fmt: skip
    slider = scene.add_body(
        carom.Sphere(0.05), mass=m3, position=end, velocity=end_drift * [1, 0, 0], name="slider"
    )
    scene.add_joint(joints.Revolute((0, 0, 0), axis), GROUND, crank)
    scene.add_joint(joints.Revolute(pin, axis), crank, rod)
    scene.add_joint(joints.Revolute(end, axis), rod, slider)
    scene.add_joint(joints.Prismatic((1, 0, 0)), GROUND, slider)
    if stop:
        wall = scene.add_half_space((STOP["at"] + 0.05, 0, 0), (-1, 0, 0), name="stop")
        scene.add_contact(slider, wall, restitution=STOP["restitution"], friction=0.0)
    return scene


LENGTH, DEPTH, MASS = 1.0, 0.06, 2.0


def falling_rod(angle, velocity, spin, restitution, friction, law, mirrored=False):
    """A bar in the plane that falls on its four corners: (x, z, turn about +y)."""
    q, v = symbols("x z a")
    x, z, a = q
    sign = -1 if mirrored else 1
    J = MASS * (LENGTH**2 + DEPTH**2) / 12
    system = GeneralizedSystem.from_sympy(
        q, v, metric=sp.diag(MASS, MASS, J), potential=MASS * GRAVITY * z,
        position=[0, 1, sign * angle], velocity=[sign * velocity[0], velocity[1], sign * spin],
    )  # fmt: skip
    for i in (-1, 1):
        for k in (-1, 1):
            px, pz = sign * i * LENGTH / 2, k * DEPTH / 2
            corner = x + px * sp.cos(a) + pz * sp.sin(a), z - px * sp.sin(a) + pz * sp.cos(a)
            system.add_contact(
                corner[1], tangent=rate(corner[0], q, v), restitution=restitution,
                friction=friction, impact_law=law,
            )  # fmt: skip
    return system


def falling_rod_scene(angle, velocity, spin, restitution, friction, law):
    scene = Scene(gravity=(0, 0, -GRAVITY))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    J = MASS * (LENGTH**2 + DEPTH**2) / 12
    bar = scene.add_body(
        carom.Box(LENGTH, 0.1, DEPTH), mass=MASS, inertia=[0.9 * J, J, J], position=(0, 0, 1),
        orientation=turned(angle), velocity=(velocity[0], 0, velocity[1]),
        angular_velocity=(0, spin, 0),
    )  # fmt: skip
    scene.add_contact(bar, floor, restitution=restitution, friction=friction, impact_law=law)
    return scene
