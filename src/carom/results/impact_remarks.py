"""Sentences about impacts: energy that Newton's law adds, jams, and laws of restitution that did not hold."""

from __future__ import annotations

import numpy as np

from carom.impact import laws
from carom.impact.layout import AT_ONCE, JAM, PLASTIC
from carom.model import records as r
from carom.results.contact_names import contact_names

_ACTED = {
    AT_ONCE: (
        "were solved as one contact problem with Newton's law at each contact, because the passage of their "
        "layers did not end (masses far apart, or many redundant points)"
    ),
    PLASTIC: "had no restitution although e > 0, because no velocity satisfies their laws",
}


def remarks(rows, events, run) -> tuple[str, ...]:
    """Return a sentence for each kind of remarkable impact: how many there are, and the first of them.

    `rows` are the records of impacts and `events` those of events of a run, both in the order of time.
    """
    names, jams = contact_names(run.scene, run.pairs).name, events[events["kind"] == r.JAMS]
    slides = rows[(rows["phases"] & JAM != 0) & ~np.isin(rows["time"], jams["time"])]
    said = _gains(rows, names, run)
    if len(jams) + len(slides) > 0:
        first = min((*jams[:1], *slides[:1]), key=lambda row: row["time"])
        said.append(
            f"{len(jams)} persistent contacts and {len(slides)} impacts jam (Painleve's paradox: with its "
            f"friction the normal force drives the bodies together), the first {_place(first, names)}. What "
            "follows depends on the compliance that rigid bodies do not have: check the friction."
        )
    for bit, acted in _ACTED.items():
        marked = rows[rows["phases"] & bit != 0]
        if len(marked) > 0:
            said.append(
                f"{len(np.unique(marked['time']))} impacts of several contacts {acted}, the first "
                f'{_place(marked[0], names)}. Compare with multiple="sequential".'
            )
    return tuple(said)


def _place(row, names) -> str:
    return f"at t = {row['time']:.6g} s of contact {str(names[row['contact']])!r}"


def _gains(rows, names, run) -> list[str]:
    """Return a sentence about the energy that Newton's law with friction has added, if beyond the tolerance.

    The records of one instant are one impact, whose energy is that of the relative velocities, u.W^-1 u/2.
    """
    watch, contacts = run.watch[0], run.compiled.system.contacts
    first = np.unique(rows["time"], return_index=True)[1]
    gain = np.add.reduceat(rows["energy_change"], first)
    number, where = np.unique(contacts["number"], return_index=True)
    c = where[np.searchsorted(number, rows["contact"])]
    may = np.isin(contacts["law"][c], laws.GAINING) & (contacts["friction"][c] > 0.0)
    gained = np.flatnonzero((gain > 0.0) & np.logical_or.reduceat(may, first))
    if not gain[gained].sum() > watch.tolerance * watch.exchanged:
        return []
    k = gained[np.argmax(gain[gained])]
    own = rows[first[k] : (*first, len(rows))[k + 1]]
    energy = sum(0.5 * u @ np.linalg.pinv(W) @ u for u, W in zip(own["before"], own["W"]))
    return [
        f"Newton's law of restitution with friction added energy in {len(gained)} impacts, at most "
        f"{gain[k]:.3g} J {_place(own[np.argmax(own['energy_change'])], names)}, {gain[k] / energy:.2%} of the "
        'energy of this impact. impact_law="stronge" cannot add any, nor can "poisson" at a single contact.'
    ]
