"""Single joints to the ground against trajectories of a commercial code, from the tests of Project Chrono.

Six digits; its own errors (found by two formulations in closed form) are below the second number of each row.
"""

from pathlib import Path

import numpy as np
import pytest

import carom
from carom import GROUND, joints
from carom.geometry import quaternion
from verified import agree, verifies

FILE = Path(__file__).parents[1] / "data" / "adams" / "adams_joints.npz"
OURS = 2e-4


def turned(angle):
    """Quaternion of a turn about x."""
    return np.array([np.cos(angle / 2), np.sin(angle / 2), 0, 0])


#: joint, point, turn of the body; errors of the reference: position (of 1 + |x|), velocity, attitude
CASES = {
    "Revolute_Case01": (joints.Revolute, (0, 0, 0), -np.pi / 2, 5e-6, 5e-6, 5e-7),
    "Spherical_Case01": (joints.Spherical, (0, 0, 0), 0.0, 9e-4, 2.6e-3, 2e-4),
    "Prismatic_Case02": (joints.Prismatic, (1, 2, 3), -np.pi / 4, 5e-6, 5e-5, 5e-7),
    "Distance_Case01": (joints.Distance, (0, 0, 0), 0.0, 5e-6, 5e-6, 5e-7),
}


def simulate(case):
    kind, point, angle, *_ = CASES[case]
    point, q = np.array(point, dtype=float), turned(angle)
    axis = quaternion.rotate(q, [0, 0, 1])
    centre = point + quaternion.rotate(q, [2, 0, 0])
    if kind is joints.Distance:
        centre = np.array([0.0, 2.0, 0.0])
    scene = carom.Scene(gravity=(0, 0, -9.80665))
    body = scene.add_body(
        mass=1.0, inertia=np.diag([0.04, 0.1, 0.1]), position=centre, orientation=q
    )
    joint = {
        joints.Revolute: lambda: joints.Revolute(point, axis),
        joints.Spherical: lambda: joints.Spherical(point),
        joints.Prismatic: lambda: joints.Prismatic(axis, point),
        joints.Distance: lambda: joints.Distance(point, centre),
    }[kind]()
    scene.add_joint(joint, GROUND, body)
    return carom.simulate(scene, 5.0, step=1e-3, save_every=50)


@verifies("joints.{kind}", "motion and reactions of a body on one joint", "other program: Adams")
@pytest.mark.parametrize(("kind", "case"), [(case.partition("_")[0], case) for case in CASES])
def test_motion_and_reactions(kind, case):
    s = simulate(case)
    with np.load(FILE) as data:
        names = ("t", "Pos", "Vel", "Quat", "Avel", "Rforce", "Rtorque")
        known = {name: data[f"{case}/{name}"] for name in names}
    position, velocity, attitude = CASES[case][3:]
    agree(s.t, known["t"], atol=1e-9)
    far = 1.0 + np.abs(known["Pos"]).max()
    agree(s.position[:, 0], known["Pos"], atol=position * far + OURS)
    agree(s.velocity[:, 0], known["Vel"], atol=velocity + OURS)
    agree(s.angular_velocity[:, 0], known["Avel"], atol=velocity + OURS)
    Q = s.orientation[:, 0]
    Q = Q * np.sign(np.sum(Q * known["Quat"], axis=1, keepdims=True))
    agree(Q, known["Quat"], atol=attitude + OURS)
    # on the ground, about the joint's point: ours are on the body at its anchor
    force = -s.joint_reactions[:, 0, :3]
    torque = -s.joint_reactions[:, 0, 3:]
    if case == "Prismatic_Case02":  # the anchor slides away from the point
        torque = torque + np.cross(s.position[:, 0] - s.position[0, 0], force)
    agree(force, known["Rforce"], atol=2e-2)
    # of the sliding body up to 600 N m, over 60 m: its digits there are good to 1e-4
    agree(torque, known["Rtorque"], rtol=2e-4, atol=2e-2)
