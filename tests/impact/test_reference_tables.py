"""Every row of the shared reference tables (Darboux-Keller solved to 1e-10), three laws."""

import numpy as np
import pytest
from cases import KNOWN, cube_corner, planar_rod, rows

from carom.impact.api import resolve_impact
from verified import agree, verifies

TOLERANCE = 1e-10  # that of the tables; reached: 1.3e-11 (cube), 2.1e-14 (rod)


def largest_error(impact, u, velocity, impulse, energy):
    scale = np.linalg.norm(u)
    return max(
        np.max(np.abs(impact.velocity_after - velocity)) / scale,
        np.max(np.abs(impact.impulse - impulse)) / np.linalg.norm(impulse),
        abs(impact.energy_change - energy) / (np.linalg.norm(impulse) * scale),
    )


@verifies(
    'impact_law="{law}"',
    r"$\mathrm du/\mathrm dp = W (1, -\mu u_t/\lvert u_t\rvert)$, 100 corners of a cube",
    "own integration: tables, to 1e-10",
)
@pytest.mark.plain
@pytest.mark.parametrize("law", KNOWN)
def test_corner_of_a_cube(law):
    key, count = law[0].upper(), 0
    for row in rows("cube_corner.csv"):
        W, u, turn = cube_corner(row)
        impact = resolve_impact(W, u, row["mu"], row["e"], law)
        velocity = turn @ [row[f"{key}_c{i}"] for i in "xyz"]
        impulse = turn @ [row[f"{key}_P{i}"] for i in "xyz"]
        agree(largest_error(impact, u, velocity, impulse, row[f"{key}_dT"]), 0.0, atol=TOLERANCE)
        if law == "newton":
            assert impact.phases == tuple(row["mode_newton"].split("+"))
        count += 1
    assert count == 100


@verifies(
    'impact_law="{law}"',
    "150 planar rods by Routh's method",
    "own integration: tables, to 1e-10",
)
@pytest.mark.plain
@pytest.mark.parametrize("law", KNOWN)
def test_planar_rod(law):
    # Exact (Routh): u is piecewise linear in the impulse, so only round-off remains.
    key, count = law[0].upper(), 0
    for row in rows("planar_rod.csv"):
        W, u = planar_rod(row)
        impact = resolve_impact(W, u, row["mu"], row["e"], law)
        velocity = [row[f"{key}_cn"], row[f"{key}_ct"], 0.0]
        impulse = np.array([row[f"{key}_Pn"], row[f"{key}_Pt"], 0.0])
        agree(largest_error(impact, u, velocity, impulse, row[f"{key}_dT"]), 0.0, atol=1e-12)
        if law == "newton":
            pieces = row["mode_newton"].split(">")
            assert ("stick" in impact.phases) == ("stick" in pieces)
            slips = {p for p in pieces if p.startswith("slip")}
            assert ("reversal" in impact.phases) == (len(slips) == 2)
        count += 1
    assert count == 150
