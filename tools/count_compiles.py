"""Compile everything in one process, from nothing, and count: functions, compiles, processor time.

    python tools/count_compiles.py

Each function should be compiled once; those that are not are listed. Takes some minutes.
"""

from __future__ import annotations

import gc
import os
import sys
import tempfile
import time
import warnings


def compile_everything() -> None:
    """Compile what `carom warmup` does, in this process."""
    from carom.cli import warmup

    asked, known = set(), set()
    for kinds in warmup.TOGETHER:
        asked |= warmup.compile_kinds(kinds)[1]
    while asked - known:
        more, known = sorted(asked - known, key=str), known | asked
        asked |= warmup.compile_units(more)


def main() -> int:
    """Count; return 1 if a function was compiled twice."""
    with tempfile.TemporaryDirectory() as place:
        os.environ["NUMBA_CACHE_DIR"] = place
        warnings.simplefilter("ignore")
        from carom._compiled.ahead import do_without

        do_without()
        begin = time.process_time()
        compile_everything()
        spent = time.process_time() - begin
        from carom._compiled.target import Dispatcher

        made = [one for one in gc.get_objects() if type(one) is Dispatcher and one.overloads]
        compiles = sum(len(one.overloads) for one in made)
        print(f"{len(made)} functions, {compiles} compiles, {spent:.0f} s of processor time")
        for one in made:
            if len(one.overloads) > 1:
                print(
                    f"{len(one.overloads)} times: {one.py_func.__module__}.{one.py_func.__name__}"
                )
    return int(compiles > len(made))


if __name__ == "__main__":
    sys.exit(main())
