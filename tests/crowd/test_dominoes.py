"""Rows of dominoes: groups of many points with tolerances, and what is said of time-stepping steps."""

import pytest

import carom
from carom.results.accuracy import sentences
from carom.stepping.energy_balance import new_watch
from verified import agree, verifies


def row(n, apart):
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for i in range(n):
        pushed = 3.0 * (i == 0)  # rad/s about its lower edge
        scene.add_body(
            carom.Box(0.0075, 0.024, 0.048), mass=0.01, position=(apart * i, 0, 0.024),
            angular_velocity=(0, pushed, 0), velocity=(0.024 * pushed, 0, 0.00375 * pushed),
        )  # fmt: skip
    scene.set_contact_default(friction=0.3, restitution=0.0)
    return scene


@verifies("simulate(rtol=)", "a row of dominoes by two tolerances", "invariant")
@pytest.mark.parametrize(("n", "end"), [(8, 0.5), (10, 0.5), (12, 0.58)])
def test_a_row_moves_from_event_to_event(n, end):
    # 32 to 48 points on the floor, of bodies that are groups of their own until they meet. Two tolerances
    # agree to 1e-11 m; time-stepping steps, which it took before, were .4 mm off. Fourteen may touch at 145
    # points and more at once, which is a crowd: in one of 31 runs by nearby tolerances
    places = [carom.simulate(row(n, 0.02), end, rtol=rtol, save_at=end) for rtol in (1e-8, 1e-10)]
    assert all(s.stats["whole_steps"] == 0 and not s.warnings for s in places)
    agree(places[0].position[-1], places[1].position[-1], atol=10 * 0.05 * 1e-8)


def test_what_a_crowd_is_off_is_said():
    # twenty bodies that end in one group: their time-stepping steps have impacts at their ends
    solution = carom.simulate(row(20, 0.012), 0.4, throw=False, save_at=0.4)
    said = [one for one in solution.warnings if "misplaced by up to" in one]
    assert (len(said) > 0) == (solution.stats["whole_steps"] > 0)
    watch = new_watch(1e-4)[0]
    assert not sentences(watch, "")
    watch.astray, watch.astray_size = 30.0, 3e-7
    assert ["30 times the tolerance" in one for one in sentences(watch, "")] == [True]
