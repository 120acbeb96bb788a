"""Machine code of the user's functions on disk: that of the same function, and never of another one."""

import functools
import math
import os
import subprocess
import sys
import types
from typing import Any

import numba
import numpy as np
import pytest
from numba import njit
from numba.extending import overload

from carom._compiled import kept_code, user_functions
from carom._compiled.composed import plainly
from carom._compiled.snapshot import NotKept, Snapshot

SOURCE = """
def deep(x):
    return {deep}

def function(t, x, more=DEFAULT):
    near = OUTER
    return deep(x[0]) + K * t + {body} + table[1] + tools.shift + more + near + tools.inner(t)
"""
VALUES = {"K": 3.0, "OUTER": 0.5, "DEFAULT": 0.25}


def made(
    deep="x * x",
    body="math.sin(t)",
    inner=2.0,
    shift=1.0,
    table=(0.0, 4.0),
    options: Any = None,
    **values,
):
    """Return a function with a compiled callee, constants, an array, a module of the user's and a default."""
    space = {**VALUES, **values, "math": math, "__name__": "notebook", "table": np.array(table)}
    tools: Any = types.ModuleType("tools")
    space["tools"] = tools
    tools.shift, tools.other = shift, []
    tools.inner = njit(eval(f"lambda t: {inner} * t"))
    exec(SOURCE.format(deep=deep, body=body), space)
    compiler: Any = njit
    space["deep"] = compiler(**(options or {}))(space["deep"])
    return space["function"]


def known(t, x0):
    """The value of the function as it is made without changes."""
    return x0 * x0 + 3.0 * t + math.sin(t) + 4.0 + 1.0 + 0.25 + 0.5 + 2.0 * t


def closed_over(value):
    def function(t, x):
        return value * t

    return function


def digest(function):
    return Snapshot(function).digest


CHANGES = [
    {"deep": "x * x * x"}, {"deep": "x + x"}, {"body": "math.cos(t)"}, {"body": "math.sin(t + 0.0)"},
    {"K": 4.0}, {"K": 3}, {"OUTER": -0.5}, {"DEFAULT": 0.5}, {"inner": 3.0}, {"shift": 2.0},
    {"table": (0.0, 5.0)}, {"table": (0, 4)}, {"options": {"fastmath": True}}, {"K": np.float32(3.0)},
]  # fmt: skip


def test_a_change_of_any_part_is_another_text():
    texts = [digest(made(**change)) for change in ({}, *CHANGES)]
    assert len(set(texts)) == len(texts)
    assert digest(made()) == texts[0]
    closures = [digest(closed_over(value)) for value in (2.0, 3.0, 2, (2.0, 3.0), "2.0")]
    assert len(set(closures)) == len(closures)
    assert digest(closed_over(2.0)) == closures[0]


def itself():
    @njit
    def down(n):
        return 1.0 if n < 1 else 2.0 * down(n - 1)

    return lambda t, x: down(3) * t


def test_a_function_that_calls_itself_has_a_text():
    assert digest(itself()) == digest(itself())


@numba.vectorize
def doubled(x):
    return 2.0 * x


def unknown(name):
    """Return functions whose values no text can tell."""
    made = types.ModuleType("made")
    large = np.zeros(200_000)

    def plain(t):
        return t

    return {
        "a plain function": closed_over(plain),
        "a list": closed_over([1.0]),
        "a large array": closed_over(large),
        "an array without order": closed_over(np.zeros((4, 4))[::2, ::2]),
        "a ufunc of the user's": closed_over(doubled),
        "what takes the name of another": closed_over(functools.wraps(np.sin)(lambda x: x)),
        "a class": closed_over(made.__class__),
        "parallel code": closed_over(njit(parallel=True)(plain)),
    }[name]


@pytest.mark.parametrize(
    "name",
    ["a plain function", "a list", "a large array", "an array without order", "a ufunc of the user's",
     "what takes the name of another", "a class", "parallel code"],
)  # fmt: skip
def test_what_no_text_tells_is_not_kept(name):
    with pytest.raises(NotKept):
        Snapshot(unknown(name))


def test_functions_that_others_define_for_numba_are_not_kept():
    """Their definition may change without a change of the function that uses them."""
    overload(np.gradient)(lambda x: lambda x: x)
    with pytest.raises(NotKept):
        Snapshot(lambda t, x: np.gradient(x))
    assert Snapshot(lambda t, x: np.cos(x)).text


FORM: Any = user_functions.FORM


def value(function, t=0.7, x0=1.5) -> Any:
    """Return the number that the compiled function gives to a run."""
    functions = user_functions.Functions()
    out, x = np.empty(1), np.array([x0])
    address = functions.address(njit(function), (1,), (1,), "f")
    FORM(address)(t, x.ctypes.data, out.ctypes.data)
    return out[0]


@pytest.fixture
def counted(tmp_path, monkeypatch):
    """Return lists of what was compiled and loaded, in an empty folder; nothing stays in memory."""
    found = {"compiled": 0, "loaded": 0}
    compiler, load = kept_code._compile, kept_code._load

    def compiled(*given):
        found["compiled"] += 1
        return compiler(*given)

    def loaded(key):
        code = load(key)
        found["loaded"] += code is not None
        return code

    monkeypatch.setattr(kept_code, "_made", {})
    monkeypatch.setattr(kept_code, "_folder", lambda: tmp_path)
    monkeypatch.setattr(kept_code, "_compile", compiled)
    monkeypatch.setattr(kept_code, "_load", loaded)
    return found


