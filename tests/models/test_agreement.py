"""Masses, places, weights and first accelerations of models are MuJoCo's."""

import mujoco
import numpy as np
import pytest

import carom
from verified import agree, verifies

from .agreement import (
    DATA,
    MODELS,
    accelerations,
    compiled,
    element,
    first_accelerations,
    full_mass,
    jacobians,
    mass_matrix_and_gravity,
    mujoco_data,
    random_state,
)

NAMES = [str(path.relative_to(DATA)) for path in MODELS]


def relative(a, b):
    return np.max(np.abs(a - b)) / max(np.max(np.abs(b)), 1e-30)


def test_there_are_models_enough():
    assert len(NAMES) >= 16


@verifies("load_model", "places and velocities of the bodies of models", "other program: MuJoCo")
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in (1, 2))])
def test_masses_weights_and_places(name, seed):
    m = compiled(DATA / name)
    q, v = random_state(m, seed)
    model = carom.load_model(m, qpos=q, qvel=v, contacts=False)
    d = mujoco_data(m, q, v)
    J = jacobians(model, d)
    M, weight = mass_matrix_and_gravity(model, J)
    assert relative(M, full_mass(m, d)) < 1e-10
    rest = mujoco_data(m, q, np.zeros(m.nv))
    gravity = rest.qfrc_bias - rest.qfrc_gravcomp
    agree(weight + gravity, 0.0, atol=1e-10 * max(np.max(np.abs(gravity)), 1e-3))
    for b in model.scene.bodies:
        if ":" in b.name:
            continue
        root = element(m, "body", b.name).id
        members = np.flatnonzero(m.body_weldid == root)
        centre = m.body_mass[members] @ d.xipos[members] / m.body_mass[members].sum()
        agree(b.position, centre, atol=1e-10)
        agree(b.orientation, d.xquat[root], atol=1e-10)
        motion = np.append(b.velocity, b.angular_velocity)
        agree(motion, J[b.index] @ v, atol=1e-10)


# Of a tree to round-off; where links between stand in loops they are 1e-6 of the body's mass.
@pytest.mark.few(8)
@pytest.mark.parametrize(
    ("name", "tolerance"),
    [
        ("own/joints.xml", 1e-10),
        ("dm_control/fish.xml", 1e-10),
        ("dm_control/manipulator.xml", 1e-10),
        ("dm_control/cheetah.xml", 1e-10),
        ("dm_control/quadruped.xml", 1e-10),
        ("dm_control/humanoid.xml", 1e-10),
        ("gymnasium/ant.xml", 1e-10),
        ("gymnasium/hopper.xml", 1e-10),
        ("gymnasium/reacher.xml", 1e-10),
        ("robots/panda/panda.urdf", 1e-10),
        ("robots/double_pendulum/double_pendulum.urdf", 1e-10),
    ],
)
@pytest.mark.parametrize("seed", [0, 1])
def test_first_accelerations(name, tolerance, seed):
    m = compiled(DATA / name)
    q, v = random_state(m, seed)
    if "joints" in name:  # the spring of a ball joint is represented where it starts relaxed
        ball = m.joint("ball").qposadr[0]
        q[ball : ball + 4] = m.qpos_spring[ball : ball + 4]
    model = carom.load_model(m, qpos=q, qvel=v, contacts=False)
    d = mujoco_data(m, q, v)
    expected, chosen = accelerations(m, d, jacobians(model, d), model)
    scale = max(np.max(np.abs(expected)), np.max(np.abs(v)) ** 2, 1.0)
    error = np.max(np.abs(first_accelerations(model.scene)[chosen] - expected))
    assert error <= tolerance * scale


def test_loops_and_couplings_accelerate_as_the_model_with_its_constraints():
    """Constraints of MuJoCo are soft: its accelerations are those of the least constraint J q'' = -J' q', from
    its own Jacobian of constraints, solved here with M."""
    m = compiled(DATA / "own" / "loops.xml", keep=("equalities",))
    model = carom.load_model(m, contacts=False)
    assert {c.kind for c in model.scene.constraints} == {"Coupling"}
    d = mujoco_data(m, m.qpos0, np.zeros(m.nv))
    full = full_mass(m, d)
    rows = np.zeros((d.nefc, m.nv))
    if mujoco.mj_isSparse(m):
        mujoco.mju_sparse2dense(rows, d.efc_J, d.efc_J_rownnz, d.efc_J_rowadr, d.efc_J_colind)
    else:
        rows[:] = d.efc_J.reshape(d.nefc, m.nv)
    free = np.linalg.solve(full, d.qfrc_smooth)
    S = rows @ np.linalg.solve(full, rows.T)
    qacc = free - np.linalg.solve(full, rows.T @ np.linalg.lstsq(S, rows @ free, rcond=1e-10)[0])
    J = jacobians(model, d)
    found = first_accelerations(model.scene)
    for b in model.scene.bodies:
        if ":" not in b.name:
            np.testing.assert_allclose(found[b.index], J[b.index] @ qacc, rtol=0, atol=1e-9)


@verifies("load_model", "motion of a model with all joints", "other program: MuJoCo")
def test_motion_in_coordinates_of_the_model():
    """Two integrators of order 4: steps of 1 ms leave 1e-8 of them."""
    m = compiled(DATA / "own" / "joints.xml")
    m.opt.integrator, m.opt.timestep = mujoco.mjtIntegrator.mjINT_RK4, 2.5e-4
    q, v = random_state(m, 3, scale=0.1)
    ball = m.joint("ball").qposadr[0]
    q[ball : ball + 4] = m.qpos_spring[ball : ball + 4]
    model = carom.load_model(m, qpos=q, qvel=v, contacts=False)
    solution = carom.simulate(model.scene, 0.1, step=1e-3)
    d = mujoco_data(m, q, v)
    for _ in range(400):
        mujoco.mj_step(m, d)
    found, expected = model.qpos(solution), d.qpos.copy()
    agree(found[0], q, atol=1e-12)
    for start in (ball, m.jnt_qposadr[m.body("flyer").jntadr[0]] + 3):  # q and -q are one
        found[-1, start : start + 4] *= np.sign(
            found[-1, start : start + 4] @ expected[start : start + 4]
        )
    agree(found[-1], expected, atol=1e-7)
