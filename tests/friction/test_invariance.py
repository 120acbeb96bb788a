"""Nothing depends on names, axes or units: order of contacts, tangents, mirror, scales.

W is regular and mu <= 0.3 here, where the solution is unique.
"""

import numpy as np
from contact_problems import solve
from hypothesis import given, settings
from hypothesis import strategies as st

from carom.friction.layout import SOLVED

seeds = st.integers(0, 10**6)


def problem(seed):
    random = np.random.default_rng(seed)
    k = random.integers(1, 7)
    rows = random.normal(size=(3 * k, 3 * k + 6))
    return (
        rows @ rows.T,
        rows @ random.normal(size=3 * k + 6),
        random.uniform(0.0, 0.3, size=k),
        random,
    )


def assert_same(solved, expected, scale=1.0):
    assert solved.status == SOLVED
    # condition of W up to 1e4, times rounding of the Newton iteration
    size = np.abs(expected).max()
    np.testing.assert_allclose(solved.p * scale, expected, atol=1e-10 * size, rtol=0)


@settings(max_examples=60, deadline=None)
@given(seed=seeds)
def test_order_of_contacts(seed):
    W, c, mu, random = problem(seed)
    order = random.permutation(len(mu))
    at = (3 * order[:, None] + np.arange(3)).ravel()
    assert_same(solve(W[np.ix_(at, at)], c[at], mu[order]), solve(W, c, mu).p[at])


@settings(max_examples=60, deadline=None)
@given(seed=seeds, mirror=st.booleans())
def test_tangents_turned_or_mirrored(seed, mirror):
    W, c, mu, random = problem(seed)
    turn = np.eye(len(c))
    for i in range(len(mu)):
        angle = random.uniform(0, 2 * np.pi)
        cosine, sine = np.cos(angle), np.sin(angle)
        block = np.array([[cosine, sine], [-sine, cosine]])
        if mirror:
            block[1] = -block[1]
        turn[3 * i + 1 : 3 * i + 3, 3 * i + 1 : 3 * i + 3] = block
    assert_same(solve(turn @ W @ turn.T, turn @ c, mu), turn @ solve(W, c, mu).p)


@settings(max_examples=60, deadline=None)
@given(seed=seeds, mass=st.floats(-60, 60), speed=st.floats(-60, 60))
def test_units(seed, mass, speed):
    # W in 1/kg, c in m/s: p is in kg m/s
    W, c, mu, _ = problem(seed)
    m, v = 10.0**mass, 10.0**speed
    assert_same(solve(W / m, c * v, mu), solve(W, c, mu).p * m * v)


@settings(max_examples=40, deadline=None)
@given(seed=seeds)
def test_a_contact_split_in_two_carries_the_same(seed):
    # two contacts at one place: hyperstatic, their sum is what one carries
    W, c, mu, _ = problem(seed)
    twice = np.kron(np.ones((2, 2)), W)
    split = solve(twice, np.tile(c, 2), np.tile(mu, 2))
    expected = solve(W, c, mu).p
    assert split.status == SOLVED
    first, second = split.p.reshape(2, -1)
    np.testing.assert_allclose(first + second, expected, atol=1e-9 * np.abs(expected).max())


@settings(max_examples=40, deadline=None)
@given(seed=seeds)
def test_start_does_not_matter(seed):
    W, c, mu, random = problem(seed)
    start = random.normal(size=len(c))
    assert_same(solve(W, c, mu, start=start), solve(W, c, mu).p)
