"""The last support of a body slides over an edge with its whole force: it falls from that instant."""

import numpy as np

import carom


def falls(rtol):
    """Return the end of a block that slides off a table, tips over its edge and falls."""
    scene = carom.Scene(gravity=(0, 0, -9.81))
    scene.add_static(carom.Box(2, 4, 0.2), position=(-1, 0, -0.1))
    scene.set_contact_default(restitution=0, friction=0.1)
    scene.add_body(
        carom.Box(0.18, 0.15, 0.06), mass=1, position=(-0.11, 0, 0.03), velocity=(1.4, 0, 0)
    )
    s = carom.simulate(scene, 0.25, rtol=rtol, save_at=[0.25])
    assert s.events[-1]["kind"] == "opens"
    assert s.stats["trial_steps"] < 200
    return np.append(s.position[-1, 0], 0.18 * s.orientation[-1, 0])


def test_the_end_of_the_last_support_follows_the_tolerance():
    exact = falls(1e-12)
    for rtol in (1e-8, 1e-10):
        assert np.abs(falls(rtol) - exact).max() < 10 * 2 * 0.18 * rtol