def forget():
    kept_code._made.clear()


@pytest.mark.bits
def test_code_is_loaded_and_gives_the_same_number(counted, tmp_path):
    right = pytest.approx(known(0.7, 1.5), rel=1e-15)
    first = value(made())
    forget()
    assert (first, value(made())) == (right, first)
    assert counted == {"compiled": 1, "loaded": 1}
    # a changed callee of a module, while the old code is loaded
    assert value(made(inner=5.0)) == pytest.approx(known(0.7, 1.5) + 3.0 * 0.7, rel=1e-15)
    assert value(made()) == first
    assert counted == {"compiled": 2, "loaded": 1}


def simple(t, x):
    return 2.0 * t + x[0]


def test_damaged_files_are_not_loaded(counted, tmp_path):
    """They are cut short, or have one other bit; the compile after it writes a whole file again."""
    first = value(simple)
    (file,) = tmp_path.iterdir()
    whole = file.read_bytes()
    for part in (b"", whole[:20], whole[:200], whole[:-1] + bytes([whole[-1] ^ 1])):
        file.write_bytes(part)
        assert kept_code._load(file.name) is None
    forget()
    assert value(simple) == first == 2.9
    assert counted == {"compiled": 2, "loaded": 0}
    assert kept_code._load(file.name) is not None


def test_values_are_those_at_the_time_of_the_run(counted):
    """Numba keeps the values of its first compile, also where they have changed since then."""
    function: Any = njit(made())
    x = np.array([1.5])
    assert function(0.7, x) == pytest.approx(known(0.7, 1.5))
    function.py_func.__globals__["K"] = 4.0
    function.py_func.__globals__["table"][1] = 5.0
    functions, out = user_functions.Functions(), np.empty(1)
    address = functions.address(function, (1,), (1,), "f")
    FORM(address)(0.7, x.ctypes.data, out.ctypes.data)
    new = pytest.approx(known(0.7, 1.5) + 0.7 + 1.0, rel=1e-15)
    assert out[0] == new
    forget()
    assert value(made(K=4.0, table=(0.0, 5.0))) == new
    assert counted == {"compiled": 1, "loaded": 1}


def test_a_folder_without_access_costs_a_compile(counted, monkeypatch, tmp_path):
    blocked = tmp_path / "blocked"
    blocked.write_text("no folder")
    for folder in (None, blocked / "functions"):
        monkeypatch.setattr(kept_code, "_folder", lambda folder=folder: folder)
        forget()
        assert value(simple) == 2.9
    assert counted == {"compiled": 2, "loaded": 0}


def test_symbols_that_a_process_does_not_have_cost_a_compile(counted, tmp_path, monkeypatch):
    """LLVM would end the process."""
    first = value(simple)
    (file,) = tmp_path.iterdir()
    data = file.read_bytes()[kept_code._CHECK :]
    head, _, code = data.partition(b"\0")
    kept_code._save(file.name, [*head.decode().split("\n"), "carom_has_no_such_symbol"], code)
    forget()
    assert value(simple) == first
    assert counted == {"compiled": 2, "loaded": 0}


def test_few_files_stay(counted, tmp_path, monkeypatch):
    monkeypatch.setattr(kept_code, "_MOST_FILES", 2)
    for k in range(4):
        kept_code._save(f"key{k}", ["f"], b"code")
        os.utime(tmp_path / f"key{k}", (k, k))
    assert sorted(one.name for one in tmp_path.iterdir()) == ["key2", "key3"]


def test_code_that_prints_is_right_and_not_kept(counted, tmp_path):
    """It finds the objects of Python in a variable of its process."""

    def function(t, x):
        if t < 0.0:
            print("before", t)
        return 2.0 * t

    assert value(function) == 1.4
    assert list(tmp_path.iterdir()) == []


def test_functions_called_from_python_compile_nothing():
    inner: Any = njit(lambda x: 2.0 * x)
    outer: Any = njit(lambda x: inner(x) + 1.0)
    assert plainly(outer)(3.0) == 7.0
    assert not inner.signatures
    assert not outer.signatures


CODE = """
import ctypes, numba, numpy as np
from carom._compiled import kept_code, user_functions
compiled = []
compiler = kept_code._compile
kept_code._compile = lambda *given: (compiled.append(1), compiler(*given))[1]
FACTOR = 3.0
inner = numba.njit(lambda t: FACTOR * t)
outer = numba.njit(lambda t, x: inner(t) + x[0])
functions, out, x = user_functions.Functions(), np.empty(1), np.array([1.0])
address = functions.address(outer, (1,), (1,), "f")
user_functions.FORM(address)(2.0, x.ctypes.data, out.ctypes.data)
print(out[0], len(compiled), len(inner.signatures))
"""


def test_processes_share_code_of_a_shell(tmp_path):
    """Two at once, both without a file for their source; a third loads."""

    def start():
        return subprocess.Popen(
            [sys.executable, "-c", CODE], stdout=subprocess.PIPE, text=True,
            env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)},
        )  # fmt: skip

    for child in [start(), start()]:
        assert child.communicate(timeout=120)[0].split()[0] == "7.0"
    assert start().communicate(timeout=120)[0].split() == ["7.0", "0", "0"]
    assert not list(tmp_path.rglob("*.part"))
