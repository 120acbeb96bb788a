"""A box that stands on an edge, a little off its balance, falls onto its side: I a'' = m g d sin a."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import carom
from verified import agree, verifies

X, Y, Z, G = 0.094, 0.135, 0.03, 9.81


def landing(start):
    """Return the time at which the side meets the floor, integrated to 1e-12."""
    d, corner = 0.5 * np.hypot(X, Z), np.arctan2(X, Z)
    inertia = (X * X + Z * Z) / 12 + d * d

    def lands(t, a):
        return a[0] - (np.pi / 2 - corner)

    lands.terminal = True
    fall = solve_ivp(
        lambda t, a: (a[1], G * d / inertia * np.sin(a[0])), (0, 5), (start, 0),
        rtol=1e-12, atol=1e-15, events=lands,
    )  # fmt: skip
    return fall.t_events[0][0]


@verifies("Box", r"tips over its edge: $I\ddot\alpha = m g d \sin\alpha$", "own integration: SciPy")
@pytest.mark.parametrize(
    ("start", "duration", "settings"),
    [
        (1e-3, 2.0, {}),
        (1e-2, 4.0, {}),
        (1e-3, 4.0, {"rtol": 1e-10}),
        (1e-3, 4.0, {"save_at": [4.0]}),
        (1e-3, 4.0, {"save_at": [0.02, 0.025, 4.0]}),
    ],
)
def test_it_lands_when_it_should(start, duration, settings):
    """The first step of a long run is no worse than the others, whatever is saved: 1e-6 s of half a second."""
    d, corner = 0.5 * np.hypot(X, Z), np.arctan2(X, Z)
    scene = carom.Scene(gravity=(0, 0, -G))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    turn = carom.euler("y", np.degrees(corner + start))
    box = scene.add_body(
        carom.Box(X, Y, Z), mass=1, position=(0, 0, d * np.cos(start)), orientation=turn
    )
    scene.add_contact(box, floor, restitution=0, friction=1)
    s = carom.simulate(scene, duration, **settings)
    agree(s.impacts.time[0], landing(start), atol=1e-6)
