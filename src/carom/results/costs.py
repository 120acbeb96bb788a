"""What a run takes its time for, in counts: the contact with the most events, steps in contact, functions."""

from __future__ import annotations

import numpy as np

from carom.model import records as r
from carom.results.names import contact_name


def busiest(events: np.recarray) -> tuple[int, int]:
    """Return the contact or stop with most impacts and changes of contact, -1 for none, and their number."""
    contact = events["contact"]
    counts = np.bincount(contact[contact >= 0])
    return (most := int(counts.argmax()), int(counts[most])) if len(counts) else (-1, 0)


def costs(run) -> str:
    """Return what a run has done so far, for the progress bar; "" where nothing but smooth steps."""
    clock = r.as_numbers(run.clock)
    trials, calls = max(1, clock["trials"]), run.compiled.functions.calls
    said = []
    if clock["event"] > 0:
        number, count = busiest(run.records.event[: clock["event"]])
        name = contact_name(run.scene, run.pairs, number) if number >= 0 else ""
        said.append(f"{clock['event']} events, {count} of them of {name!r}")
    if clock["contact_steps"] > 0:
        said.append(
            f"{min(1.0, clock['contact_steps'] / trials):.0%} of the trial steps in contact"
        )
    if clock["cuts"] + clock["rejected"] > 0.1 * trials:
        said.append(f"{clock['cuts']} steps cut, {clock['rejected']} rejected")
    if calls > 0:
        said.append(f"{calls} calls of Python functions")
    return "; ".join(said)
