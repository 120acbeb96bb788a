"""Derivatives of whole throws against differences of whole throws.

Differences of order 6 with two steps, a factor 4 apart: the nearer one is taken. Their own error is what the
location of impacts leaves (1e-13 of the size) over the step, amplified by the throw as its derivative is.
"""

import numpy as np
import pytest

import carom

from .thrown import FORWARD, NAMES, SCALE, UNEQUAL, derivative, difference, throw

CASES = {
    "equal moments, slip": {},
    "unequal moments, slip": {"inertia": UNEQUAL, "law": "stronge"},
    "unequal moments, stick": {"inertia": UNEQUAL, "mu": 1.2},
    "poisson, stick": {"mu": 0.6, "law": "poisson", "duration": 0.15},
    "no friction, elastic": {"inertia": UNEQUAL, "mu": 0.0, "e": 1.0},
    "without spin": {"inertia": UNEQUAL, "mu": 0.05, "spin": (0, 0, 0), "duration": 0.15},
}


@pytest.mark.parametrize("case", CASES)
def test_derivatives_are_those_of_differences(case):
    values = CASES[case]
    reference = throw(**values)
    found = carom.sensitivities(reference, NAMES)
    assert 1 <= len(reference.impacts) <= 4
    assert found.defect < 1e-8  # of order 4 in the step of 0.25 ms
    assert np.all(found.impact_error < 1e-8)
    exact = derivative(found)
    # compared in the units of SCALE, each vector of the outcome by its greatest derivative
    K = len(reference.impacts)
    number = np.concatenate([np.arange(12) // 3, 4 + np.arange(K), 4 + K + np.arange(12 * K) // 3])
    scaled = np.max(np.abs(exact * SCALE), axis=1)
    size = np.array([scaled[number == i].max() for i in number])[:, None] / SCALE
    compared = 0
    for k in range(len(SCALE)):
        edge = (k == 19 and values.get("e") == 1.0) or (k == 20 and values.get("mu") == 0.0)
        errors = [np.inf]
        for part in (2e-3, 5e-4):
            if errors[-1] < 1e-6:
                continue  # near enough
            step = min(part * SCALE[k], 0.04 * found.reach[k])
            if edge:  # e = 1 and mu = 0 have one side only
                step = -step if k == 19 else step
                quotient = difference(lambda z: throw(z, **values), reference, k, step, FORWARD)
            else:
                quotient = difference(lambda z: throw(z, **values), reference, k, step)
            if quotient is not None:
                errors.append(np.max(np.abs(quotient - exact[:, k]) / size[:, k]))
        if len(errors) > 1:
            compared += 1
            assert min(errors) < 1e-6, (found.labels[k], errors)
    assert compared == len(SCALE)
