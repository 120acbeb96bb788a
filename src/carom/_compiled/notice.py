"""Messages on stderr while code is compiled for more than two seconds: that it is, and how far it has come."""

from __future__ import annotations

import contextlib
import sys
import threading
import time

AFTER = 2.0  # seconds of compiling before anything is said
EVERY = 10.0  # seconds from one word to the next
REST = 1.5  # seconds without compiling after which it is over
_TICK = 0.1


class _State:
    """What this process compiles now."""

    silent = False
    depth = 0  # functions that are being compiled
    parts = 0  # functions since it began
    spoken = False  # of compiling, before
    watcher: threading.Thread | None = None
    lock = threading.Lock()


def silence() -> None:
    """Say nothing in this process: somebody else shows progress, or nobody looks."""
    _State.silent = True


def begin() -> None:
    """Note that a function has to be compiled."""
    with _State.lock:
        _State.depth += 1
        _State.parts += 1
        if _State.watcher is None and not _State.silent and not _is_worker():
            _State.watcher = threading.Thread(target=_watch, daemon=True)
            _State.watcher.start()


def end() -> None:
    """Note that a function that had to be compiled is there."""
    with _State.lock:
        _State.depth = max(0, _State.depth - 1)


def _is_worker() -> bool:
    """Return whether this is a worker process of another one, which speaks for it."""
    known = sys.modules.get("multiprocessing.process")
    return known is not None and known.parent_process() is not None


def _watch() -> None:
    """Speak while functions are compiled, until there has been none for a while."""
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
    """Print a line on stderr, which may be closed, or none."""
    with contextlib.suppress(Exception):
        print(f"carom: {words}", file=sys.stderr, flush=True)
