"""Andrews' squeezing mechanism (IVP test set; IFToMM A03): ten hinges, three closed loops.

Planar, with hinges in space: 50 rows for 42 coordinates and one freedom, so nine are redundant.
"""

import numpy as np
import pytest
from mechanism_scenes import about, orders

import carom
from carom import GROUND, Scene, forces, joints
from references.andrews import andrews_data, minimal_from_absolute
from verified import agree, verifies

DATA = andrews_data()
ANGLES, RATES = (np.array(DATA["reference"][key]) for key in ("angles", "rates"))


def andrews():
    scene, at = Scene(gravity=(0, 0, 0)), {"ground": GROUND}
    for body in DATA["bodies"]:
        at[body["name"]] = scene.add_body(
            mass=body["mass"], inertia=[body["inertia"]] * 3, position=(*body["centre"], 0),
            orientation=about((0, 0, 1), body["angle"]), name=body["name"],
        )  # fmt: skip
    for joint in DATA["joints"]:
        hinge = joints.Revolute((*joint["anchor"], 0), (0, 0, 1))
        scene.add_joint(hinge, at[joint["parent"]], at[joint["child"]], name=joint["name"])
    s, t = DATA["spring"], DATA["torque"]
    ends = ((*s["ground_point"], 0), (*s["body_point"], 0))
    scene.add_force(forces.Spring(s["stiffness"], *ends, rest_length=s["length"]), at[s["body"]])
    scene.add_force(forces.Torque((0, 0, t["value"])), at[t["body"]])
    return scene


def simulate(step, method="rk4"):
    return carom.simulate(andrews(), DATA["t_end"], step=step, method=method)


def errors(solution):
    """Greatest errors of the published angles (relative) and rates (to the greatest) at the end."""
    q = solution.orientation
    turned = 2.0 * np.arctan2(q[..., 3], q[..., 0])
    turned = np.unwrap(turned, axis=0)
    start = np.array([body["angle"] for body in DATA["bodies"]])
    angles = minimal_from_absolute(start + turned[-1] - turned[0])
    rates = minimal_from_absolute(solution.angular_velocity[-1, :, 2])
    relative = np.max(np.abs(angles / ANGLES - 1.0))
    return relative, np.max(np.abs(rates - RATES)) / np.max(np.abs(RATES))


@verifies("joints.Revolute", "Andrews' squeezer after 0.03 s", "publication: IVP test set")
@pytest.mark.parametrize(("step", "angle", "rate"), [(1e-4, 1e-6, 2e-6), (2.5e-5, 1e-9, 5e-9)])
def test_end_values_as_published(step, angle, rate):
    end = errors(simulate(step))
    agree(end[0], 0.0, atol=angle)
    agree(end[1], 0.0, atol=rate)


# order 2: 2e-4 of the energy at the longest step
@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")
def test_papers_method_has_order_two():
    both = np.array([errors(simulate(h, "paper")) for h in (5e-5, 2.5e-5, 1.25e-5)])
    np.testing.assert_allclose(orders(both), 2.0, rtol=0, atol=0.1)
    assert np.all(both[-1] < 1e-5)


def test_ode_form_comes_near():
    assert errors(simulate(1.25e-5, "paper-ode"))[0] < 2e-5


# the paper's method: 1e-3 of the energy at this step
@pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")
@pytest.mark.parametrize("method", ["rk4", "paper"])
def test_loops_stay_closed_and_the_plane_is_kept(method):
    solution = simulate(1e-4, method)
    position, velocity = solution.constraint_errors
    assert np.max(position) < 1e-12
    assert np.max(velocity) < 1e-12 * np.max(np.abs(solution.velocity)) + 1e-12
    assert np.max(np.abs(solution.position[..., 2])) < 1e-15
    assert np.all(np.isfinite(solution.joint_reactions))


def test_energy_is_the_work_of_the_torque():
    # the balance of IFToMM A03: T + V - E0 = torque (beta - beta0); here 0.033 N m x 15.87 rad
    solution = simulate(2.5e-5)
    work = DATA["torque"]["value"] * (ANGLES[0] - DATA["minimal"][0])
    assert solution.ledger.loads[-1] == pytest.approx(work, rel=1e-7)
    gained = solution.total_energy[-1] - solution.total_energy[0]
    assert gained == pytest.approx(work, rel=1e-7)
    assert np.max(np.abs(solution.ledger.residual)) < 1e-7 * work
