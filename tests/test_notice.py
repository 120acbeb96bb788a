"""Compiling that takes long says so on stderr, once, with progress."""

import subprocess
import sys
import time

import pytest

from carom._compiled import notice


@pytest.fixture
def quick(monkeypatch):
    """A hundredth of all waits."""
    monkeypatch.setattr(notice._State, "silent", False)
    monkeypatch.setattr(notice._State, "spoken", False)
    for name in ("AFTER", "EVERY", "REST", "_TICK"):
        monkeypatch.setattr(notice, name, getattr(notice, name) / 20)


def compile_for(seconds):
    notice.begin()
    time.sleep(seconds)
    notice.end()


def wait():
    """Until the watcher has ended."""
    watcher = notice._State.watcher
    if watcher is not None:
        watcher.join(10.0)


def test_long_compiling_is_told(quick, capsys):
    for _ in range(3):
        compile_for(0.3)
    wait()
    first, *middle, last = capsys.readouterr().err.splitlines()
    assert first.startswith("carom: compiling, once for this installation")
    assert all(line.startswith("carom: compiling: ") and " functions, " in line for line in middle)
    assert middle
    assert last.startswith("carom: compiled 3 functions in ")
    compile_for(0.3)
    wait()
    assert capsys.readouterr().err.startswith("carom: compiling some more ...")


def test_short_compiling_is_not(quick, capsys):
    compile_for(0.01)
    wait()
    assert capsys.readouterr().err == ""


def test_what_is_on_disk_says_nothing():
    """A process that only loads has no watcher."""
    code = """
from carom._compiled import notice
from carom.geometry.rotation import exp
exp(0.1, 0.2, 0.3)
{}
"""
    for last in ("", "assert notice._State.parts == 0, notice._State.parts"):
        subprocess.run([sys.executable, "-c", code.format(last)], check=True, timeout=120)
