"""Kill an ensemble at one of its operations on files, go on with it, and say what came of it.

Run as ``python kills.py FOLDER first step count``: operations first, first + step, ...; prints a line for each
that does not end as an undisturbed run, and how many were tried. Each trial is a fork of one process that has
all compiled code.
"""

import contextlib
import os
import shutil
import signal
import sys
import warnings
from pathlib import Path

import carom
from ensembles.ensemble_scenes import die

OPERATIONS = ("open", "os.rename", "os.mkdir", "os.remove", "os.rmdir", "os.replace")
RUNS = 10


def watched(solution):
    """What is kept of each run besides."""
    return {"top": float(solution.position[:, 0, 2].max()), "last": solution.position[-1, 0]}


def throw(save=None):
    """The ensemble, in parts of 3 runs."""
    vary = {"die.orientation": carom.UniformOrientation(), "die-ground.friction": [0.1] * RUNS}
    return carom.ensemble(
        die(), 0.05, step=5e-3, vary=vary, runs=RUNS, chunk=3, save=save, observe=watched,
        executor="serial",
    )  # fmt: skip


def bits(e):
    """All numbers of an ensemble."""
    observed = b"".join(e.observed[name].tobytes() for name in sorted(e.observed))
    return e.outcomes.tobytes() + observed + repr(e.failures).encode()


def kill_at(number, place):
    """Have this process killed at operation `number` on files under a place."""
    left = [number]

    def hook(event, arguments):
        if event in OPERATIONS and str(place) in str(arguments[0]):
            left[0] -= 1
            if left[0] < 0:
                os.kill(os.getpid(), signal.SIGKILL)

    sys.addaudithook(hook)


def forked(work):
    """Return the exit status of a fork of this process that does some work."""
    child = os.fork()
    if child == 0:
        code = 1
        with contextlib.suppress(BaseException):
            code = work()
        os._exit(code)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def trial(number, folder, whole):
    """Return "killed", "done" or what is wrong."""
    place = folder / f"{number}.zarr"

    def first():
        kill_at(number, place)
        throw(place)
        return 0

    def torn():
        """Cut a file of numbers short, as older versions of Zarr, or a power cut, may leave one."""
        files = [f for f in place.glob("o*/*/c/**/*") if f.is_file()]
        if number % 2 and files:
            file = sorted(files)[number % len(files)]
            file.write_bytes(file.read_bytes()[: number % 7])

    def second():
        try:
            seen = carom.Ensemble.load(place)
            done = seen.done
            if seen.outcomes[done].tobytes() != whole.outcomes[done].tobytes():
                return 3
        except FileNotFoundError:
            pass
        return 0 if bits(throw(place)) == bits(whole) else 2

    ended = forked(first)
    if ended not in (0, -signal.SIGKILL):
        return f"could not be made: {ended}"
    torn()
    code = forked(second)
    shutil.rmtree(place)
    return {0: "done" if ended == 0 else "killed", 2: "other bits", 3: "other rows"}.get(
        code, f"cannot go on: {code}"
    )


def main(folder, first, step, count):
    """Try some operations; return whether all went well."""
    warnings.simplefilter("error")
    whole, counted = throw(), {"killed": 0, "done": 0}
    for number in range(first, first + step * count, step):
        told = trial(number, folder, whole)
        if told in counted:
            counted[told] += 1
        else:
            print(f"operation {number}: {told}")
        if told == "done":
            break
    print(counted["killed"], counted["done"])


if __name__ == "__main__":
    main(Path(sys.argv[1]), *map(int, sys.argv[2:]))
