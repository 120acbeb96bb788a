"""The stored data of the double pendulum are what the reference computes, and are consistent."""

import json

import numpy as np
import pytest

from references import double_pendulum_wall as reference

DATA = json.loads(reference.DATA.read_text())


@pytest.mark.parametrize("name", reference.CASES)
def test_data_can_be_made_again(name):
    stored, again = DATA["cases"][name], reference.compute(reference.CASES[name])
    assert stored["impact_time"] == pytest.approx(again["impact_time"], abs=1e-12)
    for key in ("angles", "rates_before", "contact_velocity_before"):
        np.testing.assert_allclose(stored[key], again[key], atol=1e-12)
    for law, result in stored["laws"].items():
        for key in ("rates_after", "impulse", "angles_end", "rates_end"):
            np.testing.assert_allclose(result[key], again["laws"][law][key], atol=1e-11)


@pytest.mark.parametrize("name", reference.CASES)
def test_what_the_case_is_for_and_energy(name):
    """The mode is the one named; energy falls by the works less the loss of friction."""
    case = DATA["cases"][name]
    start = [*np.radians([case["input"]["a0"], case["input"]["b0"]]), 0.0, 0.0]
    assert case["energy_before"] == pytest.approx(reference.energy(np.array(start)), abs=1e-12)
    for result in case["laws"].values():
        assert result["slip"] == name.replace("frictionless elastic", "slip")
        works = result["compression_work"] + result["restitution_work"]
        assert result["energy_change"] <= works + 1e-12
        if name == "frictionless elastic":
            assert result["energy_change"] == pytest.approx(0.0, abs=1e-12)


def test_rods_carry_the_tip():
    """Centres, turns and rates of the rods give the place and the velocity of the tip."""
    case = DATA["cases"]["stick"]
    y = np.array(case["angles"] + case["rates_before"])
    centre, velocity, turn, rate = reference.rods(y)[1]
    arm = 0.5 * np.array([-np.sin(turn), 0.0, -np.cos(turn)])  # R_y(turn) (0, 0, -1/2)
    tip_velocity = velocity + np.cross([0.0, rate, 0.0], arm)
    np.testing.assert_allclose(centre + arm, case["tip"], atol=1e-15)
    u = [-tip_velocity[0], tip_velocity[2], tip_velocity[1]]
    np.testing.assert_allclose(u, case["contact_velocity_before"], atol=1e-14)
