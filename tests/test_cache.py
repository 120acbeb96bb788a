"""Compiled code on disk: two processes that fill one cache at once; no place that can be written."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import carom

CODE = """
import sys, time
from carom.geometry.rotation import exp
print(repr(exp(0.1, 0.2, 0.3)), sum(exp.dispatcher.stats.cache_hits.values()))
"""


def start(cache, **more):
    return subprocess.Popen(
        [sys.executable, "-c", CODE], env={**os.environ, "NUMBA_CACHE_DIR": str(cache), **more},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


def result(process):
    out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    return out.rsplit(maxsplit=1)


def test_two_processes_at_once_and_a_broken_file(tmp_path):
    """Both compile, or one finds what the other has written; a third loads; a fourth finds files cut short.

    Files are so after a crash while they were written: the index names them.
    """
    both = [start(tmp_path) for _ in range(2)]
    values = {result(process)[0] for process in both}
    assert len(values) == 1
    value, hits = result(start(tmp_path))
    assert value in values
    assert int(hits) == 1
    data = list(tmp_path.rglob("*.nbc"))
    assert data
    for file in data:
        file.write_bytes(file.read_bytes()[:100])
    assert result(start(tmp_path)) == [value, "0"]


def test_no_place_that_can_be_written(tmp_path):
    """Files where folders should be, beside the source and in the user's place: compiled in each process."""
    package = Path(carom.__file__).parent
    shutil.copytree(package, tmp_path / "carom", ignore=shutil.ignore_patterns("__pycache__"))
    for folder in [tmp_path / "carom", *(tmp_path / "carom").rglob("*/")]:
        (folder / "__pycache__").write_text("no folder")
    blocked = tmp_path / "blocked"
    blocked.write_text("no folder")
    places = {"HOME": str(blocked), "XDG_CACHE_HOME": str(blocked), "PYTHONPATH": str(tmp_path)}
    for _ in range(2):
        value, hits = result(start(blocked / "cache", **places))
        assert value.startswith("(")
        assert int(hits) == 0


FULL = """
import resource, warnings
from carom.geometry.rotation import exp, log
hard = resource.getrlimit(resource.RLIMIT_FSIZE)[1]
with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[1]), hard))
    print(repr(exp(0.1, 0.2, 0.3)), repr(log((1.0, 0.0, 0.0, 0.0))))
    resource.setrlimit(resource.RLIMIT_FSIZE, (hard, hard))
print(len(said), *(one.message for one in said))
"""


@pytest.mark.parametrize("full", [0, 1000])
def test_a_full_disk_costs_a_recompile(full, tmp_path):
    """One warning, the right numbers, no file cut short; the next process keeps what it compiles."""
    pytest.importorskip("resource")
    child = subprocess.run(
        [sys.executable, "-c", f"import sys\n{FULL}", str(full)],
        env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}, capture_output=True, text=True, check=True,
    )  # fmt: skip
    numbers, told = child.stdout.splitlines()
    assert told.startswith("1 compiled code cannot be kept in")
    assert "File too large" in told
    assert not list(tmp_path.rglob("*.tmp.*"))
    value, hits = result(start(tmp_path))
    assert numbers.startswith(value)
    assert int(hits) == 0
    if full:  # something was written
        assert result(start(tmp_path)) == [value, "1"]


