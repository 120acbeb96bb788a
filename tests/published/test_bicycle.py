"""The bicycle of Meijaard, Papadopoulos, Ruina and Schwab: its modes, and the speeds at which it stays up."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def made():
    picture = runpy.run_path(str(ROOT / "docs" / "pictures" / "bicycle.py"))
    return picture["published"], picture["page"]()


def test_the_equations_are_those_that_were_published(made):
    """Values of the paper: modes at 5 m/s, and the two critical speeds."""
    published, _ = made
    np.testing.assert_allclose(
        published(5.0),
        [
            -14.07838969279822,
            -0.77534188219585 - 4.46486771378823j,
            -0.77534188219585 + 4.46486771378823j,
            -0.32286642900409,
        ],
        rtol=1e-12,
    )
    weave, capsize = 4.29238253634111, 6.02426201538837
    assert abs(published(weave).real[2]) < 1e-11
    assert abs(np.linalg.norm(published(capsize)[-1])) < 1e-11


@pytest.mark.parametrize("speed", [0.5, 2.0, 3.5, 5.0, 8.0])
def test_modes_are_those_of_the_equations(made, speed):
    published, page = made
    found = page["modes"](speed, size=1e-5, every=0.02 if speed > 5 else 0.05)
    np.testing.assert_allclose(
        found, published(speed), rtol=0, atol=2e-7 * abs(published(speed)[0])
    )


def test_the_speeds_between_which_it_stays_up(made):
    _, page = made

    def weave(speed):
        modes = page["modes"](speed)
        return modes[abs(modes.imag) > 0.5].real.max()

    def capsize(speed):
        modes = page["modes"](speed, every=0.1)
        return modes[abs(modes.imag) < 0.5].real.max()

    assert brentq(weave, 4.2, 4.4, xtol=1e-10) == pytest.approx(4.29238253634111, abs=2e-8)
    assert brentq(capsize, 5.9, 6.1, xtol=1e-10) == pytest.approx(6.02426201538837, abs=2e-7)
