"""Random forests: tree back end = loop back end = a dense solve by other means; invariances."""

import numpy as np
import pytest
from dense_reference import solve
from mechanism_scenes import matrix, run
from random_forests import build, plan, with_loop
from scipy.spatial.transform import Rotation

import carom

SEEDS = range(6)


def forest(seed, count=6, **more):
    rng = np.random.default_rng(seed)
    return plan(rng, count, **more)


def wrench_on_centre(scene, solution, k=0):
    """Reactions at the start, on children, moved from their anchor to their mass centre."""
    out = solution.joint_reactions[k].copy()
    for j, joint in enumerate(scene.joints):
        d = joint.definition
        anchor = getattr(d, "anchor_child", getattr(d, "anchor", None))
        if anchor is not None:
            out[j, 3:] += np.cross(anchor - joint.child.position, out[j, :3])
    return out


@pytest.mark.few(4)
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("looped", [False, True], ids=["tree", "loop"])
def test_reactions_and_accelerations_equal_a_dense_solve(seed, looped):
    scene = build(forest(seed))
    if looped:
        scene = with_loop(scene)
    a, wrenches, _, wrong = solve(scene)
    assert wrong < 1e-8  # differences: the velocities fit the joints
    h = 1e-3
    solution = carom.simulate(scene, h, step=h)
    scale = np.max(np.abs(wrenches))
    np.testing.assert_allclose(
        wrench_on_centre(scene, solution), wrenches[:, 0], rtol=0, atol=2e-7 * scale
    )  # fmt: skip
    # accelerations by differences of the motion forward and backward in time, two steps combined
    found = [central(scene, k * h) for k in (1.0, 0.5)]
    found = (4.0 * found[1] - found[0]) / 3.0
    np.testing.assert_allclose(found, a, rtol=0, atol=1e-6 * np.max(np.abs(a)))


def central(scene, h):
    """(velocity at h - velocity at -h)/2h; the motion backward is that of reversed velocities."""
    ends = []
    for sign in (1.0, -1.0):
        copy = carom.Scene(gravity=scene.gravity)
        for b in scene.bodies:
            copy.add_body(
                name=b.name, mass=b.mass, inertia=b.inertia, position=b.position,
                orientation=b.orientation, velocity=sign * b.velocity,
                angular_velocity=sign * b.angular_velocity,
            )  # fmt: skip
        for j in scene.joints:
            parent = carom.GROUND if j.parent.index < 0 else copy[j.parent.name]
            copy.add_joint(j.definition, parent, copy[j.child.name], name=j.name)
        end = run(copy, h, h)
        ends.append(sign * np.concatenate([end.velocity[-1], end.angular_velocity[-1]], axis=1))
    return (ends[0] - ends[1]) / (2.0 * h)


@pytest.mark.few(2)
@pytest.mark.parametrize("seed", SEEDS)
def test_both_back_ends_move_alike(seed):
    rows = forest(seed)
    tree, loop = run(build(rows), 0.1, 1e-3), run(with_loop(build(rows)), 0.1, 1e-3)
    n = len(rows)
    np.testing.assert_allclose(loop.position[-1, :n], tree.position[-1], rtol=0, atol=1e-10)
    np.testing.assert_allclose(loop.velocity[-1, :n], tree.velocity[-1], rtol=0, atol=1e-9)
    np.testing.assert_allclose(loop.orientation[-1, :n], tree.orientation[-1], rtol=0, atol=1e-10)


@pytest.mark.few(2)
@pytest.mark.parametrize("seed", SEEDS)
def test_energy_and_joints(seed):
    fine, coarse = (carom.simulate(build(forest(seed)), 0.2, step=h) for h in (5e-4, 1e-3))
    for s in (fine, coarse):
        assert np.max(s.constraint_errors[0]) < 1e-12
        assert np.max(s.constraint_errors[1]) < 1e-11
    drift = [np.max(np.abs(s.ledger.residual)) for s in (coarse, fine)]
    assert drift[1] < 1e-9 * np.max(fine.kinetic_energy)
    assert drift[1] < drift[0] / 8.0 or drift[0] < 1e-11


