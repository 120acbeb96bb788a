"""`carom.solve_contacts`: shapes, defaults and what it refuses."""

import numpy as np
import pytest
from contact_problems import dense, stack

import carom
from verified import agree, verifies


def test_either_shape():
    W, c = dense(stack(2, slope=0.2))
    flat = carom.solve_contacts(W, c, 0.3)
    blocks = carom.solve_contacts(W.reshape(8, 3, 8, 3), c.reshape(8, 3), np.full(8, 0.3))
    np.testing.assert_array_equal(flat.impulse, blocks.impulse)
    assert flat.converged
    assert flat.impulse.shape == flat.velocity.shape == (8, 3)
    assert flat.residual <= 1e-13 * np.abs(c).max()
    assert flat.penetration_speed <= 1e-15
    assert flat.cone_violation <= 1e-15
    assert flat.complementarity <= 1e-15
    warm = carom.solve_contacts(W, c, 0.3, start=flat.impulse)
    np.testing.assert_allclose(warm.velocity, flat.velocity, atol=1e-15)


@verifies("solve_contacts", r"$P_t = -\mu P_n$ against slip", "closed form")
def test_block_that_slides():
    solution = carom.solve_contacts(np.eye(3), (-0.1, 1.0, 0.0), 0.5)
    agree(solution.impulse, [[0.1, -0.05, 0.0]], rtol=1e-15)
    agree(solution.velocity, [[0.0, 0.95, 0.0]], atol=1e-16)
    assert solution.message == "The contact problem was solved to its tolerance."


def test_kinds_by_name():
    solution = carom.solve_contacts(
        np.eye(6),
        [[-1, 0.4, 0.3], [-1, 2, 0]],
        0.1,
        kind=["sticking", "sliding"],
        heading=[[0, 0], [1, 0]],
    )
    np.testing.assert_allclose(solution.impulse, [[1, -0.4, -0.3], [1, -0.1, 0]], atol=1e-15)


def test_no_solution():
    wire = np.array([0.8, 0.6, 0.0])
    solution = carom.solve_contacts(np.outer(wire, wire), (-1.0, 1.0, 0.0), 2.0)
    assert not solution.converged
    assert "not solved" in solution.message


EYE, AWAY = np.eye(6), np.zeros(6)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((np.eye(3), AWAY, 0.5), "inverse_mass must have shape"),
        ((EYE + np.triu(np.ones((6, 6)), 1), AWAY, 0.5), "symmetric"),
        ((-EYE, AWAY, 0.5), "positive semidefinite"),
        ((EYE, np.zeros(5), 0.5), "velocity must have shape"),
        ((EYE, [], 0.5), "velocity must have shape"),
        ((EYE, np.full(6, np.nan), 0.5), "velocity must be finite"),
        ((EYE, AWAY, -0.5), "friction must be finite and at least 0"),
        ((EYE, AWAY, [0.5, 0.5, 0.5]), "friction must have shape"),
    ],
)
def test_bad_input(arguments, words):
    with pytest.raises(ValueError, match=words):
        carom.solve_contacts(*arguments)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"kind": "slide"}, "did you mean"),
        ({"kind": ["sliding"]}, "one name or 2 of them"),
        ({"heading": [[1, 1], [0, 0]]}, "unit vectors"),
        ({"start": np.zeros(3)}, "start must have shape"),
    ],
)
def test_bad_options(options, words):
    with pytest.raises(ValueError, match=words):
        carom.solve_contacts(EYE, AWAY, 0.5, **options)


@pytest.mark.parametrize("seed", range(6))
def test_an_inverse_mass_of_six_digits(seed):
    """Of a file: by its last digit it is asymmetric, and less than semidefinite; it is solved anyway."""
    rng = np.random.default_rng(seed)
    G = rng.normal(size=(9, 6))
    W, u = G @ G.T, G @ rng.normal(size=6)
    stored = np.array([[float(f"{w:.5e}") for w in row] for row in W])
    stored[0, 5] *= 1 + 1e-6
    found, exact = (carom.solve_contacts(w, u, 0.5) for w in (stored, W))
    assert found.converged
    # velocities change by W (some 1e-6 of it) times impulses
    size = np.abs(W).max() * np.abs(exact.impulse).max() + np.abs(u).max()
    assert np.abs(found.velocity - exact.velocity).max() < 1e-4 * size
