"""Messages on stderr about progress if code is compiled for more than two seconds."""

from __future__ import annotations

import contextlib
import sys
import threading
import time

AFTER = 2.0  # seconds of compiling before the first message
EVERY = 10.0  # seconds between messages
REST = 1.5  # seconds without compiling before the last message
_TICK = 0.1


class _State:
    """The present state of compiling in this process."""

    silent = False
    depth = 0  # functions that are being compiled
    parts = 0  # functions compiled or being compiled so far
    spoken = False  # whether a message was printed before
    watcher: threading.Thread | None = None
    lock = threading.Lock()


def silence() -> None:
    """Print no messages in this process: something else shows progress, or there is no reader."""
    _State.silent = True


def begin() -> None:
    """Record that a function is about to be compiled."""
    with _State.lock:
        _State.depth += 1
        _State.parts += 1
        if _State.watcher is None and not _State.silent and not _is_worker():
            _State.watcher = threading.Thread(target=_watch, daemon=True)
            _State.watcher.start()


def end() -> None:
    """Record that a function has been compiled."""
    with _State.lock:
        _State.depth = max(0, _State.depth - 1)


def _is_worker() -> bool:
    """Return whether this is a worker of another process, which then prints the messages."""
    known = sys.modules.get("multiprocessing.process")
    return known is not None and known.parent_process() is not None


def _watch() -> None:
    """Print messages while functions are compiled, until no function has been compiled for a while."""
    first, spent, idle, said = _State.parts - 1, 0.0, 0.0, None
    before = time.perf_counter()
    while True:
        time.sleep(_TICK)
        now = time.perf_counter()
        passed, before = now - before, now
        if _State.depth > 0:
            spent, idle = spent + passed, 0.0
        else:
            idle += passed
        parts = _State.parts - first
        if said is None and spent > AFTER:
            said = spent
            once = "once for this installation; 'carom warmup' does all of it beforehand"
            _say("compiling some more ..." if _State.spoken else f"compiling, {once} ...")
            _State.spoken = True
        elif said is not None and _State.depth > 0 and spent - said > EVERY:
            said = spent
            _say(f"compiling: {parts} functions, {spent:.0f} s ...")
        if idle > REST:
            with _State.lock:
                if _State.depth > 0:
                    continue
                _State.watcher = None
            if said is not None:
                _say(f"compiled {parts} functions in {spent:.0f} s; from now on they are on disk")
            return


def _say(words: str) -> None:
    """Print a line on stderr, unless it is closed or does not exist."""
    with contextlib.suppress(Exception):
        print(f"carom: {words}", file=sys.stderr, flush=True)
