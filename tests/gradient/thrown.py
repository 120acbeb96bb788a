"""A thrown die whose every number can be changed a little, and differences of whole runs."""

import numpy as np

import carom
from carom.geometry import quaternion

NAMES = (
    "die.position", "die.orientation", "die.velocity", "die.angular_velocity", "die.mass", "die.inertia",
    "die-ground.restitution", "die-ground.friction", "gravity",
)  # fmt: skip
SCALE = np.array(
    [0.02] * 3 + [1.0] * 3 + [1.0] * 3 + [10.0] * 3 + [0.016] + [1e-6] * 6 + [1.0] * 2 + [10.0] * 3
)
EQUAL = 0.016 * 0.02**2 / 6 * np.eye(3)
UNEQUAL = 0.016 * 0.02**2 / 6 * np.array([[1.0, 0.1, 0.05], [0.1, 1.4, -0.08], [0.05, -0.08, 0.8]])
SIX = ((-3, -1 / 60), (-2, 3 / 20), (-1, -3 / 4), (1, 3 / 4), (2, -3 / 20), (3, 1 / 60))
FORWARD = ((0, -49 / 20), (1, 6), (2, -15 / 2), (3, 20 / 3), (4, -15 / 4), (5, 6 / 5), (6, -1 / 6))


def throw(
    z=None,
    *,
    inertia=EQUAL,
    spin=(3, 10, -2),
    e=0.5,
    mu=0.2,
    law="newton",
    duration=0.2,
    step=2.5e-4,
):
    """Run the throw with `z` (24,) added to its numbers, in the order of NAMES."""
    z = np.zeros(24) if z is None else z
    q = quaternion.multiply(quaternion.exp(z[3:6]), [0.8, 0.36, -0.48, 0.0])
    J = z[13:19]
    scene = carom.Scene(gravity=np.array([0, 0, -9.81]) + z[21:])
    ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
    die = scene.add_body(
        carom.Box(0.02, 0.02, 0.02), mass=0.016 + z[12],
        inertia=inertia + np.array([[J[0], J[3], J[4]], [J[3], J[1], J[5]], [J[4], J[5], J[2]]]),
        position=np.array([0, 0, 0.1]) + z[:3], orientation=q,
        velocity=np.array([0.5, 0.1, -0.5]) + z[6:9], angular_velocity=np.array(spin) + z[9:12],
        name="die",
    )  # fmt: skip
    scene.add_contact(die, ground, restitution=e + z[19], friction=mu + z[20], impact_law=law)
    return carom.simulate(scene, duration, step=step)


def outcome(run, reference):
    """Return the final state, and all of the impacts, as one array; turns from those of a reference."""
    turn = quaternion.multiply(run.orientation[-1], quaternion.conjugate(reference.orientation[-1]))
    table = run.impacts
    return np.concatenate([
        run.position[-1].ravel(), quaternion.log(turn).ravel(), run.velocity[-1].ravel(),
        run.angular_velocity[-1].ravel(), table.time, table.point.ravel(),
        table.relative_velocity_before.ravel(), table.relative_velocity_after.ravel(), table.impulse.ravel(),
    ])  # fmt: skip


def derivative(found):
    """Return the same of `Sensitivities`, (numbers, P)."""
    arrays = (
        *found.final, found.impact_time, found.impact_point, found.velocity_before,
        found.velocity_after, found.impulse,
    )  # fmt: skip
    return np.concatenate([a.reshape(-1, len(found.labels)) for a in arrays])


def difference(run_with, reference, k, step, weights=SIX):
    """Return the difference quotient of runs by number k, or None where the sequence of contact changes."""
    total, count = 0.0, len(SCALE)
    for at, weight in weights:
        z = np.zeros(count)
        z[k] = at * step
        run = run_with(z)
        if carom.contact_sequence(run) != carom.contact_sequence(reference):
            return None
        total = total + weight / step * outcome(run, reference)
    return total
