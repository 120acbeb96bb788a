"""Random scenes of every kind that a user could state, and what is demanded of each run.

A module here is a family of scenes: it has a function ``case(seed) -> Case``. `benchmarks/campaign.py` runs
them by the thousand; the tests run a few of each.
"""

from campaigns import (
    bearings,
    belts,
    cams,
    crowds,
    forced,
    frictions,
    laws,
    mechanisms,
    piles,
    rails,
    rests,
    robots,
    rolls,
    slides,
    strikes,
    teeth,
    throws,
)

FAMILIES = {
    "throws": throws.case, "strikes": strikes.case, "mechanisms": mechanisms.case, "forced": forced.case,
    "piles": piles.case, "crowds": crowds.case, "robots": robots.case, "rolls": rolls.case,
    "slides": slides.case, "teeth": teeth.case, "rests": rests.case, "bearings": bearings.case,
    "belts": belts.case,
    "cams": cams.case,
    "rails": rails.case,
    "laws": laws.case, "frictions": frictions.case,
}  # fmt: skip
