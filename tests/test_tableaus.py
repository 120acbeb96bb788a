"""Tableaus of Runge-Kutta methods satisfy the conditions of the orders that they state."""

from functools import cache
from itertools import combinations, product
from math import prod

import numpy as np
import pytest
from scipy.integrate import DOP853, RK45

from carom.model import tableaus as t

METHODS = {
    "Dormand and Prince": t.DORMAND_PRINCE,
    "Hairer": t.HAIRER,
    "Kennedy and Carpenter, implicit": t.KENNEDY_CARPENTER,
    "Kennedy and Carpenter, explicit": t.KENNEDY_CARPENTER_EXPLICIT,
    "Euler": t.CLOSING,
}


@cache
def trees(size):
    """Return the rooted trees with so many nodes, each as the sorted tuple of its branches."""
    found = set()
    for split in splits(size - 1, size - 1):
        for branches in product(*(trees(part) for part in split)):
            found.add(tuple(sorted(branches, key=repr)))
    return sorted(found, key=repr)


def splits(total, most):
    """Yield the ways to write a number as a sum, each in falling order."""
    if total == 0:
        yield ()
    for first in range(min(total, most), 0, -1):
        for rest in splits(total - first, first):
            yield (first, *rest)


def count(tree):
    return 1 + sum(map(count, tree))


def density(tree):
    """Return gamma of a tree: the number of its nodes times the densities of its branches."""
    return count(tree) * prod(map(density, tree))


def stages(tree, A):
    """Return the elementary weights of the stages: products over the branches of A times theirs."""
    return prod((A @ stages(branch, A) for branch in tree), start=np.ones(len(A)))


def worst(A, weights, order):
    """Return the greatest error of the conditions sum of b_i phi_i = 1/gamma of all trees up to an order."""
    every = (tree for size in range(1, order + 1) for tree in trees(size))
    return max(abs(weights @ stages(tree, A) - 1.0 / density(tree)) for tree in every)


def test_all_trees_are_there():
    assert [len(trees(size)) for size in range(1, 9)] == [1, 1, 2, 4, 9, 20, 48, 115]


@pytest.mark.parametrize("name", METHODS)
def test_conditions_of_order(name):
    """17 trees up to order 5, 200 up to order 8 (Butcher 1963): satisfied up to the order, not beyond."""
    one = METHODS[name]
    assert worst(one.A, one.b, one.order) < 1e-13
    assert worst(one.A, one.b, one.order + 1) > 1e-7
    assert len(one.lower) == len(one.E)
    for error, lower in zip(one.E, one.lower):
        assert worst(one.A, one.b - error, lower) < 1e-13
        assert worst(one.A, one.b - error, lower + 1) > 1e-7


def test_conditions_of_the_pair():
    """Of two functions, f and g: trees whose nodes have one of two colours, up to order 4."""
    parts = t.KENNEDY_CARPENTER.A, t.KENNEDY_CARPENTER_EXPLICIT.A
    b, lower = t.KENNEDY_CARPENTER.b, t.KENNEDY_CARPENTER.b - t.KENNEDY_CARPENTER.E[0]

    def coloured(tree):
        """Return the weights of the stages for all colours of the nodes but the root."""
        branches = [[A @ weight for A in parts for weight in coloured(one)] for one in tree]
        return [prod(one, start=np.ones(6)) for one in product(*branches)]

    for size in range(1, 5):
        for tree in trees(size):
            for weight in coloured(tree):
                assert b @ weight == pytest.approx(1.0 / density(tree), abs=1e-13)
                if size < 4:
                    assert lower @ weight == pytest.approx(1.0 / density(tree), abs=1e-13)


def test_errors_for_kinks():
    """Three errors of order 5, as long as each other and orthogonal."""
    among = np.vstack([t.HAIRER.E[:1], t.OF_KINKS])
    for error in among:
        assert worst(t.HAIRER.A, t.HAIRER.b - error, 5) < 1e-13
        assert np.linalg.norm(error) == pytest.approx(np.linalg.norm(among[0]), rel=1e-12)
    for one, other in combinations(among, 2):
        assert abs(one @ other) < 1e-13


def test_numbers_are_those_of_scipy():
    np.testing.assert_array_equal(t.HAIRER.A, DOP853.A[:12, :12])
    np.testing.assert_array_equal(t.HAIRER.b, DOP853.B)
    np.testing.assert_array_equal(t.HAIRER.E, [DOP853.E5[:-1], DOP853.E3[:-1]])
    np.testing.assert_array_equal(t.DORMAND_PRINCE.A[:6, :5], RK45.A)
    np.testing.assert_array_equal(t.DORMAND_PRINCE.b[:6], RK45.B)
    np.testing.assert_array_equal(t.DORMAND_PRINCE.E[0], RK45.E)
