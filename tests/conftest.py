"""For all tests: what is compiled on the way is not spoken of, and random examples are the same in each run.

No process starts a second one that compiles for it: all processors have work, and both would compile the same
kernels.

``HYPOTHESIS_PROFILE=search pytest ...`` looks for others. ``CAROM_TEST_NUDGE=1 pytest ...`` moves all bodies
by a unit in the last place (`nudge.py`). ``pytest --verified FILE`` writes what tests verify (`verified.py`).
"""

import gc
import os
import sys

os.environ["NUMBA_NUM_THREADS"] = "1"  # before Numba is imported; for child processes too

import pytest
from hypothesis import settings

import nudge
from carom._compiled import notice
from verified import (  # noqa: F401, hooks
    pytest_addoption,
    pytest_runtest_call,
    pytest_runtest_logreport,
    pytest_sessionfinish,
)

notice.silence()  # tests look at what is on stderr
settings.register_profile("same", derandomize=True)
settings.register_profile("search", derandomize=False)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))
nudge.begin()
gc.set_threshold(50_000, 20, 100)  # a tenth of the time was spent on a search for garbage in cycles


@pytest.fixture(autouse=True)
def _closed_figures():
    """Close the figures of each test: pyplot warns of more than twenty, whichever test opened them."""
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


@pytest.hookimpl(tryfirst=True)  # before ``-m "not slow"``
def pytest_collection_modifyitems(config, items):
    """Leave out what a lane does not run; of a family marked ``few(n)`` all but n, evenly spaced, are slow."""
    families = {}
    for item in items:
        if mark := item.get_closest_marker("few"):
            families.setdefault((item.path, item.originalname), (mark.args[0], []))[1].append(item)
    for count, cases in families.values():
        last = len(cases) - 1
        chosen = {round(k * last / max(count - 1, 1)) for k in range(count)}
        for k, item in enumerate(cases):
            if k not in chosen:
                item.add_marker(pytest.mark.slow)
    bits = {item for item in items if item.get_closest_marker("bits")}
    left_out = {item for item in items if not nudge.is_chosen(item.path, item.name, item in bits)}
    left_out |= bits if nudge.units() else set()
    items[:] = [item for item in items if item not in left_out]
    config.hook.pytest_deselected(items=list(left_out))


def pytest_collection_finish(session):
    """Look for no garbage in what is imported and collected: it stays to the end."""
    gc.freeze()


def pytest_ignore_collect(collection_path):
    """Import no file of another tenth."""
    return None if nudge.is_chosen(collection_path) else True
