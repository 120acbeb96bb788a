"""Ropes that stretch over points and pulleys: oscillations in closed form, slack, energy, files and errors."""

import numpy as np
import pytest
from scipy.linalg import expm

import carom
from carom import GROUND, joints
from carom.visual.bodies import links_of
from files.compare import goes_on
from verified import agree, verifies

G, R, K = 9.81, 0.1, 500.0
OVER = carom.Pulley(GROUND, R, (0, 1, 0), center=(0, 0, 0))
HOW = [({}, 1e-6), ({"rtol": 1e-10}, 1e-10), ({"step": 1e-3, "method": "rk4"}, 1e-6)]


def pair(masses, pulley=OVER, **rope):
    """Two loads on a rope over a pulley, 1 m below its centre."""
    scene = carom.Scene(gravity=(0, 0, -G))
    if pulley is not OVER:
        scene.add_body(carom.Cylinder(R, 0.02), mass=0.5, inertia=(0.01,) * 3, name="wheel")
        scene.add_joint(joints.Revolute((0, 0, 0), (0, 1, 0)), GROUND, "wheel", name="hinge")
    for name, x, mass in zip("ab", (-R, R), masses):
        scene.add_body(carom.Sphere(0.03), mass=mass, position=(x, 0, -1), name=name)
    scene.add_rope(["a", pulley, "b"], stiffness=K, name="rope", **rope)
    return scene


@verifies("add_rope(stiffness=)", r"$\mu\ddot s = 2\mu g - k s$", "closed form")
@pytest.mark.parametrize(("how", "error"), HOW)
def test_atwood(how, error):
    """Two loads stretch the rope as one of the reduced mass mu: mu s'' = 2 mu g - k s."""
    s = carom.simulate(pair((2.0, 2.5)), 1.2, **how)
    mu = 2.0 * 2.5 / 4.5
    stretch = 2 * mu * G / K * (1 - np.cos(np.sqrt(K / mu) * s.t))
    middle = -1 - 0.5 * G * s.t**2 + 2 * (K / 4.5) * np.array([_twice(mu, t) for t in s.t])
    down = -2.0 - s["a"].position[:, 2] - s["b"].position[:, 2]
    agree(down, stretch, atol=error)
    agree(s["rope"].tension, K * stretch, atol=K * error)
    z = (2.0 * s["a"].position[:, 2] + 2.5 * s["b"].position[:, 2]) / 4.5
    agree(z, middle, atol=10 * error)
    agree(s.total_energy, s.total_energy[0], atol=max(1e-12, 100 * error))
    assert not len(s.impacts.time)


def _twice(mu, t):
    """The second integral of the stretch, from 0 to t."""
    w = np.sqrt(K / mu)
    return 2 * mu * G / K * (0.5 * t * t - (1 - np.cos(w * t)) / w**2)


@verifies(
    "add_rope(stiffness=)",
    "three linear equations, by the exponential of their matrix",
    "own integration",
)
@pytest.mark.parametrize(("how", "error"), HOW)
def test_a_wheel_that_it_turns(how, error):
    """Both parts have the stiffness k way/1 m; three linear equations, by the exponential of their matrix.

    Shorter than its way by 5 cm, the rope has the tension k 5 cm in both parts.
    """
    way, tight = 2.0 + np.pi * R, 0.05
    scene = pair((2.0, 2.5), carom.Pulley("wheel", R, (0, 1, 0)), length=way - tight)
    s = carom.simulate(scene, 1.0, **how)
    # with z_a, z_b the ways down and r = R angle: s_a = z_a + r, s_b = z_b - r, m z'' = m g - T
    k, T0 = K * way / 1.0, K * tight
    stretches = np.array([[1, 0, 1], [0, 1, -1]])
    M = np.diag([2.0, 2.5, 0.01 / R**2])
    A = np.zeros((7, 7))
    A[:3, 3:6] = np.eye(3)
    A[3:6, :3] = -np.linalg.solve(M, k * stretches.T @ stretches)
    A[3:6, 6] = np.linalg.solve(M, np.array([2.0, 2.5, 0]) * G - stretches.T @ (T0, T0))
    y = np.array([expm(A * t)[:, 6] for t in s.t])
    agree(-1 - s["a"].position[:, 2], y[:, 0], atol=error)
    agree(-1 - s["b"].position[:, 2], y[:, 1], atol=error)
    agree(R * s["hinge"].coordinate, y[:, 2], atol=error)
    for name, one in zip(("rope.1", "rope.2"), stretches):
        agree(s[name].tension, T0 + k * (y[:, :3] @ one), atol=10 * k * error)
    carried = s["rope.1"].tension + s["rope.2"].tension + 0.5 * G
    agree(s["hinge"].force[:, 2], carried, rtol=1e-9)


