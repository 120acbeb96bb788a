"""Every number of the table meets its tolerance; references are those of other computations."""

import numpy as np
import pytest

from carom.paper import references, table
from carom.paper.runs import FRICTIONS, die_run


@pytest.fixture(scope="module")
def rows():
    return table.rows()


def test_every_error_is_within_its_tolerance(rows):
    for row in rows:
        for error in row.errors:
            assert error is None or error <= row.tolerance, row


def test_both_methods_are_in_the_table(rows):
    assert len(rows) > 35
    assert all(row.values[0] is not None for row in rows)
    assert sum(row.values[1] is not None for row in rows) > 30


def test_seven_steps_are_counted():
    found = {row[0]: row for row in table.hht_rows()}
    assert found[0.0][1] == 7
    assert found[0.0][2:] == pytest.approx([2.63, 0.158, 3.6e-2, 8.9e-3, 5.5e-4], rel=0.02)
    assert all(row[-1] < 1e-3 for row in found.values())


PLANAR = {
    0.05: (0.366147612250, 0, 0.252217924424, 0, -181.829966521, 0),
    0.20: (-0.104880400909, 0, 0.599572173967, 0, -117.861175844, 0),
}
SPATIAL = {
    0.05: (0.528582186665, -0.062722126057, -0.905573683307,
           148.79895691882, 156.217108451561, 3.438362364711),
    0.20: (0.678863048248, -0.263769625030, -0.687689304340,
           127.057987913752, 145.507049743080, 8.551262343217),
}  # fmt: skip


@pytest.mark.parametrize("mu", FRICTIONS)
def test_references_meet_published_digits(mu):
    """Computed elsewhere, to the digits given."""
    assert references.die_impact("planar").time == pytest.approx(0.196210991904, abs=1e-12)
    assert references.die_impact("spatial").time == pytest.approx(0.195621524091, abs=1e-12)
    assert references.die_after("planar", mu) == pytest.approx(PLANAR[mu], abs=1e-9)
    assert references.die_after("spatial", mu) == pytest.approx(SPATIAL[mu], abs=2e-9)


def test_bounce_in_closed_form():
    bounce = references.Bounce(0.8)
    times = (0.285568625, 0.742478424, 1.108006263, 1.400428535, 1.634366352, 1.821516606)
    assert bounce.times(6) == pytest.approx(times, abs=1e-9)
    assert bounce.rest == pytest.approx(2.570117621269, abs=1e-12)
    height, velocity = bounce.motion(np.array([0.0, bounce.rest + 0.1]))
    assert height == pytest.approx([0.4, 0.0])
    assert velocity == pytest.approx([0.0, 0.0])


def test_spline_steps_converge():
    from carom.paper.spatial import velocity_error

    errors = [velocity_error(steps, 0.05) for steps in (16, 64, 256)]
    assert errors[0] < 1e-5
    assert errors[2] < 1e-9
    assert np.log2(errors[1] / errors[2]) / 2 == pytest.approx(4.0, abs=0.5)


def test_horizontal_velocity_reverses():
    signs = [np.sign(die_run(mu, "planar").velocity[-1, 0, 0]) for mu in FRICTIONS]
    assert signs == [1.0, -1.0]


def test_slip_of_the_spatial_die_stops_only_above_the_limit():
    """What the page says of Fig. 6b: 0.497453 holds the corner; outgoing direction below it."""
    import carom
    from carom.impact.slip_directions import critical_friction, invariant_directions

    record = die_run(0.2, "spatial").impacts[0]
    W, u = record.inverse_mass, record.relative_velocity_before
    assert critical_friction(W) == pytest.approx(0.497453, abs=1e-6)
    for mu, sticks in ((0.05, False), (0.2, False), (0.6, True)):
        assert ("stick" in carom.resolve_impact(W, u, mu, 0.5).phases) == sticks
    for mu in FRICTIONS:
        rays = invariant_directions(W, mu)
        assert sorted(rays.outgoing) == [False, True]
        assert np.cos(2 * rays.angle) == pytest.approx([0.0, 0.0], abs=1e-9)
