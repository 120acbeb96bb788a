"""For all tests: what is compiled on the way is not spoken of, and random examples are the same in each run.

No process starts a second one that compiles for it: all processors have work, and both would compile the same
kernels.

``HYPOTHESIS_PROFILE=search pytest ...`` looks for others.
"""

import os

os.environ["NUMBA_NUM_THREADS"] = "1"  # before Numba is imported, here and in processes that tests start

from hypothesis import settings

from carom._compiled import notice

notice.silence()  # tests look at what is on stderr
settings.register_profile("same", derandomize=True)
settings.register_profile("search", derandomize=False)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "same"))
