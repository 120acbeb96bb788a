"""Throws drawn at random, of all kinds of shapes and coefficients, against differences in random directions."""

import numpy as np
import pytest

import carom
from carom.geometry import quaternion

NAMES = (
    "b.position",
    "b.orientation",
    "b.velocity",
    "b.angular_velocity",
    "restitution",
    "friction",
    "gravity",
)
SHAPES = (
    carom.Box(0.1, 0.06, 0.08), carom.Capsule(0.03, 0.1), carom.Cylinder(0.05, 0.08),
    carom.Ellipsoid(0.05, 0.07, 0.04), carom.Sphere(0.05), carom.Box(0.1, 0.06, 0.08, radius=0.01),
)  # fmt: skip
SIZE = np.array([0.1] * 3 + [1.0] * 3 + [1.0] * 3 + [10.0] * 3)


def drawn(seed):
    """Return a function from changes (17,) to a run, and which of them have two sides."""
    random = np.random.default_rng(seed)
    shape = SHAPES[seed % len(SHAPES)]
    e, mu = random.choice([0.3, 0.5, 0.8, 1.0]), random.choice([0.0, 0.05, 0.2, 0.5, 1.0])
    law = ("newton", "poisson", "stronge")[random.integers(3)]
    turn, v = quaternion.normalize(random.normal(size=4)), random.normal(size=3) - [0, 0, 1]
    w, tilt, until = (
        5 * random.normal(size=3),
        0.2 * random.normal(size=2),
        random.uniform(0.2, 0.6),
    )

    def throw(z):
        scene = carom.Scene(gravity=np.array([0, 0, -9.81]) + z[14:])
        floor = scene.add_half_space((0, 0, 0), (*tilt, 1), name="floor")
        body = scene.add_body(
            shape, mass=1.0, position=np.array([0, 0, 0.4]) + z[:3],
            orientation=quaternion.multiply(quaternion.exp(z[3:6]), turn),
            velocity=v + z[6:9], angular_velocity=w + z[9:12], name="b",
        )  # fmt: skip
        scene.add_contact(body, floor, restitution=e + z[12], friction=mu + z[13], impact_law=law)
        return carom.simulate(scene, until, step=5e-4)

    two_sided = np.ones(17)
    two_sided[12], two_sided[13] = e < 1.0, mu > 0.0
    return throw, two_sided


@pytest.mark.few(6)
@pytest.mark.parametrize("seed", range(24))
def test_the_end_of_a_throw(seed):
    throw, two_sided = drawn(seed)
    reference = throw(np.zeros(17))
    found = carom.sensitivities(reference, NAMES, throw=False)
    X = np.concatenate([a[0] for a in found.final])
    if found.notes:  # held before the end: all that the body knows of is lost, and nothing else is
        assert np.all(np.isnan(X))
        assert "held" in reference.events.kind or np.any(reference.impacts.together > 1)
        return
    way = np.random.default_rng(1000 + seed).normal(size=17) * two_sided
    way *= np.concatenate([0.5 * SIZE, [0.3, 0.3], [3.0] * 3])
    slope, scale = X @ way, np.max(np.abs(X * way) / SIZE[:, None])
    sequence, errors = carom.contact_sequence(reference), []
    reach = min(0.1, 1 / np.sum(np.abs(way) / found.reach))
    for part in (0.2, 0.05, 0.01, 1e-3):
        total, h = 0.0, part * reach
        for at, weight in ((-2, 1 / 12), (-1, -2 / 3), (1, 2 / 3), (2, -1 / 12)):
            run = throw(at * h * way)
            if carom.contact_sequence(run) != sequence:
                break
            off = quaternion.multiply(
                run.orientation[-1, 0], quaternion.conjugate(reference.orientation[-1, 0])
            )
            end = (run.position[-1, 0], quaternion.log(off), run.velocity[-1, 0])
            total = total + weight / h * np.concatenate([*end, run.angular_velocity[-1, 0]])
        else:
            errors.append(np.max(np.abs(total - slope) / SIZE) / scale)
    # the last digits of a run over the step: 1e-13 amplified as the derivative is, over 1e-3 of the reach
    assert min(errors) < 1e-5
