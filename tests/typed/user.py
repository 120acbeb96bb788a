"""A script as users write it, over the public surface: a type checker finds no error in it."""

from pathlib import Path

import numpy as np

import carom

scene = carom.Scene(gravity=(0, 0, -9.81))
steel = carom.Material(restitution=0.5, friction=lambda speed: 0.3 + 0.1 / (1.0 + speed))
floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), material=steel, name="floor")
die = scene.add_body(
    carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.3), orientation=carom.euler("xyz", (10, 20, 0)),
    angular_velocity=[0, 10, 0], material=steel, color="tab:red", name="die",
)  # fmt: skip
arm = scene.add_body(carom.Capsule(0.01, 0.3), mass=0.2, position=np.array([1.0, 0, 1]), name="arm")
scene.add_static(carom.Sphere(0.1), position=(2, 0, 0))
hinge = scene.add_joint(
    carom.joints.Revolute((1, 0, 1), (0, 1, 0)), carom.GROUND, arm, name="hinge"
)
scene.add_stop(hinge, upper=1.0, restitution=0.3)
motor = scene.add_force(carom.forces.JointForce(hinge, force=0.1), name="motor")
drag = scene.add_force(carom.forces.Spring(10.0, damping=0.1), carom.GROUND, arm)
contact = scene.add_contact(die, floor, restitution=0.5, friction=0.2, impact_law="newton")
scene.set_contact_default(restitution=0.5, friction=0.3)
print(scene.check(), scene["die"].name, len(scene.bodies), contact.friction, die.inertia.trace())

solution = carom.simulate(scene, duration=0.6, step=1e-3, options=carom.Options(), throw=False)
height: np.ndarray = solution["die"].position[:, 2]
by_name = solution.body("die")
spin: np.ndarray = by_name.angular_velocity
angle: np.ndarray = solution.joint("hinge").coordinate
load: np.ndarray = solution.contact("die-floor").force
power: np.ndarray = solution[motor].power
torque: np.ndarray = solution[hinge].torque
first = solution.impacts[0]
print(
    solution[die].velocity.max(), first.time, solution.impacts.impulse.shape, solution.status.name
)
print(
    solution.force("motor").power, solution.ledger.residual.max(), solution.t[-1], solution.success
)
place, turn, velocity, spins = solution.evaluate(0.3)
solution.save(Path("run.nc"))
again = carom.Solution.load("run.nc")
carom.view(again, export="run.html")
axes = solution.plot("energy")
frame = solution.to_pandas()

runs = carom.ensemble(
    scene, 0.5, step=1e-3, vary={"die.position": np.zeros((5, 3)), "die-floor.friction": [0.1] * 5}
)
print(runs.outcomes.dtype.names, len(runs), runs.solution(0).t[-1])

run = carom.Run(scene)
run.advance(0.01)
run.set_force(motor, 0.2)
state = run.state
position: np.ndarray = state[die].position
print(position, state.t, state["die"].velocity, state.body("die").energy, state.joint(hinge).rate)

struck = carom.resolve_impact(np.eye(3), (-1.0, 0.5, 0.0), 0.2, 0.5, law="stronge")
print(struck.velocity_after, struck.energy_change, carom.Restitution.power(0.6)(1.0))
ball = carom.Compound([carom.Part(carom.Sphere(0.1), (0, 0, 0.2)), (carom.Box(1, 1, 1), (0, 0, 0))])
print(ball.volume, carom.Friction(static=0.4, kinetic=0.3).bound)
