"""Random scenes of every kind that a user could state, and what is demanded of each run.

A module here is a family of scenes: it has a function ``case(seed) -> Case``. `benchmarks/campaign.py` runs
them by the thousand; the tests run a few of each.
"""

from campaigns import (
    bearings,
    belt_drives,
    belts,
    cams,
    capstans,
    clearances,
    coordinates,
    crowds,
    drives,
    forced,
    frictions,
    gears,
    grains,
    grounds,
    laws,
    loads,
    loose_rails,
    magnets,
    mechanisms,
    piles,
    plays,
    presses,
    rails,
    rests,
    robots,
    rolls,
    ropes,
    rough,
    slides,
    strikes,
    surfaces,
    switches,
    teeth,
    terrains,
    tethers,
    throws,
)

FAMILIES = {
    "throws": throws.case, "strikes": strikes.case, "mechanisms": mechanisms.case, "forced": forced.case,
    "piles": piles.case, "crowds": crowds.case, "robots": robots.case, "rolls": rolls.case,
    "slides": slides.case, "teeth": teeth.case, "rests": rests.case, "bearings": bearings.case,
    "belts": belts.case,
    "rails": rails.case, "loose rails": loose_rails.case, "surfaces": surfaces.case, "grounds": grounds.case,
    "terrains": terrains.case, "cams": cams.case,
    "laws": laws.case, "frictions": frictions.case, "grains": grains.case, "grains by slip": grains.by_slip,
    "rough": rough.case, "plays": plays.case, "tethers": tethers.case, "ropes": ropes.case,
    "capstans": capstans.case, "coordinates": coordinates.case, "drives": drives.case,
    "clearances": clearances.case, "loads": loads.case, "magnets": magnets.case,
    "belt drives": belt_drives.case, "gears": gears.case, "switches": switches.case,
    "presses": presses.case,
}  # fmt: skip
