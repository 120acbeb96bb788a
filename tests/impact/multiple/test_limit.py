"""Within a run an impact is broken off where it takes more steps than are left to it."""

import numpy as np
import pytest

from carom.impact.multiple.api import stated_laws
from carom.impact.multiple.layout import (
    MULTIPLE,
    CornerContacts,
    MultipleSettings,
    new_multiple_result,
    new_multiple_workspace,
)
from carom.impact.multiple.resolve import resolve_multiple
from carom.law.impact_laws import NUMBERS


def strike(k, left=None):
    """Strike k contacts of random bodies; return the steps taken, those left, and the impulses."""
    random = np.random.default_rng(3)
    G, v = random.normal(size=(3 * k, 3 * k)), random.normal(size=3 * k)
    W, u = G @ G.T / k, G @ v
    u[::3] = -np.abs(u[::3])
    each = np.ones(k)
    laws = stated_laws(0.4 * each, 0.5 * each, [NUMBERS["newton"]] * k, 0 * each, each)
    contacts = CornerContacts(
        k, 0, W, u, 0.4 * each, 0.5 * each, np.arange(k), each, np.zeros(k, dtype=np.int64), laws
    )
    settings = MultipleSettings(multiple=MULTIPLE["simultaneous"], rtol=1e-8, exponent=1.0)
    out, workspace = new_multiple_result(k), new_multiple_workspace(k)
    clock = workspace.work.clock
    if left is not None:
        clock["left"] = left
    begun = int(clock["left"][0])
    resolve_multiple(contacts, settings, workspace, out)
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
