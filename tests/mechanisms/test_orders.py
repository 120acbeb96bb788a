"""The order of convergence of every method, on the pendulum in elliptic functions."""

import numpy as np
import pytest
from mechanism_scenes import orders, pendulum
from test_pendulum import exact, tip

import carom
from carom.dynamics.methods import METHODS
from verified import agree, verifies

#: methods of order 2 miss the energy at these steps, and say so
pytestmark = pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")

#: longest step by order [s]: errors are between 1e-4 and 1e-11 there, far from round-off and in the regime h^p
STEP = {1: 1e-3, 2: 0.01, 3: 0.01, 4: 0.01, 5: 0.02, 6: 0.025, 7: 0.04, 8: 0.05}


@verifies(
    'method="{method}"',
    "at least its order of convergence, for a pendulum in elliptic functions",
    "closed form",
)
@pytest.mark.parametrize("method", METHODS)
def test_method_has_the_order_that_it_says(method):
    order, errors = METHODS[method].order, []
    for h in (STEP[order], STEP[order] / 2):
        s = carom.simulate(pendulum("Revolute"), 2.0, step=h, method=method)
        errors.append(np.max(np.abs(tip(s, "Revolute")[-1] - exact(2.0))))
    agree(min(orders(errors)[0], order), order, atol=0.35)
