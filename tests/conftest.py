"""For all tests: what is compiled on the way is not spoken of, and random examples are the same in each run.

``HYPOTHESIS_PROFILE=search pytest ...`` looks for others.
"""

import os

from hypothesis import settings

from carom._compiled import notice

notice.silence()  # tests look at what is on stderr
settings.register_profile("same", derandomize=True)
settings.register_profile("search", derandomize=False)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))
