"""The slider-crank with clearance of Flores, Leine and Glocker: its first impacts and their limit."""

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom

PAGE = Path(__file__).parents[2] / "docs" / "published" / "slider_crank.md"
CRANK, ROD, HALF, HEIGHT, PLAY = 0.153, 0.306, 0.05, 0.025, 0.001
MASSES, INERTIAS, RATES = (0.038, 0.038, 0.076), (7.4e-5, 5.9e-4, 2.7e-6), (150.0, -75.0, -0.01)
CORNERS = (-1, 1), (1, 1), (-1, -1), (1, -1)  # sides along and across


def inverse_mass(q):
    m, J = MASSES, INERTIAS
    c = (m[1] / 2 + m[2]) * CRANK * ROD * np.cos(q[1] - q[0])
    first = J[0] + (m[0] / 4 + m[1] + m[2]) * CRANK**2
    second = J[1] + (m[1] / 4 + m[2]) * ROD**2
    return np.linalg.inv([[first, c, 0], [c, second, 0], [0, 0, J[2]]])


def rates(_, y):
    q, v, m = y[:3], y[3:], MASSES
    swing = (m[1] / 2 + m[2]) * CRANK * ROD * np.sin(q[0] - q[1])
    weight = (m[0] / 2 + m[1] + m[2]) * CRANK, (m[1] / 2 + m[2]) * ROD
    force = [
        -swing * v[1] ** 2 - 9.81 * weight[0] * np.cos(q[0]),
        swing * v[0] ** 2 - 9.81 * weight[1] * np.cos(q[1]),
        0,
    ]
    return np.concatenate([v, inverse_mass(q) @ force])


def gap(q, corner):
    along, up = corner
    z = CRANK * np.sin(q[0]) + ROD * np.sin(q[1])
    return HEIGHT + PLAY - up * (z + along * HALF * np.sin(q[2]) + up * HEIGHT * np.cos(q[2]))


def rows(q, corner):
    """Return the rows of the normal and of the tangential velocity of a corner."""
    along, up = corner
    s, c = np.sin(q), np.cos(q)
    normal = -up * np.array([CRANK * c[0], ROD * c[1], along * HALF * c[2] - up * HEIGHT * s[2]])
    return np.array(
        [normal, [-CRANK * s[0], -ROD * s[1], -along * HALF * s[2] - up * HEIGHT * c[2]]]
    )


def first_impacts(count):
    """Return times and normal velocities of the first impacts; slip keeps its direction."""
    t, y, found = 0.0, np.concatenate([np.zeros(3), RATES]), []
    while len(found) < count:
        events = [lambda t, y, one=one: gap(y[:3], one) for one in CORNERS]
        for event in events:
            event.terminal, event.direction = True, -1
        run = solve_ivp(
            rates,
            (t, 0.01),
            y,
            method="DOP853",
            rtol=1e-12,
            atol=1e-13,
            events=events,
            max_step=2e-5,
        )
        t, y = run.t[-1], run.y[:, -1]
        (hit,) = [i for i in range(4) if len(run.t_events[i])]
        G, inverse = rows(y[:3], CORNERS[hit]), inverse_mass(y[:3])
        u = G @ y[3:]
        along = np.array([1.0, -0.01 * np.sign(u[1])])
        p = -1.4 * u[0] / (G @ inverse @ G.T @ along)[0]
        y[3:] += inverse @ G.T @ along * p
        found.append((t, u[0]))
    return np.array(found)


@pytest.fixture(scope="module")
def page():
    space = {}
    code = re.search(
        r"^```python\n(.*?)^solution = ", PAGE.read_text(encoding="utf-8"), re.M | re.S
    )
    exec(code[1], space)
    return space


def test_the_first_eleven_impacts(page):
    impacts = carom.simulate(page["mechanism"](), 0.0027, rtol=1e-10).impacts[:11]
    expected = first_impacts(11)
    np.testing.assert_allclose(impacts.time, expected[:, 0], rtol=0, atol=2e-13)
    np.testing.assert_allclose(
        impacts.relative_velocity_before[:, 0], expected[:, 1], rtol=0, atol=1e-8
    )
    # the numbers to nine digits
    assert impacts.time[:4] == pytest.approx(
        [0.002690904, 0.002692254, 0.002692444, 0.002692506], abs=5e-10
    )


@pytest.mark.parametrize("friction", [0.0, 0.01, 0.3])
def test_the_blows_in_turn_end_flat(page, friction):
    """They accumulate at .0026925480945 s for the friction of the problem; then the upper face is at rest."""
    solution = carom.simulate(page["mechanism"](friction), 0.0028, rtol=1e-10, save_at=[0, 0.0028])
    q = solution["slider"].orientation[-1]
    angle = 2 * np.arctan2(-q[2], q[0])
    assert abs(angle) < 1e-9
    if friction == 0.01:
        assert solution.impacts.time[11] == pytest.approx(0.0026925480945, abs=1e-10)
    z = solution["slider"].position[-1, 2]
    assert z == pytest.approx(PLAY, abs=1e-9)


def test_tolerances_agree(page):
    """To the end of .07 s with dozens of impacts, before a face lands flat to 1e-10 m."""
    ends = [
        carom.simulate(page["mechanism"](), 0.07, rtol=rtol).orientation[-1]
        for rtol in (1e-8, 1e-10, 1e-12)
    ]
    np.testing.assert_allclose(ends[0], ends[2], rtol=0, atol=2e-6)
    np.testing.assert_allclose(ends[1], ends[2], rtol=0, atol=2e-8)
