"""Runs that the tests of plots and films share."""

import matplotlib
import pytest

import carom
from carom import GeneralizedSystem
from files.scenes import pendulum, slider
from simulate.scenes import die


@pytest.fixture(autouse=True)
def figures():
    """Draw without a display, and close what a test has opened."""
    matplotlib.use("Agg")
    yield
    import matplotlib.pyplot as plt

    plt.close("all")


@pytest.fixture(scope="session")
def thrown():
    """A die that has struck the plane twice."""
    return carom.simulate(die(), 0.25, step=5e-3)


@pytest.fixture(scope="session")
def flown():
    """A die that has not yet reached the plane."""
    return carom.simulate(die(), 0.05, step=5e-3)


@pytest.fixture(scope="session")
def slid():
    """A block that slides and stops."""
    return carom.simulate(slider(), 0.3, step=5e-3)


@pytest.fixture(scope="session")
def swung():
    """A chain that strikes its stop; held there with order 2, it loses .3 % at this step."""
    allowed = carom.Options(energy_tolerance=0.01)
    return carom.simulate(pendulum(), 1.0, step=2e-2, options=allowed)


@pytest.fixture(scope="session")
def bounced():
    """A point in coordinates that bounces on a floor, from 0.5 with e = 0.5."""
    system = GeneralizedSystem(
        lambda q: [[1.0, 0.0], [0.0, 1.0]], [0.0, 0.5], [1.0, 0.0], potential=lambda q: 9.81 * q[1]
    )
    system.add_contact(
        lambda q: q[1], tangent=lambda q: [1.0, 0.0], restitution=0.5, friction=0.2, name="floor"
    )
    return carom.simulate(system, 0.6, step=1e-2)
