"""Sentences about impacts: energy that Newton's law adds, jams, and laws of restitution that did not hold."""

from __future__ import annotations

import numpy as np

from carom.impact.layout import AT_END, PHASE_JAM, PLASTIC
from carom.law import impact_laws
from carom.model import records as r
from carom.model.laws import PERSISTENT, law_of
from carom.results.names import arms, contact_name, restitution_of
from carom.scene.restitution import Restitution
from carom.status import Remark

#: energy of a jam, of what the run exchanges, below which slip of round-off has jammed (a wheel that rolls)
_ROUND_OFF = 1e-9
#: of `Options.energy_tolerance`: energy that a law adds and that is said. It is no error, so nothing hides it
GAIN_SHARE = 1e-3
#: the law "moreau", in sentences
BY_FINAL_SLIP = 'Friction by the final slip (impact_law="moreau")'
#: speed: of impacts that count as elastic, by that at which e is 1
NEARLY = 1.01


def remarks(rows, events, run) -> tuple[str, ...]:
    """Return a sentence for each kind: how many impacts (`rows`) or `events` of a run, and the first."""
    marks, jams = int(np.bitwise_or.reduce(rows["phases"])), events["kind"] == r.JAMS
    said = _gains(rows, run) + _gains_together(rows, run)
    if len(run.compiled.system.laws.pieces):
        said += _of_laws(rows, run)
    if marks & AT_END:
        said += _without_slip(rows, run)
    if run.clock["whole"][0] > 0:
        said += _without_adhesion(run)
    if not (jams.any() or marks & (PHASE_JAM | PLASTIC)):
        return tuple(map(Remark, said))
    jams = events[jams]
    counts = np.abs(rows["energy_change"]) > _ROUND_OFF * run.watch[0].exchanged
    jams = jams[np.isin(jams["time"], rows["time"][counts])]
    slides = rows[counts & (rows["phases"] & PHASE_JAM != 0) & ~np.isin(rows["time"], jams["time"])]
    if len(jams) + len(slides) > 0:
        first = min((*jams[:1], *slides[:1]), key=lambda row: row["time"])
        said.append(
            f"{len(jams)} persistent contacts and {len(slides)} impacts jam (Painleve's paradox: with its "
            f"friction the normal force drives the bodies together), the first {_place(first, run)}. What "
            "follows depends on the compliance that rigid bodies do not have: check the friction."
        )
    plastic = rows[rows["phases"] & PLASTIC != 0]
    if len(plastic) > 0:
        said.append(
            f"{len(np.unique(plastic['time']))} impacts of several contacts had no restitution although e > 0, "
            f"because no velocity satisfies their laws, the first {_place(plastic[0], run)}. Compare with "
            'multiple="sequential".'
        )
    return tuple(map(Remark, said))


def _place(row, run) -> str:
    name = contact_name(run.scene, run.pairs, int(row["contact"]))
    return f"at t = {row['time']:.6g} s of contact {name!r}"


def _of_laws(rows, run) -> list[str]:
    """Return sentences about impacts that are faster than their law is stated for, or elastic by it."""
    system, said = run.compiled.system, []
    contacts = system.contacts
    of_law = np.isnan(law_of(system, contacts)["restitution"])
    for number in np.unique(contacts["number"][of_law]).tolist():
        law = restitution_of(run.scene, run.pairs, number)
        assert isinstance(law, Restitution)
        own = rows[rows["contact"] == number]
        approach = -own["before"][:, 0] / arms(contacts[contacts["number"] == number])[0]
        fast = own[approach > law.fastest]
        if len(fast):
            said.append(
                f"{len(fast)} impacts were faster than their law of restitution is stated for "
                f"({law.fastest:.6g}), the first {_place(fast[0], run)}: they had the e of that speed."
            )
        elastic = own[(approach > 0.0) & (approach < NEARLY * law.elastic)]
        if len(elastic):
            said.append(
                f"{len(elastic)} impacts were elastic, or nearly, as their law says below a speed of "
                f"{law.elastic:.6g}, the first {_place(elastic[0], run)}. Such bounces never end: for bodies "
                "that come to rest give Restitution.power(..., maximum=0.9), or a table that begins below 1."
            )
    return said


