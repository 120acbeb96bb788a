"""Recordings made by simulation, with known parameters and noise."""

import numpy as np

import carom
from carom.geometry import quaternion
from carom.studies.identify import Recording, State, roll_outs, varied

G, HALF, MASS = 9.81, 0.05, 0.4
POSITION_NOISE, ROTATION_NOISE = 1e-4, 1e-3
DT = 0.01


def box():
    scene = carom.Scene(gravity=(0, 0, -G))
    table = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
    cube = scene.add_body(
        carom.Box(2 * HALF, 2 * HALF, 2 * HALF), mass=MASS, position=(0, 0, 1), name="cube"
    )
    scene.add_contact(cube, table, restitution=0.5, friction=0.3)
    return scene


def tosses(count, samples, seed, **true):
    """Recordings of a cube that strikes with a corner about 0.05 s after the start, and its noise."""
    random, scene, found = np.random.default_rng(seed), box(), []
    for k in range(count):
        q = quaternion.normalize(random.normal(size=4))
        low = HALF * np.sum(np.abs(quaternion.matrix(q)[2]))
        v = np.array([*random.uniform(-1, 1, 2), -random.uniform(0.5, 1.5)])
        x = np.array([0, 0, low - 0.05 * v[2]])
        start = State(x, q, v, random.uniform(-4, 4, 3))
        t = DT * np.arange(samples)
        found.append(Recording(t, np.zeros((samples, 3)), [[1, 0, 0, 0]] * samples, start, str(k)))
    runs = roll_outs(lambda r: varied(scene, **true, start=r.start), found, workers=1)
    return [noisy(recording, run, random) for recording, run in zip(found, runs)]


def noisy(recording, run, random):
    shape = run.position.shape
    x = run.position + POSITION_NOISE * random.normal(size=shape)
    turn = quaternion.exp(ROTATION_NOISE * random.normal(size=shape))
    q = quaternion.multiply(turn, run.orientation)
    return Recording(recording.t, x, q, recording.start, recording.name)
