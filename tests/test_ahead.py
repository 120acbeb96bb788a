"""A second process compiles what the first one is about to need; of several processes one compiles."""

from __future__ import annotations

import os
import subprocess
import sys
import time

import pytest
from numba.core import config, types

from carom._compiled import ahead, units
from carom._compiled.file_lock import FileLock

compiled = pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")

TINY = """from __future__ import annotations

from carom._compiled.units import unit

@unit
def half(x) -> float:
    return 0.5 * x
"""


def patient(holds, seconds: float = 60.0) -> bool:
    """Return whether something holds within some time."""
    end = time.monotonic() + seconds
    while not holds() and time.monotonic() < end:
        time.sleep(0.02)
    return holds()


def test_a_lock_is_held_by_one(tmp_path):
    here, there = FileLock(tmp_path / "a.lock"), FileLock(tmp_path / "a.lock")
    assert here.try_to_take()
    assert there.is_taken()
    assert not there.try_to_take()
    seen = []

    def work():  # what is done meanwhile; at its third call the lock is given back
        seen.append(1)
        if len(seen) == 3:
            here.release()
        return True

    assert there.take(work)
    assert len(seen) == 3
    assert not there.is_taken()
    assert here.is_taken()
    there.release()
    assert not list(tmp_path.iterdir())
    assert not here.take(work)  # nobody to wait for
    FileLock.release_all()
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(os.name != "posix", reason="elsewhere processes are not looked for")
def test_a_lock_of_a_process_that_died_is_taken_over(tmp_path):
    gone = subprocess.run(
        [sys.executable, "-c", "import os; print(os.getpid())"], capture_output=True
    )
    (tmp_path / "a.lock").write_text(gone.stdout.decode().strip())
    lock = FileLock(tmp_path / "a.lock")
    assert not lock.take(lambda: False)
    assert (tmp_path / "a.lock").read_text() == str(os.getpid())
    lock.release()


def test_where_no_file_can_be_made_nobody_waits(tmp_path):
    lock = FileLock(tmp_path / "no" / "folder" / "a.lock")
    assert not lock.take(lambda: False)
    lock.release()


@compiled
def test_what_a_thrown_body_needs_are_units():
    for name in ahead.FIRST:
        assert units.find(name) is units.UNITS[name]


@compiled
def test_the_second_process_compiles_what_it_is_told_and_ends_with_the_first(tmp_path):
    (tmp_path / "tiny.py").write_text(TINY)
    path = os.pathsep.join([str(tmp_path), *sys.path])
    process = subprocess.Popen(
        [sys.executable, "-c", "from carom._compiled.ahead import serve; serve()"],
        env={**os.environ, "PYTHONPATH": path, "NUMBA_CACHE_DIR": str(tmp_path / "cache")},
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert process.stdin is not None
    try:
        wrong = units.pack((types.unicode_type,))  # cannot be compiled, and stops nothing
        for packed, name in ((wrong, "tiny:missing"), (units.pack((types.float64,)), "tiny:half")):
            process.stdin.write(f"{name} {packed.hex()}\n".encode())
        process.stdin.flush()
        assert patient(lambda: bool(list(tmp_path.rglob("tiny.half*.nbc"))))
        process.stdin.close()
        assert process.wait(60) == 0
    finally:
        process.kill()
        process.wait()
        for pipe in (process.stdin, process.stdout, process.stderr):
            assert pipe is not None
            pipe.close()
    assert not list(tmp_path.rglob("*.lock"))
