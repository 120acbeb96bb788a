"""For all tests: what is compiled on the way is not spoken of, and random examples are the same in each run.

``HYPOTHESIS_PROFILE=search pytest ...`` looks for others. ``CAROM_TEST_NUDGE=1 pytest ...`` moves all bodies
by a unit in the last place (`nudge.py`).
"""

import os

from hypothesis import settings

import nudge
from carom._compiled import notice

notice.silence()  # tests look at what is on stderr
settings.register_profile("same", derandomize=True)
settings.register_profile("search", derandomize=False)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))
nudge.choose_tenth()  # before other processes of the run begin
nudge.begin()


def pytest_collection_modifyitems(config, items):
    """Leave out what a lane does not run."""
    left_out = [item for item in items if not nudge.is_chosen(item)]
    items[:] = [item for item in items if nudge.is_chosen(item)]
    config.hook.pytest_deselected(items=left_out)
