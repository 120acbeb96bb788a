"""Within a run an impact is broken off where it takes more steps than are left to it."""

import numpy as np
import pytest

from carom.impact.multiple.api import solve, stated_laws
from carom.impact.multiple.layout import MULTIPLE, MultipleSettings
from carom.impact.multiple.workspace import new_multiple_workspace
from carom.law.impact_laws import NUMBERS


def strike(k, left=None):
    """Strike k contacts of random bodies; return the steps taken, those left, and the impulses."""
    random = np.random.default_rng(3)
    G, v = random.normal(size=(3 * k, 3 * k)), random.normal(size=3 * k)
    W, u = G @ G.T / k, G @ v
    u[::3] = -np.abs(u[::3])
    each = np.ones(k)
    laws = stated_laws(0.4 * each, 0.5 * each, [NUMBERS["newton"]] * k, 0 * each, each)
    settings = MultipleSettings(multiple=MULTIPLE["simultaneous"], rtol=1e-8, exponent=1.0)
    workspace = new_multiple_workspace(k)
    clock = workspace.work.clock
    if left is not None:
        clock["left"] = left
    begun = int(clock["left"][0])
    _, out = solve(W, u.reshape(k, 3), laws, settings, workspace)
    return int(out.summary[0]["steps"]), begun, int(clock["left"][0]), out.impulse.copy()


@pytest.mark.parametrize("k", [3, 8])
def test_what_is_left_is_counted(k):
    taken, begun, left, impulse = strike(k)
    assert taken > 20
    assert begun - left == taken
    enough = strike(k, left=taken)
    assert enough[2] == 0
    np.testing.assert_array_equal(enough[3], impulse)


@pytest.mark.parametrize("k", [3, 8])
def test_no_more_steps_than_are_left(k):
    """One more is taken before that is seen, in each passage of the layer that is still begun."""
    taken, _, left, _ = strike(k, left=10)
    assert left < 0
    assert taken <= 10 + 3
