"""Dense L D L^T in place, against NumPy."""

import numpy as np
import pytest

from carom._compiled.decorators import entry
from carom.friction.ldl import factor, factor_by_pivots, substitute


@entry
def solve_in_place(A, n, drop, x):
    factor(n, drop, A)
    substitute(n, A, x)


@entry
def factor_in_place(A, n, least, rows):
    return factor_by_pivots(n, least, rows, A)


@pytest.mark.plain
@pytest.mark.parametrize("n", [1, 3, 8])
def test_leading_part(n):
    random = np.random.default_rng(n)
    G, x = random.normal(size=(n + 2, n + 2)), random.normal(size=n + 2)
    A, y = G @ G.T, x.copy()
    B = A.copy()
    solve_in_place(B, n, 1e-12, y)
    # condition of G G^T of this size: up to 1e5
    np.testing.assert_allclose(y[:n], np.linalg.solve(A[:n, :n], x[:n]), rtol=1e-9)
    assert np.all(y[n:] == x[n:])
    assert np.all(B[n:] == A[n:])


@pytest.mark.plain
def test_rows_that_depend_on_others_get_nothing():
    """Four rows of rank two: the solution solves all equations, as their right-hand side fits."""
    G = np.random.default_rng(0).normal(size=(4, 2))
    A = G @ G.T
    b = A @ np.array([1.0, -2.0, 0.5, 3.0])
    x = b.copy()
    solve_in_place(A.copy(), 4, 1e-10, x)
    assert np.count_nonzero(x) == 2
    np.testing.assert_allclose(A @ x, b, rtol=1e-9)


@pytest.mark.plain
@pytest.mark.parametrize("rank", [0, 1, 3, 5])
def test_the_rows_of_pivots_span_all_others(rank):
    """Scaled by .1 to 10, and one row of zeros first: A in the order of the rows is L D L^T."""
    random = np.random.default_rng(rank)
    G = 10.0 ** np.linspace(-1.0, 1.0, 6)[:, None] * random.normal(size=(6, rank))
    G[0] = 0.0
    A = G @ G.T
    B, rows, largest = A.copy(), np.arange(6), np.max(A, initial=0.0)
    assert factor_in_place(B, 6, 1e-12 * largest, rows) == rank
    assert sorted(rows) == list(range(6))
    L, D = np.tril(B, -1)[:, :rank] + np.eye(6)[:, :rank], np.diag(B)[:rank]
    assert np.all(np.abs((L * D) @ L.T - A[np.ix_(rows, rows)]) <= 1e-12 * largest)


@pytest.mark.plain
def test_round_off_does_not_say_which_row_is_left_out():
    """Four corners alike, of rank three: the last one goes, whatever the last digits are."""
    G = np.array([[1.0, x, y] for x in (-1.0, 1.0) for y in (-1.0, 1.0)])
    A = G @ G.T
    for seed in range(20):
        random = np.random.default_rng(seed)
        B, rows = A * (1.0 + 1e-15 * random.normal(size=4)), np.arange(4)
        assert factor_in_place(0.5 * (B + B.T), 4, 1e-10, rows) == 3
        assert rows[3] == 3