@pytest.mark.parametrize("before", ["", "exp.dispatcher"])
def test_a_folder_that_is_gone_costs_a_recompile(before, tmp_path):
    """As where a disk is taken away after the start: compiled, loaded and kept nowhere."""
    code = f"""
import shutil, sys, pathlib, warnings
from carom.geometry.rotation import exp
warnings.simplefilter("ignore")
{before}
shutil.rmtree(sys.argv[1])
pathlib.Path(sys.argv[1]).write_text("no folder")
print(repr(exp(0.1, 0.2, 0.3)))
"""
    place = tmp_path / "cache"
    place.mkdir()
    child = subprocess.run(
        [sys.executable, "-c", code, str(place)],
        env={**os.environ, "NUMBA_CACHE_DIR": str(place)}, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert child.stdout.startswith("(")


UNIT = """
from __future__ import annotations
from carom._compiled.decorators import entry, kernel
from carom._compiled.units import unit

@kernel
def factor():
    return {factor}

@unit
def half(x) -> float:
    return factor() * x

@entry
def call(x):
    return half(x) + 1.0
"""
CALL = """
import tiny
print(tiny.call(4.0), "dispatcher" in vars(tiny.factor), "compiled" in vars(tiny.half))
"""
DAMAGE = """
import pathlib, sys
import tiny
from carom._compiled.target import Dispatcher
from carom._compiled.units import digest_of
from numba.core import types

codegen = Dispatcher.targetdescr.target_context.codegen()
digest = digest_of(types.float64(types.float64))
(file,) = pathlib.Path(sys.argv[1]).rglob("tiny.half*.nbc")
whole = file.read_bytes()
good = tiny.half.files.machine(digest, codegen)
assert good.name and good.alone and tiny.half.files.machine("other", codegen) is None
first = 12 + int.from_bytes(whole[:8], "little")  # the part that is read
for k in [*range(40), *range(40, first, first // 300)]:
    file.write_bytes(whole[:k] + bytes([whole[k] ^ 8]) + whole[k + 1 :])
    assert tiny.half.files.machine(digest, codegen) is None, k
for k in range(0, first, first // 20):
    file.write_bytes(whole[:k])
    assert tiny.half.files.machine(digest, codegen) is None, k
    file.write_bytes(whole[:k] + bytes(len(whole) - k))
    assert tiny.half.files.machine(digest, codegen) is None, k
file.write_bytes(whole[:first // 2])
print("damaged")
"""


def told(code, tmp_path, place="cache"):
    """What a process prints that finds `tiny.py`; without a place its code is kept beside it."""
    path = os.pathsep.join([str(tmp_path), *sys.path])
    own = {"PYTHONPATH": path, "NUMBA_NUM_THREADS": "1"}
    own["NUMBA_CACHE_DIR"] = str(tmp_path / place) if place else ""
    child = subprocess.run(
        [sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True, check=True,
        env={**os.environ, **own},
    )  # fmt: skip
    return child.stdout.split()


def test_a_unit_is_loaded_without_the_compiler_as_long_as_its_file_is_valid(tmp_path):
    """Its file is not used if it is damaged anywhere, cut, has holes, or is that of other code."""
    (tmp_path / "tiny.py").write_text(UNIT.format(factor=0.5))
    assert told(CALL, tmp_path) == ["3.0", "True", "True"]
    for file in (tmp_path / "cache").rglob("*.nbc"):
        assert (b"BC\xc0\xde" in file.read_bytes()) == (
            "call" in file.name
        )  # LLVM code of entries alone
    assert told(CALL, tmp_path) == ["3.0", "False", "False"]
    assert told(DAMAGE, tmp_path) == ["damaged"]
    assert told(CALL, tmp_path) == ["3.0", "True", "True"]
    assert told(CALL, tmp_path) == ["3.0", "False", "False"]
    (tmp_path / "tiny.py").write_text(UNIT.format(factor=0.25))
    assert told(CALL, tmp_path) == ["2.0", "True", "True"]
    assert told(CALL, tmp_path) == ["2.0", "False", "False"]


def test_code_of_a_wheel_is_loaded_from_beside_its_source(tmp_path):
    """Where the cache is another folder, because that one cannot be written."""
    (tmp_path / "tiny.py").write_text(UNIT.format(factor=0.5))
    assert told(CALL, tmp_path, place="") == ["3.0", "True", "True"]
    assert list((tmp_path / "__pycache__").glob("*.nbc"))
    assert told(CALL, tmp_path, place="other") == ["3.0", "True", "True"]
    shipped = "from carom._compiled import cache\ncache.SHIPPED = cache.SHIPPED.parent\n"
    assert told(shipped + CALL, tmp_path, place="third") == ["3.0", "False", "False"]
    assert not list((tmp_path / "third").rglob("*.nbc"))


def test_scipy_is_loaded_where_linear_algebra_is_compiled():
    """Not for kernels, which use none: it would be a seventh of the first run of a process."""
    code = """
import sys
import numba, numpy as np
from carom.geometry.rotation import exp
exp(0.1, 0.2, 0.3)
print("scipy.linalg" in sys.modules)
a = np.array([2.0, 1.0])
print(numba.njit(lambda a, b: a @ b)(a, a) == 5.0, "scipy.linalg" in sys.modules)
"""
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.split() == ["False", "True", "True"]
