"""Two bodies that strike each other and the floor."""

import numpy as np
import pytest

import carom
from carom.geometry import quaternion

from .thrown import SIX, derivative, outcome

NAMES = (
    "a.position", "a.orientation", "a.velocity", "a.angular_velocity",
    "b.position", "b.orientation", "b.velocity", "b.angular_velocity",
    "a-b.restitution", "a-b.friction", "b-floor.restitution", "b-floor.friction",
)  # fmt: skip
SHAPES = {
    "spheres": (carom.Sphere(0.05), carom.Sphere(0.07)),
    "capsules": (carom.Capsule(0.03, 0.1), carom.Capsule(0.04, 0.1)),
    "boxes": (carom.Box(0.1, 0.1, 0.1), carom.Box(0.2, 0.2, 0.2)),
    "curved": (carom.Ellipsoid(0.05, 0.07, 0.04), carom.Cylinder(0.05, 0.1)),
}
#: up to when: three to six impacts, both kinds among them
UNTIL = {"spheres": 0.2, "capsules": 0.18, "boxes": 0.12, "curved": 0.18}


def collide(kind, z=None):
    z = np.zeros(28) if z is None else z
    turns = [quaternion.normalize(q) for q in ((0.9, 0.2, 0.3, -0.1), (0.5, -0.6, 0.3, 0.4))]
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0.1, 1), name="floor")
    starts = (
        ((0.03, 0.02, 0.5), (0.0, 0.2, -2.0), (2, -3, 1), 0.5),
        ((0, 0, 0.25), (0.1, 0.0, -0.5), (-1, 3, 2), 1.2),
    )
    bodies = []
    for k, (x, v, w, mass) in enumerate(starts):
        d = z[12 * k : 12 * k + 12]
        bodies.append(
            scene.add_body(
                SHAPES[kind][k], mass=mass, position=x + d[:3],
                orientation=quaternion.multiply(quaternion.exp(d[3:6]), turns[k]),
                velocity=v + d[6:9], angular_velocity=w + d[9:], name="ab"[k],
            )
        )  # fmt: skip
    a, b = bodies
    scene.add_contact(a, b, restitution=0.6 + z[24], friction=0.3 + z[25])
    scene.add_contact(a, floor, restitution=0.5, friction=0.2)
    scene.add_contact(b, floor, restitution=0.7 + z[26], friction=0.25 + z[27])
    return carom.simulate(scene, UNTIL[kind], step=2.5e-4)


@pytest.mark.parametrize("kind", SHAPES)
def test_derivatives_are_those_of_differences(kind):
    reference = collide(kind)
    sequence = carom.contact_sequence(reference)
    assert {0, 2} <= {event.contact for event in sequence}
    found = carom.sensitivities(reference, NAMES)
    exact, size = derivative(found), np.array([0.1] * 3 + [1.0] * 3 + [1.0] * 3 + [10.0] * 3)
    size = np.concatenate([size, size, np.ones(4)])
    scale = np.max(np.abs(exact * size))
    random = np.random.default_rng(3)
    for _ in range(4):  # all parameters at once, in random directions
        way = random.normal(size=28) * size
        errors = []
        for part in (1e-3, 2e-4, 4e-5):
            step = min(part, 0.05 / np.sum(np.abs(way) / found.reach))
            total = 0.0
            for at, weight in SIX:
                run = collide(kind, at * step * way)
                if carom.contact_sequence(run) != sequence:
                    break
                total = total + weight / step * outcome(run, reference)
            else:
                errors.append(np.max(np.abs(total - exact @ way)) / scale)
        assert min(errors) < 1e-6, errors


def test_momentum_of_a_blow_is_kept_by_all_neighbours():
    # between the two alone: m_a dv_a + m_b dv_b after is that before, with gravity the same for both
    run = collide("spheres")
    found = carom.sensitivities(run, NAMES)
    first = run.impacts.time[0]
    assert run.impacts.contact[0] == 0
    before, after = found.evaluate(first - 1e-9), found.evaluate(first + 1e-9)
    for d in (before, after):
        total = 0.5 * d.velocity[0] + 1.2 * d.velocity[1]
        start = np.zeros((3, 28))
        start[:, 6:9], start[:, 18:21] = 0.5 * np.eye(3), 1.2 * np.eye(3)
        np.testing.assert_allclose(total, start, atol=1e-9)
