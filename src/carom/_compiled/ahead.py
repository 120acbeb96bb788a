"""A second process compiles the units that this one is about to need.

A first run needs a dozen units one after the other, seconds of work each; which others a unit may call is
known while it is compiled. Where there is more than one processor a process beside this one compiles what is
likely to be called, and each tells the other of the units that it comes across. What is compiled lies on disk.
A unit that the other process is at work on is waited for (`carom._compiled.file_lock`), and another one is
compiled meanwhile. The second process ends with the first. ``NUMBA_NUM_THREADS=1`` does without it.
"""

from __future__ import annotations

import atexit
import contextlib
import itertools
import os
import queue
import subprocess
import sys
import threading
from pathlib import Path
from typing import IO, Any, ClassVar

from numba.core import config

from carom._compiled.file_lock import FileLock

#: what a body that is thrown needs, in the order in which it does; other units follow as they are asked for
FIRST = (
    "carom.stepping.event_step:advance",
    "carom.impact.strike:strike",
    "carom.persistent.lifecycle:activate_contact",
    "carom.persistent.contact_step:contact_step",
    "carom.impact.strike_several:resolve_group",
    "carom.dynamics.explicit:whole_step",
    "carom.dynamics.acceleration:acceleration_unit",
    "carom.impact.multiple.adaptive:pass_layer",
    "carom.friction.strategy:search",
    "carom.friction.newton:newton",
    "carom.impact.multiple.one:resolve_single",
    "carom.dynamics.solve:solve_free",
)


class _State:
    """What this process does about units that may be called."""

    started = False  # the second process
    helps = False  # this is it
    out: IO[bytes] | None = None  # to the other process
    wanted: queue.PriorityQueue[tuple[int, int, str, bytes]] = queue.PriorityQueue()
    seen: ClassVar[set[str]] = set()  # units that this process has told of


def start() -> None:
    """Start the second process, once; called when something is not on disk."""
    if _State.started or _State.helps:
        return
    _State.started = True
    processors: Any = getattr(config, "NUMBA_NUM_THREADS", 1)
    if processors < 2 or not sys.executable or hasattr(sys, "frozen"):
        return
    paths = [str(Path(__file__).parents[2]), os.environ.get("PYTHONPATH")]
    with contextlib.suppress(OSError):
        process = subprocess.Popen(
            [sys.executable, "-c", "from carom._compiled.ahead import serve; serve()"],
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, paths))},
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        process.returncode = 0  # nobody waits for it: it ends when its input does
        _State.out = process.stdin
        atexit.register(_hang_up)
        threading.Thread(target=_listen, args=(process.stdout,), daemon=True).start()


def do_without() -> None:
    """Start no second process: what is compiled here is all to be known here."""
    _State.started = True


def tell(name: str, packed: bytes) -> None:
    """Tell both processes of a unit that may be called, and of the types of its arguments."""
    if _State.out is None or not name.startswith("carom."):
        return
    _put(name, packed)
    try:
        _State.out.write(f"{name} {packed.hex()}\n".encode())
        _State.out.flush()
    except (OSError, ValueError):  # the other one has ended
        _hang_up()


def compile_one() -> bool:
    """Compile one unit that is likely to be called; return whether there was one."""
    try:
        turn, *_, name, packed = _State.wanted.get(timeout=_IDLE if _State.helps else 0.0)
    except queue.Empty:
        return False
    if turn < len(FIRST) or _State.helps:
        from carom._compiled import units

        with contextlib.suppress(Exception):  # whoever calls it will say what is wrong
            if not units.find(name).compiled._cache.is_taken():
                units.address(name, units.unpack(packed))
    return True


def serve() -> None:
    """Compile what the process at the other end tells of, as long as that lives."""
    _State.helps, _State.out = True, sys.stdout.buffer

    def listen():
        _listen(sys.stdin.buffer)
        FileLock.release_all()
        os._exit(0)

    threading.Thread(target=listen, daemon=True).start()
    while compile_one():
        pass


def _hang_up() -> None:
    """Tell nothing any more; the second process ends when it hears so."""
    pipe, _State.out = _State.out, None
    if pipe is not None:
        with contextlib.suppress(OSError):
            pipe.close()


def _put(name: str, packed: bytes) -> None:
    """Keep in mind to compile a unit: those that any run needs before the others."""
    if name not in _State.seen:
        _State.seen.add(name)
        turn = FIRST.index(name) if name in FIRST else len(FIRST)
        _State.wanted.put((turn, next(_number), name, packed))


def _listen(pipe: IO[bytes]) -> None:
    """Read what the other process has come across."""
    with contextlib.suppress(Exception), pipe:
        for line in pipe:
            name, packed = line.split()
            _put(name.decode(), bytes.fromhex(packed.decode()))


_IDLE = 60.0  # seconds without work after which the second process ends
_number = itertools.count()