@pytest.mark.parametrize(("how", "error"), HOW)
def test_block_and_tackle(how, error):
    """4 : 1: the load goes down by y and the block up by u, s = y - 4 u: s'' = 5 g - k (1/m + 16/M) s."""
    m, M = 1.3, 4.0
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_body(carom.Box(0.6, 0.1, 0.1), mass=M, position=(0.3, 0, -2), name="block")
    scene.add_joint(joints.Prismatic((0, 0, 1)), GROUND, "block")
    scene.add_body(carom.Sphere(0.03), mass=m, position=(0.8, 0, -1), name="load")
    under, over = (0, -1, 0), (0, 1, 0)
    rope = scene.add_rope(
        [
            (GROUND, (0, 0, 0)),
            carom.Pulley("block", R, under, friction=0, center=(0.1, 0, -2)),
            carom.Pulley(GROUND, R, over, center=(0.3, 0, 0)),
            carom.Pulley("block", R, under, friction=0, center=(0.5, 0, -2)),
            carom.Pulley(GROUND, R, over, center=(0.7, 0, 0)),
            "load",
        ],
        stiffness=K,
    )
    s = carom.simulate(scene, 1.0, **how)
    square = K * (1 / m + 16 / M)
    stretch = 5 * G / square * (1 - np.cos(np.sqrt(square) * s.t))
    assert len(rope.springs) == 1
    np.testing.assert_allclose(s["rope1"].tension, K * stretch, atol=10 * K * error)
    # T twice integrated is (5 g t^2/2 - s)/(1/m + 16/M)
    pulled = (2.5 * G * s.t**2 - stretch) / (1 / m + 16 / M)
    fallen, raised = 0.5 * G * s.t**2 - pulled / m, 4 * pulled / M - 0.5 * G * s.t**2
    np.testing.assert_allclose(s["load"].position[:, 2], -1 - fallen, atol=10 * error)
    np.testing.assert_allclose(s["block"].position[:, 2], -2 + raised, atol=10 * error)


@pytest.mark.parametrize(("how", "error"), [({}, 1e-6), ({"rtol": 1e-10}, 1e-9)])
def test_slack(how, error):
    """A ball falls by h, oscillates in half a period and more, and is thrown back to its height; no impact."""
    h, m = 0.2, 1.0
    scene = carom.Scene(gravity=(0, 0, -G))
    ball = scene.add_body(carom.Sphere(0.03), mass=m, position=(0, 0, -1), name="ball")
    scene.add_rope([(GROUND, (1, 0, 0)), (GROUND, (0, 0, 0)), ball], 2.0 + h, stiffness=K)
    v, w, sag = np.sqrt(2 * G * h), np.sqrt(K / m), m * G / K
    amplitude = np.hypot(sag, v / w)
    taut = 2 * (np.pi - np.arctan2(v / w, sag)) / w
    first = v / G
    s = carom.simulate(scene, 2 * first + taut + 0.1, **how)
    t = s.t - first
    y = 0.5 * G * s.t**2
    inside = (t > 0) & (t < taut)
    y[inside] = h + sag + amplitude * np.cos(w * (t[inside] - 0.5 * taut))
    back = t >= taut
    y[back] = h - v * (t - taut)[back] + 0.5 * G * (t - taut)[back] ** 2
    after = t >= taut + 2 * first
    y[after] = np.nan  # it falls again
    known = ~np.isnan(y)
    np.testing.assert_allclose(-1 - s["ball"].position[known, 2], y[known], atol=error)
    np.testing.assert_allclose(s.total_energy, s.total_energy[0], atol=10 * error)
    tension = s["rope1"].tension
    assert np.all(tension[s.t < first] == 0.0)
    assert tension.max() > K * (amplitude + sag) * 0.999
    assert not len(s.impacts.time)