@pytest.mark.few(2)
@pytest.mark.parametrize("seed", SEEDS)
def test_momentum_of_a_floating_tree(seed):
    """One tree without ground: spatial momenta are constant without gravity, to round-off."""
    rng = np.random.default_rng(100 + seed)
    rows = plan(rng, 6, floating=0.0)
    for row in rows:
        row["parent"] = None if row["name"] == "b0" else max(row["parent"], 0)
    rows = refit(rows, rng)
    s = carom.simulate(build(rows, gravity=(0, 0, 0)), 1.0, step=0.005)
    mass = np.array([r["mass"] for r in rows])
    linear = np.einsum("n,tnk->tk", mass, s.velocity)
    spin = 0.0
    for k, row in enumerate(rows):
        R = np.array([matrix(q) for q in s.orientation[:, k]])
        W = np.einsum("tji,tj->ti", R, s.angular_velocity[:, k])
        spin = spin + np.einsum("tij,tj->ti", R, W @ row["inertia"])
        spin = spin + mass[k] * np.cross(s.position[:, k], s.velocity[:, k])
    scale = np.max(np.abs(spin)) + np.max(np.abs(linear))
    np.testing.assert_allclose(linear, linear[[0]] + 0 * linear, rtol=0, atol=1e-12 * scale)
    np.testing.assert_allclose(spin, spin[[0]] + 0 * spin, rtol=0, atol=1e-8 * scale)
    centre = np.einsum("n,tnk->tk", mass, s.position)
    drift = centre - centre[0] - s.t[:, None] * linear[0]
    assert np.max(np.abs(drift)) < 1e-11 * scale


def refit(rows, rng):
    """Give velocities that fit the parents as they are now."""
    for row in rows[1:]:
        up = rows[row["parent"]]
        rate = {"Revolute": rng.normal() * row["axis"], "Spherical": rng.normal(size=3)}
        w = up["angular_velocity"] + rate.get(row["kind"], 0.0)
        arm = row["anchor"] - up["position"]
        v = up["velocity"] + np.cross(up["angular_velocity"], arm)
        v = v + np.cross(w, row["position"] - row["anchor"])
        row["velocity"], row["angular_velocity"] = v, w
    return rows


@pytest.mark.few(2)
@pytest.mark.parametrize("seed", SEEDS)
def test_order_of_bodies_and_joints_and_flips_do_not_matter(seed):
    rows, rng = forest(seed), np.random.default_rng(seed)
    n = len(rows)
    plain = build(rows)
    bodies, edges = rng.permutation(n), rng.permutation(n)
    mixed = build(rows, bodies=bodies, edges=edges, flips=set(rng.permutation(n)[: n // 2]))
    a, b = run(plain, 0.1, 1e-3), run(mixed, 0.1, 1e-3)
    for body in plain.bodies:
        i, j = body.index, mixed[body.name].index
        np.testing.assert_allclose(b.position[-1, j], a.position[-1, i], rtol=0, atol=1e-10)
        np.testing.assert_allclose(b.velocity[-1, j], a.velocity[-1, i], rtol=0, atol=1e-9)
    scale = np.max(np.abs(a.joint_reactions)) if plain.joints else 1.0
    for joint in plain.joints:
        same = mixed[joint.name]
        sign = 1.0 if same.child.name == joint.child.name else -1.0
        f, g = a.joint_reactions[:, joint.index], b.joint_reactions[:, same.index]
        np.testing.assert_allclose(sign * g[:, :3], f[:, :3], rtol=0, atol=1e-8 * scale)
        if joint.kind != "Prismatic" or sign > 0:  # else the torques are about other points
            np.testing.assert_allclose(sign * g[:, 3:], f[:, 3:], rtol=0, atol=1e-8 * scale)


@pytest.mark.few(2)
@pytest.mark.parametrize("seed", SEEDS)
def test_frame_does_not_matter(seed):
    rows = forest(seed)
    turn = Rotation.random(random_state=seed).as_matrix()
    a, b = run(build(rows), 0.1, 1e-3), run(build(rows, turn=turn), 0.1, 1e-3)
    np.testing.assert_allclose(b.position[-1], a.position[-1] @ turn.T, rtol=0, atol=1e-10)
    np.testing.assert_allclose(
        b.angular_velocity[-1], a.angular_velocity[-1] @ turn.T, rtol=0, atol=1e-9
    )
    np.testing.assert_allclose(
        b.joint_reactions[-1, :, :3], a.joint_reactions[-1, :, :3] @ turn.T, rtol=0, atol=1e-8
    )
