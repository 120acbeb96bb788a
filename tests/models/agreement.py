"""A scene made from a model beside MuJoCo itself: both in the coordinates of the model.

With J the derivative of the velocities of all bodies of the scene by those of the model, MuJoCo's own,

    M = J^T diag(m, R I R^T) J + diag(armature),    gravity = J^T (m g, 0),    a = J q'' + J' q'.
"""

from pathlib import Path
from unittest.mock import patch

import mujoco
import numpy as np

import carom
from carom import run
from carom.geometry import quaternion
from carom.stepping.islands.layout import no_islands

DATA = Path(__file__).parents[1] / "data" / "models"
MODELS = sorted(
    p for p in DATA.rglob("*") if p.suffix in (".xml", ".urdf") and p.parent.name != "common"
)
OFF = mujoco.mjtDisableBit


def compiled(path, keep=()):
    """Return the MjModel of a file, without what only acts (limits, dry friction, tendons) or is soft."""
    m = carom.load_model(path, contacts=False).mujoco
    off = OFF.mjDSBL_CONTACT | OFF.mjDSBL_LIMIT | OFF.mjDSBL_ACTUATION
    m.opt.disableflags |= int(off)
    m.opt.density = m.opt.viscosity = 0.0
    m.jnt_limited[:] = 0
    m.dof_frictionloss[:] = 0.0
    m.tendon_stiffness[:] = 0.0
    m.tendon_damping[:] = 0.0
    m.tendon_armature[:] = 0.0
    if "equalities" not in keep:
        m.eq_active0[:] = 0
    return m


def random_state(m, seed, scale=0.4):
    """Return coordinates and velocities; seed 0 is the default configuration at rest."""
    if seed == 0:
        return m.qpos0.copy(), np.zeros(m.nv)
    rng, q = np.random.default_rng(seed), m.qpos0.copy()
    mujoco.mj_integratePos(m, q, rng.normal(size=m.nv) * scale, 1.0)
    return q, rng.normal(size=m.nv)


def element(m, kind, name):
    """Return an element of the model by the name that the scene has for it; some have only a number."""
    known = {getattr(m, kind)(k).name for k in range(m.nbody if kind == "body" else m.njnt)}
    return getattr(m, kind)(name if name in known else int(name.removeprefix(kind)))


def jacobian(m, d, body, point, without=()):
    linear, angular = np.zeros((3, m.nv)), np.zeros((3, m.nv))
    mujoco.mj_jac(m, d, linear, angular, np.array(point), body)
    J = np.vstack([linear, angular])
    J[:, list(without)] = 0.0
    return J


def jacobians(model, d):
    """Return J (N, 6, nv) of all bodies of the scene: those of the model, and links between."""
    m, scene, J = model.mujoco, model.scene, np.zeros((len(model.scene.bodies), 6, model.mujoco.nv))
    for b in scene.bodies:
        if b.name.endswith(":link"):
            j = element(m, "joint", b.name.removesuffix(":link"))
            same = m.dof_bodyid == j.bodyid[0]
            later = np.flatnonzero(same & (m.dof_jntid > j.id))
            J[b.index] = jacobian(m, d, j.bodyid[0], b.position, later)
        else:
            J[b.index] = jacobian(m, d, element(m, "body", b.name).id, b.position)
    return J


def mass_matrix_and_gravity(model, J):
    M, f = 0.0, 0.0
    for b in model.scene.bodies:
        R, block = quaternion.matrix(b.orientation), np.zeros((6, 6))
        block[:3, :3], block[3:, 3:] = b.mass * np.eye(3), R @ b.inertia @ R.T
        M = M + J[b.index].T @ block @ J[b.index]
        f = f + J[b.index, :3].T @ (b.mass * model.scene.gravity)
    for force in model.scene.forces:
        if force.kind == "Force":  # gravcomp
            at = element(model.mujoco, "body", force.name.removesuffix(":gravcomp"))
            d = mujoco.MjData(model.mujoco)
            d.qpos[:] = model.scene.robot.start
            mujoco.mj_forward(model.mujoco, d)
            f = f + jacobian(model.mujoco, d, at.id, d.xipos[at.id])[:3].T @ force.definition.vector
        elif force.kind == "JointInertia":
            dof = element(model.mujoco, "joint", force.name.removesuffix(":armature")).dofadr[0]
            M[dof, dof] += force.definition.inertia
    return M, f


def mujoco_data(m, q, v):
    d = mujoco.MjData(m)
    d.qpos[:], d.qvel[:] = q, v
    mujoco.mj_forward(m, d)
    return d


def full_mass(m, d):
    """Return M (nv, nv), column by column: `mj_fullM` has other arguments in each version."""
    columns = np.zeros((m.nv, m.nv))
    for column, unit in zip(columns, np.eye(m.nv)):
        mujoco.mj_mulM(m, d, column, unit)
    return columns.T


def first_accelerations(scene):
    """Return the accelerations (N, 6) with which a run begins: the first stage of its first step.

    Bodies that are free have none: they have that of gravity, and turn as balls do. All bodies move together,
    because stages are workspace, which islands share.
    """
    with patch.object(run, "new_islands", lambda system, active, later: no_islands(system, active)):
        made = carom.simulate(scene, 1e-9, step=1e-9)._run
    free = made.bodies["ballistic"] == 1
    return np.where(free[:, None], [*scene.gravity, 0.0, 0.0, 0.0], made.work.stages.rate[0])


def accelerations(m, d, J, model):
    """Return J q'' + J' q' (N, 6) of the bodies of the model, with which of these of the scene they are."""
    rows, chosen = [], []
    for b in model.scene.bodies:
        if ":" in b.name:
            continue
        dot = np.zeros((2, 3, m.nv))
        mujoco.mj_jacDot(m, d, *dot, np.array(b.position), element(m, "body", b.name).id)
        rows.append(J[b.index] @ d.qacc + dot.reshape(6, -1) @ d.qvel)
        chosen.append(b.index)
    return np.array(rows), chosen
