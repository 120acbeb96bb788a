"""A lane that moves the bodies of all scenes by units in the last place, as another processor would.

``CAROM_TEST_NUDGE=1 pytest ...`` (or -1, 3) moves masses, moments of inertia and velocities of all bodies by
that many units in the last place, where a scene becomes arrays: behind the checks of arguments, and before
anything is computed from them. A test that this fails hangs on round-off, and so on the processor, the C
library, and the versions of NumPy and BLAS. Tests of bits, of what a part keeps, and of other processes
are marked ``bits`` and left out. ``CAROM_TEST_TENTH=0`` to ``9`` runs a tenth of the files, whose tests share
their scenes; others are not imported. ``CAROM_TEST_ALL_BUT=0`` to ``9`` runs what is left: all others, and of
that tenth what is marked ``bits``. So two lanes run each test once.
"""

from __future__ import annotations

import os
from pathlib import Path
from zlib import crc32

import numpy as np

UNITS = "CAROM_TEST_NUDGE"
TENTH = "CAROM_TEST_TENTH"
ALL_BUT = "CAROM_TEST_ALL_BUT"
ROOT = Path(__file__).parent


def units() -> int:
    """Return by how many units in the last place bodies are moved; 0 outside the lane."""
    return int(os.environ.get(UNITS) or 0)


def moved(values: np.ndarray, by: int) -> np.ndarray:
    """Return an array whose numbers are larger in size by some units in the last place; zeros stay."""
    away = np.copysign(np.inf if by > 0 else 0.0, values)
    for _ in range(abs(by)):
        values = np.where(values == 0.0, values, np.nextafter(values, away))
    return values


def begin() -> None:
    """Move the bodies of all scenes that are compiled from here on."""
    by = units()
    if not by:
        return
    from carom.model import compile as compiling

    start_of, bodies_of = compiling._start, compiling._bodies

    def start(scene):
        state, to_principal, moments = start_of(scene)
        for name in ("v", "w"):
            state[name] = moved(state[name], by)
        return state, to_principal, moved(moments, by)

    def bodies(*given):
        made = bodies_of(*given)
        made["mass"] = moved(made["mass"], by)
        return made

    compiling._start, compiling._bodies = start, bodies


def is_chosen(path: Path, name: str = "", bits: bool = False) -> bool:
    """Return whether a folder, a file or a test is run.

    Files in folders are taken whole. Those beside the folders walk over examples and pages, and are taken test
    by test. Without a name the answer is whether the file has tests that may be run.
    """
    if not path.name.startswith("test_"):
        return True
    beside, tenth, all_but = path.parent == ROOT, os.environ.get(TENTH), os.environ.get(ALL_BUT)
    part = crc32((path.relative_to(ROOT).as_posix() + (name if beside else "")).encode()) % 10
    if tenth is not None:
        return part == int(tenth) or (beside and not name)
    return all_but is None or part != int(all_but) or bits or not name
