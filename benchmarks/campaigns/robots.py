"""Robots: models of others (MJCF) thrown on a floor, in any position that their joints allow."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import carom
from campaigns.case import Case

DATA = Path(__file__).parents[2] / "tests" / "data" / "models"
MODELS = (
    "gymnasium/ant.xml", "gymnasium/hopper.xml", "dm_control/walker.xml", "dm_control/cheetah.xml",
    "dm_control/quadruped.xml", "dm_control/humanoid.xml",
)  # fmt: skip
STEP, DURATION = 1e-3, 0.5


def case(seed: int) -> Case:
    """Return robot number `seed`: models in turn, e from 0 to .8, mu from 0 to 1.2."""
    rng = np.random.default_rng([6, seed])
    name = MODELS[seed % len(MODELS)]
    e = float(rng.choice([0.0, 0.3, 0.8, rng.uniform(0.0, 0.8)]))
    mu = float(rng.choice([0.0, 0.6, rng.uniform(0.0, 1.2)]))
    law = str(rng.choice(["newton", "poisson", "stronge"]))
    model = _thrown(name, rng, restitution=e, friction=mu, impact_law=law)
    label = {
        "kind": name, "step": STEP, "bodies": len(model.scene.bodies),
        "restitution": e, "friction": mu, "impact_law": law,
    }  # fmt: skip
    return Case(model.scene, DURATION, STEP, label)


def _thrown(name: str, rng, **contact):
    """Return the model in a random position within its limits and at random rates, just above the floor."""
    import mujoco

    m = mujoco.MjModel.from_xml_path(str(DATA / name))
    q, v = m.qpos0.copy(), rng.normal(size=m.nv)
    for j in range(m.njnt):
        at = m.jnt_qposadr[j]
        if m.jnt_limited[j]:
            low, high = m.jnt_range[j]
            q[at] = rng.uniform(0.9 * low + 0.1 * high, 0.1 * low + 0.9 * high)
        elif m.jnt_type[j] == mujoco.mjtJoint.mjJNT_FREE and rng.random() < 0.5:
            turn = rng.normal(size=4)
            q[at + 3 : at + 7] = turn / np.linalg.norm(turn)
    for e in np.flatnonzero(m.eq_type == mujoco.mjtEq.mjEQ_TENDON):  # lengths that stay
        row, first = np.zeros(m.nv), m.tendon_adr[m.eq_obj1id[e]]
        for w in range(first, first + m.tendon_num[m.eq_obj1id[e]]):
            row[m.jnt_dofadr[m.wrap_objid[w]]] = m.wrap_prm[w]
        v -= row * (row @ v) / (row @ row)
    return carom.load_model(m, qpos=q, qvel=v, **contact)