@verifies("add_rope(damping=)", "the work of the damper is what the energy loses", "invariant")
def test_damping_is_in_the_ledger():
    s = carom.simulate(pair((2.0, 2.5), damping=4.0), 3.0)
    mu = 2.0 * 2.5 / 4.5
    lost = -s.ledger.loads[-1]
    agree(s.total_energy[0] - s.total_energy[-1], lost, rtol=1e-6)
    np.testing.assert_allclose(
        s["rope"].tension[-1], 2 * mu * G, rtol=5e-2
    )  # the ring has died away
    assert lost > 0.0


def test_stiffness_of_parts():
    """Two parts in a row have the stiffness of the whole rope: of what is not laid on the wheel."""
    way = 2.0 + np.pi * R
    scene = pair((1.0, 1.0), carom.Pulley("wheel", R, (0, 1, 0)), length=way + 0.1)
    parts = [one.definition for one in scene.forces]
    np.testing.assert_allclose([p.stiffness for p in parts], K * (way + 0.1) / np.array([1.1, 1.0]))
    # taut where the first strand is longer by the slack, and the second at the start
    s = carom.simulate(scene, 0.01)
    assert s["rope.1"].tension[-1] == 0.0 < s["rope.2"].tension[-1]


def test_it_is_drawn():
    links = links_of(pair((1.0, 1.0)))
    assert [one.kind for one in links] == ["cord", "cord"]
    assert all(one.radii.any() for one in links)


def test_a_strand_that_leaves_its_plane_is_told_of():
    scene = pair((1.0, 1.5))
    scene.replace("a", velocity=(0, 0.5, 0))
    with pytest.warns(carom.AccuracyWarning, match="out of the plane of its pulley"):
        carom.simulate(scene, 0.2)


def test_files_and_changes(tmp_path):
    scene = pair((1.0, 1.5), carom.Pulley("wheel", R, (0, 1, 0)))
    path = tmp_path / "run.h5"
    goes_on(scene, 0.3, path, step=1e-2)
    scene.replace("a", mass=3.0)
    assert scene["rope.1"].definition.joint.terms[0][0].parent is scene["a"]
    scene.remove("hinge", dependents=True)
    assert not scene.forces


def test_cut_by_a_switch():
    """The loads fall freely from then on."""
    scene = pair((2.0, 2.0))
    scene.switch("rope", at=0.1)
    s = carom.simulate(scene, 0.3, rtol=1e-10)
    late = s.t >= 0.1
    v = s["a"].velocity[late, 2]
    np.testing.assert_allclose(v - v[0], -G * (s.t[late] - s.t[late][0]), atol=1e-9)
    assert np.all(s["rope"].tension[s.t > 0.1] == 0.0)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"stiffness": 0.0}, "stiffness must be"),
        ({"stiffness": 10.0, "damping": -1.0}, "damping must be"),
        ({"damping": 1.0}, "damping must be left out of a rope without stiffness"),
        ({"stiffness": 10.0, "restitution": 0.5}, "restitution must be left out of a rope with a"),
    ],
)
def test_wrong_input(more, message):
    with pytest.raises(ValueError, match=message):
        pair((1.0, 1.0)).add_rope(["a", OVER, "b"], name="other", **more)