def _without_slip(rows, run) -> list[str]:
    """Return a sentence about impacts in time-stepping steps, which have no tangential restitution."""
    system = run.compiled.system
    laws = law_of(system, system.contacts)
    rough = system.contacts["number"][laws["tangential_restitution"] != 0.0]
    found = rows[(rows["phases"] & AT_END != 0) & (rows["together"] > 1)]
    found = found[np.isin(found["contact"], rough)]
    if not len(found):
        return []
    return [
        f"{len(np.unique(found['time']))} impacts in time-stepping steps were without the tangential "
        f"restitution of their contacts, the first {_place(found[0], run)}."
    ]


def _without_adhesion(run) -> list[str]:
    """Return a sentence about time-stepping steps of a scene with adhesion, which these steps do not have."""
    system = run.compiled.system
    if not law_of(system, system.contacts, PERSISTENT)["adhesion"].any():
        return []
    return [
        f"{int(run.clock['whole'][0])} time-stepping steps were without the adhesion of contacts, which may "
        "have come apart: take a smaller step, or lower rtol."
    ]


def _gains(rows, run) -> list[str]:
    """Return a sentence about the energy that Newton's law with friction has added, if beyond round-off.

    Here of single points: with laws that have a path several return at most what they have absorbed. The
    energy of an impact is that of its relative velocity, u.W^-1 u/2.
    """
    gains = rows["energy_change"] > 0.0
    if not gains.any():
        return []
    watch, system = run.watch[0], run.compiled.system
    single = gains & (rows["together"] == 1)
    least = GAIN_SHARE * watch.tolerance * watch.exchanged
    if not rows["energy_change"][single].sum() > least:
        return []
    laws = law_of(system, system.contacts)
    able = np.isin(laws["impact_law"], impact_laws.GAINING) & (laws["friction"] > 0.0)
    own = rows[single]
    own = own[np.isin(own["contact"], system.contacts["number"][able])]
    u, gain = own["before"][:, :, None], own["energy_change"]
    part = 2.0 * gain / (u.transpose(0, 2, 1) @ np.linalg.pinv(own["W"]) @ u)[:, 0, 0]
    own, gain, part = (column[part > _ROUND_OFF] for column in (own, gain, part))
    if not gain.sum() > least:
        return []
    k = int(np.argmax(gain))
    after = np.isin(laws["impact_law"], impact_laws.WITHOUT_PATH)
    at_end = np.isin(own["contact"], system.contacts["number"][able & after])
    law = "Newton's law with friction" if not at_end.all() else BY_FINAL_SLIP
    return [
        f"{law} added energy in {len(own)} impacts, at most {gain[k]:.3g} J "
        f"{_place(own[k], run)}, {part[k]:.2%} of the energy of this impact. impact_law="
        '"stronge" cannot add any, nor can "poisson" at a single contact.'
    ]


def _gains_together(rows, run) -> list[str]:
    """Return a sentence about the energy that friction by the final slip has added at several points."""
    watch, system = run.watch[0], run.compiled.system
    laws = law_of(system, system.contacts)
    after = np.isin(laws["impact_law"], impact_laws.WITHOUT_PATH) & (laws["friction"] > 0.0)
    own = rows[(rows["together"] > 1) & (rows["phases"] & AT_END == 0)]
    if not after.any() or not len(own):
        return []
    times, first, place = np.unique(own["time"], return_index=True, return_inverse=True)
    gain = np.bincount(place, own["energy_change"], len(times))
    least = GAIN_SHARE * watch.tolerance * watch.exchanged
    if not gain[gain > 0.0].sum() > least:
        return []
    k = int(np.argmax(gain))
    return [
        f"{BY_FINAL_SLIP} added energy in {np.count_nonzero(gain > 0.0)} impacts of several contacts, at most "
        f"{gain[k]:.3g} J {_place(own[first[k]], run)}. The other laws cannot add any there."
    ]
