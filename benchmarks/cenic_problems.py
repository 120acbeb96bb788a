"""Problems of CENIC, Drake's integrator with error control through contact (arXiv 2511.08771), by two programs.

Each function of a problem takes an accuracy, and returns error, steps and processor time. Drake's contact is
compliant: its ground is as stiff as stated here, so a part of its error is that of another model.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

G, RADIUS = 9.81, 0.1
STATIC, KINETIC, RATE = (
    0.5,
    0.3,
    2.0,
)  # friction of a block; growth of the force that pushes it [N/s]
SPEED, SPRING = 0.2, 50.0  # of the end of the spring that draws it [m/s], [N/m]
PENDULUM = """<mujoco model="pendulum"><worldbody>
 <body name="upper"><joint type="hinge" name="shoulder" axis="0 1 0" pos="0 0 0.1"/>
  <geom type="capsule" size="0.01 0.1" contype="0" conaffinity="0"/>
  <body name="lower"><joint type="hinge" name="elbow" axis="0 1 0" pos="0 0 -0.1"/>
   <geom type="capsule" size="0.01 0.1" pos="0 0 -0.2" contype="0" conaffinity="0"/>
 </body></body></worldbody></mujoco>"""
START = np.array([np.pi / 4, np.pi / 2]), np.array([0.1, 0.2])


def places() -> np.ndarray:
    """Return the centres of 64 balls (64, 3), off a lattice by up to a millimetre, a centimetre apart."""
    at = np.indices((4, 4, 4)).reshape(3, -1).T
    off = np.random.default_rng(42).random((64, 3)) * 1e-3
    return 0.21 * at + off + (0.0, 0.0, 0.101)


def deepest(x: np.ndarray) -> float:
    """Return how deep a ball is in another one or in the floor [m]."""
    i, j = np.triu_indices(len(x), 1)
    between = 2 * RADIUS - np.linalg.norm(x[i] - x[j], axis=1)
    return float(max(between.max(), (RADIUS - x[:, 2]).max(), 0.0))


def pushed(t: float) -> float:
    """Return where a block of 1 kg is that is pushed by RATE t: it breaks away, and kinetic friction acts."""
    s = t - STATIC * G / RATE
    return (STATIC - KINETIC) * G * s * s / 2 + RATE * s**3 / 6


def drawn(t: float) -> float:
    """Return where a block of 1 kg is that a spring draws: it sticks and slips in turn."""
    w, x, now = np.sqrt(SPRING), 0.0, 0.0
    while True:
        now = (STATIC * G / SPRING + x) / SPEED
        if now >= t:
            return x
        u = (STATIC - KINETIC) * G / SPRING
        slip = 2 * (np.pi - np.arctan2(u * w, SPEED)) / w
        s = min(t - now, slip)
        x = SPEED * (now + s) - u * np.cos(w * s) - SPEED / w * np.sin(w * s) - KINETIC * G / SPRING
        if now + slip >= t:
            return x


def carom_problems() -> dict[str, Callable]:
    """Return the problems by carom."""
    import numba

    import carom
    from carom import forces

    @numba.njit
    def push(t, states):
        wrench = np.zeros((1, 6))
        wrench[0, 0] = RATE * t
        return wrench

    def timed(scene, duration, rtol, wrong):
        begin = time.process_time()
        run = carom.simulate(scene, duration, rtol=rtol, save_at=duration, throw=False)
        took = time.process_time() - begin
        return wrong(run), run.stats["trial_steps"], took

    def free(rtol):
        scene = carom.Scene(gravity=(0, 0, -G))
        scene.add_body(
            carom.Sphere(RADIUS), density=1000, velocity=(0.8, 0, 0), angular_velocity=(0, 8, 0)
        )
        return timed(scene, 1.0, rtol, lambda run: abs(run.position[-1, 0, 2] + G / 2))

    def pendulum(rtol):
        model = carom.load_model(PENDULUM, qpos=START[0], qvel=START[1])

        def wrong(run):
            q = [model.joints[name].of(run)[0][-1] for name in ("shoulder", "elbow")]
            off = np.array(q) - pendulum_end()
            return np.abs((off + np.pi) % (2 * np.pi) - np.pi).max()

        return timed(model.scene, 2.0, rtol, wrong)

    def block(velocity=0.0, belt=0.0):
        scene = carom.Scene(gravity=(0, 0, -G))
        box = scene.add_body(
            carom.Box(0.2, 0.2, 0.02), mass=1.0, position=(0, 0, 0.01), velocity=(velocity, 0, 0)
        )
        floor = scene.add_half_space((0, 0, 0), (0, 0, 1), surface_velocity=(belt, 0, 0))
        scene.add_contact(box, floor, friction=carom.Friction(STATIC, KINETIC), restitution=0)
        return scene, box

    def breaks_away(rtol):
        scene, box = block()
        scene.add_force(forces.UserForce(box, push))
        return timed(scene, 4.0, rtol, lambda run: abs(run.position[-1, 0, 0] - pushed(4.0)))

    def stick_slip(rtol):
        scene, box = block(-SPEED, -SPEED)  # the floor moves, the end of the spring is at rest
        scene.add_force(forces.Spring(SPRING, (10, 0, 0.01), (0, 0, 0.01), rest_length=10.0), box)
        place = drawn(5.0) - SPEED * 5.0
        return timed(scene, 5.0, rtol, lambda run: abs(run.position[-1, 0, 0] - place))

    def balls(rtol):
        scene = carom.Scene(gravity=(0, 0, -G))
        scene.add_half_space((0, 0, 0), (0, 0, 1))
        scene.set_contact_default(friction=STATIC, restitution=0)
        for x in places():
            scene.add_body(carom.Sphere(RADIUS), mass=1.0, position=x)
        return timed(scene, 1.0, rtol, lambda run: deepest(run.position[-1]))

    return {
        "free fall": free, "double pendulum": pendulum, "break-away": breaks_away,
        "stick-slip": stick_slip, "64 balls": balls,
    }  # fmt: skip


def pendulum_end() -> np.ndarray:
    """Return the angles of the double pendulum after 2 s."""
    from scipy.integrate import solve_ivp

    # two capsules of radius .01 and length .2, density 1000: mass, inertia about the centre across the axis
    r, L = 0.01, 0.2
    rod, ball = 1000 * np.pi * r * r * L, 1000 * 4 / 3 * np.pi * r**3
    m = rod + ball
    J = rod * (3 * r * r + L * L) / 12 + ball * (0.4 * r * r + L * L / 4 + 3 / 8 * L * r)
    # the shoulder is .1 above the first centre, the elbow .1 below it, the second centre .2 below the first's
    a, d = 0.1, 0.2  # shoulder to first centre; shoulder to elbow
    b = 0.1  # elbow to second centre

    def rates(t, y):
        p, q = y[0], y[0] + y[1]  # absolute angles
        c, s = m * d * b * np.cos(q - p), m * d * b * np.sin(q - p)
        M = [[J + m * a * a + m * d * d, c], [c, J + m * b * b]]
        wp, wq = y[2], y[2] + y[3]
        force = [
            s * wq**2 - G * (m * a + m * d) * np.sin(p),
            -s * wp**2 - G * m * b * np.sin(q),
        ]
        ap, aq = np.linalg.solve(M, force)
        return [y[2], y[3], ap, aq - ap]

    run = solve_ivp(rates, (0, 2), np.concatenate(START), method="DOP853", rtol=1e-13, atol=1e-14)
    return run.y[:2, -1]


def drake_problems() -> dict[str, Callable]:
    """Return the problems by Drake, with CENIC."""
    from pydrake.all import (
        AddContactMaterial,
        AddMultibodyPlantSceneGraph,
        CoulombFriction,
        DiagramBuilder,
        HalfSpace,
        LeafSystem,
        LinearSpringDamper,
        Parser,
        PrismaticJoint,
        ProximityProperties,
        ResetIntegratorFromFlags,
        RigidTransform,
        Simulator,
        SpatialInertia,
        Sphere,
    )

    ground, tiny = 1e5, 1e-6  # stiffness [N/m]; mass that carries the block along x [kg]

    def material(static, kinetic, properties):
        AddContactMaterial(
            dissipation=50.0,
            point_stiffness=2 * ground,
            friction=CoulombFriction(static, kinetic),
            properties=properties,
        )

    class Push(LeafSystem):
        def __init__(self):
            super().__init__()
            self.DeclareVectorOutputPort(
                "force", 2, lambda context, out: out.SetFromVector([RATE * context.get_time(), 0.0])
            )

    def timed(diagram, plant, start, duration, accuracy, wrong):
        simulator = Simulator(diagram)
        context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
        plant.SetPositions(context, start[0])
        plant.SetVelocities(context, start[1])
        ResetIntegratorFromFlags(simulator, "cenic", 0.1)
        simulator.get_mutable_integrator().set_target_accuracy(accuracy)
        simulator.Initialize()
        begin = time.process_time()
        simulator.AdvanceTo(duration)
        took = time.process_time() - begin
        steps = simulator.get_integrator().get_num_steps_taken()
        return wrong(plant.GetPositions(context)), steps, took

    def free(accuracy):
        builder = DiagramBuilder()
        plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
        plant.AddRigidBody("ball", SpatialInertia.SolidSphereWithMass(4.18879, RADIUS))
        plant.Finalize()
        start = [1, 0, 0, 0, 0, 0, 0], [0, 8.0, 0, 0.8, 0, 0]
        return timed(builder.Build(), plant, start, 1.0, accuracy, lambda q: abs(q[6] + G / 2))

    def pendulum(accuracy):
        builder = DiagramBuilder()
        plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
        Parser(plant).AddModelsFromString(PENDULUM, "xml")
        plant.Finalize()
        end = pendulum_end()
        return timed(builder.Build(), plant, START, 2.0, accuracy, lambda q: np.abs(q - end).max())

    def block(builder):
        plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
        along = slide(plant, "carrier", tiny, plant.world_body(), [1, 0, 0])
        carrier = plant.GetBodyByName("carrier")
        slide(plant, "block", 1.0 - tiny, carrier, [0, 0, 1])
        rough = ProximityProperties()
        material(STATIC, KINETIC, rough)
        for body, shape in (
            (plant.GetBodyByName("block"), Sphere(RADIUS)),
            (plant.world_body(), HalfSpace()),
        ):
            plant.RegisterCollisionGeometry(body, RigidTransform(), shape, body.name(), rough)
        return plant, along, carrier

    def slide(plant, name, mass, parent, axis):
        body = plant.AddRigidBody(name, SpatialInertia.SolidSphereWithMass(mass, RADIUS))
        return plant.AddJoint(
            PrismaticJoint(f"{name} joint", parent.body_frame(), body.body_frame(), axis)
        )

    height = RADIUS - (1.0 - tiny) * G / ground  # the ground is pressed in

    def breaks_away(accuracy):
        builder = DiagramBuilder()
        plant, _, _ = block(builder)
        plant.Finalize()
        force = builder.AddSystem(Push())
        builder.Connect(force.get_output_port(), plant.get_applied_generalized_force_input_port())
        start = [0, height], [0, 0]
        end = pushed(4.0)
        return timed(builder.Build(), plant, start, 4.0, accuracy, lambda q: abs(q[0] - end))

    def stick_slip(accuracy):
        builder = DiagramBuilder()
        plant, along, carrier = block(builder)
        hand = slide(plant, "hand", 1e9, plant.world_body(), [1, 0, 0])
        spring = LinearSpringDamper(
            carrier, [0, 0, 0], plant.GetBodyByName("hand"), [1.0, 0, 0], 1.0, SPRING, 0.0
        )
        plant.AddForceElement(spring)
        plant.Finalize()
        q, v = np.zeros(3), np.zeros(3)
        q[plant.GetJointByName("block joint").position_start()] = height
        v[hand.velocity_start()] = SPEED
        x, end = along.position_start(), drawn(5.0)
        return timed(builder.Build(), plant, (q, v), 5.0, accuracy, lambda q: abs(q[x] - end))

    def balls(accuracy):
        builder = DiagramBuilder()
        plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0)
        rough = ProximityProperties()
        material(STATIC, STATIC, rough)
        plant.RegisterCollisionGeometry(
            plant.world_body(), RigidTransform(), HalfSpace(), "floor", rough
        )
        q = []
        for k, x in enumerate(places()):
            ball = plant.AddRigidBody(f"ball{k}", SpatialInertia.SolidSphereWithMass(1.0, RADIUS))
            plant.RegisterCollisionGeometry(
                ball, RigidTransform(), Sphere(RADIUS), f"ball{k}", rough
            )
            q += [1, 0, 0, 0, *x]
        plant.Finalize()
        start = q, np.zeros(6 * 64)
        return timed(
            builder.Build(), plant, start, 1.0, accuracy, lambda q: deepest(q.reshape(64, 7)[:, 4:])
        )

    return {
        "free fall": free, "double pendulum": pendulum, "break-away": breaks_away,
        "stick-slip": stick_slip, "64 balls": balls,
    }  # fmt: skip
