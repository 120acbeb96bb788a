"""A second process compiles the units that this process will need next.

A first run needs a dozen units, one after the other, with seconds of compiling for each. When a unit is
compiled, the units that it may call become known. If there is more than one processor, a second process
compiles the units that are likely to be called. Each process tells the other which units it finds; compiled
code is on disk. If the other process is compiling a unit, this one waits for it (`carom._compiled.file_lock`),
and compiles another meanwhile. The second process ends with the first. ``NUMBA_NUM_THREADS=1`` turns it off.
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

#: units that a thrown body needs, in this order; other units are compiled later
FIRST = (
    "carom.stepping.event_step:advance",
    "carom.impact.strike:strike",
    "carom.persistent.activation:activate_contact",
    "carom.persistent.contact_step:contact_step",
    "carom.impact.strike_together:resolve_group",
    "carom.dynamics.explicit:whole_step",
    "carom.dynamics.acceleration:acceleration",
    "carom.impact.multiple.steps:pass_layer",
    "carom.friction.strategy:search",
    "carom.friction.newton:newton",
    "carom.impact.multiple.group:resolve_single",
    "carom.dynamics.solve:solve_free",
)


class _State:
    """The state of this process: its connection to the other process, and the units that may be called."""

    started = False  # whether the second process was started
    helps = False  # whether this is the second process
    out: IO[bytes] | None = None  # to the other process
    wanted: queue.PriorityQueue[tuple[int, int, str, bytes]] = queue.PriorityQueue()
    seen: ClassVar[set[str]] = set()  # names of the units found


def start() -> None:
    """Start the second process once; called when compiled code is not on disk."""
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
        process.returncode = 0  # no wait for its end: it ends when its input is closed
        _State.out = process.stdin
        atexit.register(_hang_up)
        threading.Thread(target=_listen, args=(process.stdout,), daemon=True).start()


def do_without() -> None:
    """Start no second process, so that all units are compiled, and known, in this process."""
    _State.started = True


def tell(name: str, packed: bytes) -> None:
    """Tell both processes of a unit that may be called, and of the types of its arguments."""
    if _State.out is None or not name.startswith("carom."):
        return
    _put(name, packed)
    try:
        _State.out.write(f"{name} {packed.hex()}\n".encode())
        _State.out.flush()
    except (OSError, ValueError):  # the other process has ended
        _hang_up()


def compile_one() -> bool:
    """Compile one unit that is likely to be called; return whether there was one."""
    try:
        turn, *_, name, packed = _State.wanted.get(timeout=_IDLE if _State.helps else 0.0)
    except queue.Empty:
        return False
    if turn < len(FIRST) or _State.helps:
        from carom._compiled import units

        with contextlib.suppress(Exception):  # an error is raised again when the unit is called
            files = units.find(name).files
            if files is None or not files.is_taken():
                units.address(name, units.unpack(packed))
    return True


def serve() -> None:
    """Compile the units that the first process reports, until it ends."""
    _State.helps, _State.out = True, sys.stdout.buffer

    def listen():
        _listen(sys.stdin.buffer)
        FileLock.release_all()
        os._exit(0)

    threading.Thread(target=listen, daemon=True).start()
    while compile_one():
        pass


def _hang_up() -> None:
    """Close the connection; the second process then ends."""
    pipe, _State.out = _State.out, None
    if pipe is not None:
        with contextlib.suppress(OSError):
            pipe.close()


def _put(name: str, packed: bytes) -> None:
    """Queue a unit to be compiled; units that every run needs come first."""
    if name not in _State.seen:
        _State.seen.add(name)
        turn = FIRST.index(name) if name in FIRST else len(FIRST)
        _State.wanted.put((turn, next(_number), name, packed))


def _listen(pipe: IO[bytes]) -> None:
    """Read the units that the other process reports."""
    with contextlib.suppress(Exception), pipe:
        for line in pipe:
            name, packed = line.split()
            _put(name.decode(), bytes.fromhex(packed.decode()))


_IDLE = 60.0  # seconds without work after which the second process ends
_number = itertools.count()
