"""Random small mechanisms (hypothesis): energy, joints and momentum hold whatever the scene."""

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from random_forests import KINDS, MORE, build, plan, with_loop

import carom

FEW = settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck))
SEEDS = st.integers(0, 10**6)


@FEW
@given(seed=SEEDS, count=st.integers(1, 5), looped=st.booleans())
def test_energy_and_joints(seed, count, looped):
    scene = build(plan(np.random.default_rng(seed), count, floating=0.3))
    s = carom.simulate(with_loop(scene) if looped else scene, 0.1, step=5e-4)
    scale = np.max(s.kinetic_energy) + np.ptp(s.potential_energy) + 1e-6  # [J], all may stand
    # spins of some 10 rad/s: (w h)^4 a radian
    assert np.max(np.abs(s.ledger.residual)) < 1e-7 * scale
    if scene.joints:
        position, velocity = s.constraint_errors
        assert np.max(position) < 1e-11
        assert np.max(velocity) < 1e-10


@FEW
@given(seed=SEEDS, count=st.integers(1, 4))
def test_linear_momentum_without_ground(seed, count):
    rows = plan(np.random.default_rng(seed), count, floating=1.0)
    rows += [dict(rows[0], name="twin", parent=0, kind="Spherical", anchor=rows[0]["position"])]
    s = carom.simulate(build(rows, gravity=(0, 0, 0)), 0.1, step=1e-3)
    mass = np.array([r["mass"] for r in rows])
    momentum = np.einsum("n,tnk->tk", mass, s.velocity)
    scale = np.sum(np.abs(momentum[0])) + 1.0
    np.testing.assert_allclose(
        momentum, np.tile(momentum[0], (len(s.t), 1)), rtol=0, atol=1e-12 * scale
    )


@FEW
@given(seed=SEEDS, count=st.integers(1, 4))
def test_papers_method_keeps_joints(seed, count):
    rows = plan(np.random.default_rng(seed), count, floating=0.0, kinds=KINDS + MORE)
    for row in rows:  # slow, so that ten steps are small
        row["velocity"], row["angular_velocity"] = np.zeros(3), np.zeros(3)
    s = carom.simulate(build(rows), 0.05, step=5e-3, method="paper")
    assert max(np.max(e) for e in s.constraint_errors) < 1e-11
