"""Bodies of 1e-12 to 1e12 kg beside each other: light ones do not matter; what is redundant is geometry."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from dense_reference import constraints, jacobian, rotations
from random_forests import build, plan
from test_bricard import CORNERS

import carom
from carom import GROUND, Scene, joints

Z = (0.0, 0.0, 1.0)
CRANK, ROCKER = np.array([0.0, 0.5, 0.0]), np.array([1.2, 0.0, 0.0])  # ends on coupler and ground
LONG, HIGH = 1.3, 1.0  # coupler and rocker


def four_bar(coupler: float, bars: float = 1.0, thin: float = 1e-4) -> Scene:
    """A crank-rocker of bars of 1 kg and a coupler of `coupler`, both times `bars`; gravity aslant."""
    between = np.linalg.norm(ROCKER - CRANK)
    along = (ROCKER - CRANK) / between
    a = (LONG**2 - HIGH**2 + between**2) / (2.0 * between)
    top = CRANK + a * along + np.sqrt(LONG**2 - a * a) * np.array([-along[1], along[0], 0.0])
    scene, bodies = Scene(gravity=(3.0, -9.81, 0.0)), []
    for p, q, mass in ((0.0 * top, CRANK, 1.0), (CRANK, top, coupler), (ROCKER, top, 1.0)):
        e = (q - p) / np.linalg.norm(q - p)
        inertia = (np.eye(3) - np.outer(e, e)) / 12.0 + thin * np.outer(e, e)
        mass *= bars
        bodies.append(
            scene.add_body(
                mass=mass, inertia=mass * (q - p) @ (q - p) * inertia, position=(p + q) / 2
            )
        )
    crank, rod, rocker = bodies
    scene.add_joint(joints.Revolute((0, 0, 0), Z), GROUND, crank)
    scene.add_joint(joints.Revolute(CRANK, Z), crank, rod)
    scene.add_joint(joints.Revolute(top, Z), rod, rocker, name="top")
    scene.add_joint(joints.Revolute(ROCKER, Z), GROUND, rocker)
    return scene


@pytest.mark.parametrize("bars", [1.0, 1e12, 1e-12])
def test_a_light_coupler_changes_the_motion_by_its_part_of_the_mass(bars):
    # by 0.14 m a unit of mass in the first second, as heavier couplers show
    run = [carom.simulate(four_bar(part, bars), 1.0, step=0.01) for part in (1e-15, 1e-4)]
    rate = np.max(np.abs(run[1].position[-1] - run[0].position[-1])) / 1e-4
    for part in (1e-6, 1e-8, 1e-9, 1e-10, 1e-12):
        moved = (
            carom.simulate(four_bar(part, bars), 1.0, step=0.01).position[-1] - run[0].position[-1]
        )
        assert np.max(np.abs(moved)) == pytest.approx(rate * part, rel=0.01, abs=1e-14)
    assert np.max(run[0].kinetic_energy) > 0.1 * bars  # it does move


@pytest.mark.parametrize("part", [1e-3, 1e-9, 1e-14])
def test_a_light_coupler_is_pulled_along_itself(part):
    # forces of 10 N on both ends; its own weight and inertia are the part that may be across
    run = carom.simulate(four_bar(part), 0.5, step=0.01)
    coupler = run.scene.joints[2].parent
    ends = (
        run.position[:, coupler.index] - 2.0 * (run.position[:, 0])
    )  # from the crank's end to the middle
    along = ends / np.linalg.norm(ends, axis=1)[:, None]
    force = run.joint_reactions[:, 2, :3]
    across = np.linalg.norm(np.cross(along, force), axis=1)
    assert np.max(np.abs(force)) > 1.0
    assert np.max(across) < 30.0 * part + 1e-9
    assert np.max(np.abs(run.joint_reactions[:, :, 2])) < 1e-9  # nothing out of the plane


def bricard(axial: float) -> Scene:
    """Five thin rods of 1 kg and 1 m, with this moment about their axes."""
    scene = Scene(gravity=(0, -9.81, 0))
    rods = []
    for a, b in pairwise(CORNERS):
        along = np.abs(b - a)
        inertia = np.diag(along * axial + (1.0 - along) / 12.0)
        rods.append(scene.add_body(mass=1.0, inertia=inertia, position=(a + b) / 2))
    ring = [GROUND, *rods, GROUND]
    edges = [CORNERS[k] - CORNERS[k - 1] for k in range(6)]
    for k in range(6):
        ends = (ring[k], ring[k + 1]) if ring[k + 1] is not GROUND else (GROUND, ring[k])
        scene.add_joint(joints.Revolute(CORNERS[k], np.cross(edges[k], edges[(k + 1) % 6])), *ends)
    return scene


def test_rods_without_moment_about_their_axes():
    thinnest = carom.simulate(bricard(1e-12), 2.0, step=0.01)
    assert abs(thinnest.ledger.residual[-1]) < 1e-6
    for axial in (1e-5, 1e-7, 1e-9, 1e-10):  # twice the moment, twice the change
        moved = carom.simulate(bricard(axial), 2.0, step=0.01).position[-1] - thinnest.position[-1]
        assert np.max(np.abs(moved)) < axial


def exact_accelerations(scene):
    """Solve [M, -A^T; A, 0] at rest with 60 digits, rows by differences of order 2 of exact steps."""
    mp = pytest.importorskip("mpmath")
    x, R = np.array([b.position for b in scene.bodies]), np.array(rotations(scene))
    A = np.vstack([jacobian(constraints(j), x, R) for j in scene.joints])
    n = 6 * len(x)
    with mp.workdps(60):
        M = mp.zeros(n)
        f = mp.zeros(n, 1)
        for b, body in enumerate(scene.bodies):
            J = R[b] @ body.inertia @ R[b].T
            for i in range(3):
                M[6 * b + i, 6 * b + i] = body.mass
                f[6 * b + i] = mp.mpf(body.mass) * scene.gravity[i]
                for k in range(3):
                    M[6 * b + 3 + i, 6 * b + 3 + k] = 0.5 * (J[i, k] + J[k, i])
        rows = mp.matrix(A.tolist())
        inverse = mp.inverse(M)
        lam = mp.lu_solve(rows * inverse * rows.T, rows * inverse * f)
        a = inverse * (f - rows.T * lam)
    return np.array([float(v) for v in a]).reshape(-1, 6)


@pytest.mark.few(4)
@pytest.mark.parametrize("seed", range(12))
def test_accelerations_of_random_loops(seed):
    """Masses from 1e-9 to 1e9 kg in a chain that a ball joint closes; rows by differences are good to 1e-9."""
    rng = np.random.default_rng(seed)
    rows = plan(rng, 4, floating=0.0, kinds=("Revolute", "Universal", "Prismatic"))
    for row in rows:
        part = 10.0 ** rng.uniform(-9.0, 9.0)
        row.update(mass=part * row["mass"], inertia=part * row["inertia"])
        row.update(velocity=np.zeros(3), angular_velocity=np.zeros(3))
    scene = build(rows)
    scene.add_joint(
        joints.PointOnPlane(normal=rng.normal(size=3), anchor=rng.normal(size=3)),
        GROUND,
        scene.bodies[3],
    )
    h = 1e-5
    run = carom.simulate(scene, h, step=h, options=carom.Options(energy_tolerance=0.01))  # one step
    found = np.hstack([run.velocity[-1], run.angular_velocity[-1]]) / h
    known = exact_accelerations(scene)
    scale = np.max(np.abs(known))
    np.testing.assert_allclose(found, known, atol=1e-6 * scale + 1e-6, rtol=0)


def test_masses_beyond_all_digits_are_refused_by_name():
    with pytest.raises(ValueError, match=r"'body2' and 'body1'.*1e\+24"):
        carom.simulate(four_bar(1e-26), 0.1, step=0.01)


def test_a_link_without_a_shape_whose_joints_are_at_its_mass_centre_does_not_shorten_steps():
    """Its size is its radius of gyration, (J/m)^1/2 = 1 cm, not the arm of 1e-5 m: two axes of a gimbal."""
    steps = []
    for arm in (0.0, 1e-5):
        scene = Scene(gravity=(0, 0, -9.81))
        link = scene.add_body(mass=0.1, inertia=(1e-5,) * 3, position=(0, 0, 1))
        bar = scene.add_body(shape=carom.Box(0.4, 0.1, 0.1), mass=1.0, position=(0.2, 0, 1))
        axis = scene.add_joint(joints.Revolute((arm, 0, 1), (1, 0, 0)), GROUND, link)
        scene.add_stop(axis, lower=-1.0)
        scene.add_joint(joints.Revolute((-arm, 0, 1), (0, 1, 0)), link, bar)
        scene.add_half_space((0, 0, 0.7), (0, 0, 1))
        steps.append(carom.simulate(scene, 0.1).stats["trial_steps"])
    assert steps[1] == steps[0]
