"""How values are drawn."""

import numpy as np
import pytest
from scipy.stats import norm, uniform

from carom.studies.ensembles.sampling import SAMPLING, UniformOrientation, draw
from verified import agree, verifies


@verifies(
    "UniformOrientation",
    r"$\mathrm E[q q^T] = \tfrac14 I$, $\mathrm E[\cos\vartheta] = -\tfrac12$",
    "closed form",
)
def test_orientations_prefer_none():
    """E[q q^T] = 1/4 of the identity, and the angle t has the density (1 - cos t)/pi: E[cos t] = -1/2."""
    Q = draw({"q": UniformOrientation()}, 2**14, 1, "sobol")["q"]
    agree(np.linalg.norm(Q, axis=1), 1.0, atol=1e-15)
    agree(Q.T @ Q / len(Q), np.eye(4) / 4, atol=2e-3)
    cosine = 2.0 * Q[:, 0] ** 2 - 1.0
    agree(cosine.mean() + 0.5, 0.0, atol=2e-3)
    # a fixed direction goes to all directions alike: thirds of cos have a third each
    z = 1.0 - 2.0 * (Q[:, 1] ** 2 + Q[:, 2] ** 2)
    agree(np.histogram(z, 3, (-1, 1))[0] / len(z), 1 / 3, atol=3e-3)


@pytest.mark.parametrize("sampling", SAMPLING)
def test_each_distribution_is_met(sampling):
    drawn = draw({"a": norm(2.0, 3.0), "b": [uniform(1, 4), 7.0, norm(0, 1)]}, 4096, 5, sampling)
    assert drawn["a"].shape == (4096,)
    assert drawn["b"].shape == (4096, 3)
    assert np.all(drawn["b"][:, 1] == 7.0)
    error = 5.0 / np.sqrt(4096)  # five standard errors of a random sample
    assert abs(drawn["a"].mean() - 2.0) < 3.0 * error
    assert abs(drawn["a"].std() - 3.0) < 3.0 * error
    assert abs(drawn["b"][:, 0].mean() - 3.0) < 1.2 * error
    assert abs(np.corrcoef(drawn["a"], drawn["b"][:, 2])[0, 1]) < error


@pytest.mark.parametrize("sampling", SAMPLING)
def test_the_seed_decides(sampling):
    spec = {"a": uniform(0, 1), "q": UniformOrientation()}
    one, two, other = (draw(spec, 10, seed, sampling) for seed in (3, 3, 4))
    assert all(np.array_equal(one[name], two[name]) for name in spec)
    assert not np.array_equal(one["a"], other["a"])


def test_points_that_fill_the_space_do_better():
    """The mean of 2^10 points of a line: off by 1/sqrt(12 n) at random, by less than 1/n evenly spread."""
    for sampling in ("sobol", "latin", "halton"):
        mean = draw({"a": uniform(0, 1)}, 1024, 7, sampling)["a"].mean()
        assert abs(mean - 0.5) < 1.0 / 1024
