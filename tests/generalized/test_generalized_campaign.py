"""The short form of benchmarks/campaigns/coordinates.py: rods, tables, pucks, rows, loops, charts, sleighs."""

import pytest

from campaigns import coordinates
from campaigns.case import run


@pytest.mark.few(2)
@pytest.mark.parametrize("tolerances", [False, True])
@pytest.mark.parametrize("first", range(0, 36, 6))
def test_systems_end_and_lose_nothing_without_a_name(first, tolerances):
    # What 1400 others met: none ends early, sinks or gains; given steps leave 2e-5 without a name at most.
    for seed in range(first, first + 6):
        found = run(coordinates.case(seed), tolerances)
        assert found.status == "SUCCESS", seed
        assert found.reached == 1.0, seed
        assert found.depth <= 1e-8, seed
        assert found.residual <= 2e-4, seed
        assert found.gained <= 1e-6, seed
        assert found.whole == 0, seed
