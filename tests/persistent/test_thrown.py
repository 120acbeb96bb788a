"""Bodies thrown on a plane come to rest on a face, whatever the throw, the law and the shape."""

import numpy as np
import pytest

import carom
from carom.geometry import quaternion

G = 9.81


def throw(shape, q, *, law="stronge", mu=0.2, e=0.5, method="rk4", duration=1.5):
    scene = carom.Scene(gravity=(0, 0, -G))
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
    body = scene.add_body(
        shape, mass=0.016, position=(0, 0, 0.3), orientation=q / np.linalg.norm(q),
        velocity=(0.5, 0, -0.5), angular_velocity=(0, 10, 0),
    )  # fmt: skip
    scene.add_contact(body, ground, restitution=e, friction=mu, impact_law=law)
    return carom.simulate(scene, duration, step=1e-3, method=method)


def check(s, shape):
    """At rest, for good, on at least three points; never inside; energy only falls."""
    assert np.all(s.velocity[-1] == 0.0)
    assert np.all(s.angular_velocity[-1] == 0.0)
    assert np.all(s.position[-1] == s.position[-100])
    heights = s.position[:, 0, 2][:, None] + np.einsum(
        "tk,vk->tv", quaternion.matrix(s.orientation[:, 0])[:, 2], shape.vertices
    )
    assert heights.min() > -1e-12
    assert np.sum(np.abs(heights[-1]) < 1e-12) >= 3
    start = s.total_energy[0]
    assert np.all(s.impacts.energy_change <= 1e-15 * start)
    # pivoting on an edge is of order 2; none of 2100 dice was above this
    assert np.max(np.abs(s.ledger.residual)) < 1e-6 * start


@pytest.mark.processors
@pytest.mark.parametrize("law", ["newton", "poisson", "stronge"])
def test_the_papers_die(law):
    # 20 random throws a law. Rest after .4 to 1 s (mean .70 of many).
    rng = np.random.default_rng({"newton": 1, "poisson": 2, "stronge": 3}[law])
    shape, ends = carom.Box(0.02, 0.02, 0.02), []
    for q in rng.normal(size=(20, 4)):
        s = throw(shape, q, law=law)
        check(s, shape)
        ends.append(s.events.time[-1])
    assert 0.55 < np.mean(ends) < 0.85


@pytest.mark.parametrize(
    "shape",
    [
        carom.Box(0.03, 0.02, 0.012),
        carom.Convex([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)] * np.array(0.01)),
        carom.Convex(0.012 * np.vstack([np.eye(3), -np.eye(3)])),
    ],
    ids=["brick", "tetrahedron", "octahedron"],
)
def test_other_shapes(shape):
    for q in np.random.default_rng(4).normal(size=(5, 4)):
        check(throw(shape, q), shape)


@pytest.mark.parametrize("mu", [0.05, 0.5, 1.0, 2.0])
def test_any_friction(mu):
    # A vertex that slips and turns about near zero slip is no step for an explicit method: it gained up
    # to 4e-4 of the energy at mu = .5 (seed 221), and an edge that rocks on its two ends 2e-4 at mu = 1 (267).
    shape, seeds = carom.Box(0.02, 0.02, 0.02), (221, 126, 5, 232, 267, 107)
    for q in (np.random.default_rng(seed).normal(size=4) for seed in seeds):
        check(throw(shape, q, mu=mu, duration=2.5), shape)


def test_by_the_papers_method():
    shape = carom.Box(0.02, 0.02, 0.02)
    q = np.random.default_rng(5).normal(size=4)
    check(throw(shape, q, method="paper"), shape)
