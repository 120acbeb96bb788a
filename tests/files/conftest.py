"""Runs that the tests of files share."""

import pytest

import carom
from files.scenes import pendulum, slider
from simulate.scenes import die


@pytest.fixture(scope="session")
def thrown():
    """A die that has struck the plane twice."""
    return carom.simulate(die(), 0.25, step=5e-3)


@pytest.fixture(scope="session")
def slid():
    """A block that slides and stops."""
    return carom.simulate(slider(), 0.3, step=5e-3)


@pytest.fixture(scope="session")
def swung():
    """A chain that strikes its stop; held there with order 2, it loses .3 % at this step."""
    allowed = carom.Options(energy_tolerance=0.01)
    return carom.simulate(pendulum(), 1.0, step=2e-2, options=allowed)


RUNS = ["thrown", "slid", "swung"]


@pytest.fixture(params=RUNS)
def run(request):
    """Each of them."""
    return request.getfixturevalue(request.param)


@pytest.fixture(scope="session")
def saved(thrown, slid, swung, tmp_path_factory):
    """The bytes of their files."""
    file, found = tmp_path_factory.mktemp("saved") / "run.nc", {}
    for name, one in zip(RUNS, (thrown, slid, swung)):
        one.save(file)
        found[name] = file.read_bytes()
    return found


@pytest.fixture
def path(saved, tmp_path):
    """The file of a run."""
    (tmp_path / "run.nc").write_bytes(saved["thrown"])
    return tmp_path / "run.nc"
