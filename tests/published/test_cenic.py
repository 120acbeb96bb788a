"""Problems of Drake's CENIC: the page has the numbers of the files, and carom's errors are what was asked."""

import re
from pathlib import Path

import numpy as np
import pytest

import cenic
import cenic_problems as problems

PAGE = Path(__file__).parents[2] / "docs" / "published" / "closed_forms.md"


def test_the_page_has_the_numbers_of_the_files():
    table = re.findall(r"^\| (.*) \|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)[2:]
    assert [[cell.strip() for cell in line.split("|")] for line in table] == cenic.rows()


def test_sentences_of_the_page():
    theirs, ours = (cenic.points(tool)[cenic.BALLS] for tool in ("CENIC", "carom"))
    fast, exact = ({p.asked: p for p in found} for found in (theirs, ours))
    assert fast[1e-2].time < min(p.time for p in ours)
    assert max(p.error for p in ours) < 1e-11
    (sentence,) = re.findall(
        r"^- \*\*Many contacts.*$", PAGE.read_text(encoding="utf-8"), re.MULTILINE
    )
    for said in (
        f"at 1e-2, where it moves the 64 balls in {fast[1e-2].time:.2g} s",
        f"At 1e-3 it takes {fast[1e-3].time:.2g} s",
        f"{1e3 * fast[1e-3].error:.1f} to {1e3 * fast[1e-2].error:.1f} mm",
        f"{exact[1e-4].time:.2g} s at `rtol` 1e-4 and {exact[1e-2].time:.2g} s at 1e-2",
        f"({max(exact[1e-4].error, exact[1e-2].error):.1e} m at most)",
    ):
        assert said in sentence


@pytest.fixture(scope="module")
def solve():
    return problems.carom_problems()


@pytest.mark.parametrize(
    ("name", "rtol", "allowed"),
    [
        ("free fall", 1e-2, 1e-14), ("double pendulum", 1e-8, 2e-8), ("double pendulum", 1e-10, 2e-10),
        ("break-away", 1e-2, 2e-9), ("stick-slip", 1e-8, 2e-9), ("stick-slip", 1e-10, 1e-10),
    ],
)  # fmt: skip
def test_errors_are_what_was_asked(solve, name, rtol, allowed):
    error, steps, _ = solve[name](rtol)
    assert error < allowed
    assert steps < 1000


def test_a_block_that_a_spring_draws_sticks_and_slips():
    """Its place by an integration of the motion with the friction of slip, from break-away to rest."""
    from scipy.integrate import solve_ivp

    g, mu_s, mu_k, k, v = (
        problems.G,
        problems.STATIC,
        problems.KINETIC,
        problems.SPRING,
        problems.SPEED,
    )
    t, x = mu_s * g / k / v, 0.0

    def stops(s, y):
        return y[1]

    stops.terminal, stops.direction = True, -1
    for _ in range(2):
        run = solve_ivp(
            lambda s, y: [y[1], k * (v * s - y[0]) - mu_k * g], (t, t + 3), [x, 1e-14],
            rtol=1e-12, atol=1e-14, events=stops,
        )  # fmt: skip
        end, x = run.t[-1], run.y[0, -1]
        assert problems.drawn(end) == pytest.approx(x, abs=1e-9)
        t = (mu_s * g / k + x) / v
    assert np.diff([problems.drawn(s) for s in np.linspace(0, 5, 200)]).min() > -1e-12
