"""Runs and the browser that the tests of viewers share."""

import pytest

import carom
from files.scenes import slider
from simulate.scenes import die
from viewer.browser import Browser


@pytest.fixture(scope="session")
def thrown():
    """A die that turns about no axis of its own and strikes the plane, saved every 5 ms."""
    return carom.simulate(die(spin=(10, 10, 0), mu=0.2), 0.25, step=5e-3)


@pytest.fixture(scope="session")
def slid():
    """A block that slides and stops."""
    return carom.simulate(slider(), 0.3, step=5e-3)


@pytest.fixture(scope="session")
def swung():
    """A rod without a shape that falls about a hinge onto its stop."""
    scene = carom.Scene()
    rod = scene.add_body(mass=1, inertia=(1e-3, 1 / 12, 1 / 12), position=(0.5, 0, 0), name="rod")
    hinge = scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, rod)
    scene.add_stop(hinge, upper=1.2, restitution=0.5, name="stop")
    return carom.simulate(scene, 1.0, step=2e-2, method="rk8")


@pytest.fixture(scope="session")
def browser(tmp_path_factory):
    """A chromium for all tests."""
    one = Browser(tmp_path_factory.mktemp("chromium"))
    yield one
    one.close()
