"""Drake: contact is compliant, its Hunt-Crossley dissipation set for e at the first impact.

The stiffness grows as settings get finer: 100 / dt, or 1e3 over the root of the accuracy [N/m].

Three ways: discrete (usual for robots, settings are steps), CENIC and Runge-Kutta of order three (settings are
accuracies).
"""

import importlib.metadata
import time

import numpy as np
import problems as p
from pydrake.all import (
    AddContactMaterial,
    AddMultibodyPlantSceneGraph,
    BasicVector,
    ContactModel,
    CoulombFriction,
    DiagramBuilder,
    HalfSpace,
    LeafSystem,
    LinearSpringDamper,
    PrismaticJoint,
    ProximityProperties,
    ResetIntegratorFromFlags,
    RigidTransform,
    RotationMatrix,
    Simulator,
    SpatialInertia,
    Sphere,
    UnitInertia,
)


class Stars(LeafSystem):
    """The forces between stars, whose joints are x and y of each in turn."""

    def __init__(self):
        super().__init__()
        self.DeclareVectorInputPort("state", BasicVector(28))
        self.DeclareVectorOutputPort("force", 14, self._force)

    def _force(self, context, out):
        x = p.STARS + self.get_input_port(0).Eval(context)[:14].reshape(7, 2)
        out.SetFromVector(p.pull(x).ravel())


class Way:
    """One of the three ways."""

    def __init__(self, scheme=None):
        self.scheme = scheme

    def stiffness(self, setting):
        return 1e3 / np.sqrt(setting) if self.scheme else 100 / setting

    def plant(self, setting, gravity=p.G):
        builder = DiagramBuilder()
        plant, _ = AddMultibodyPlantSceneGraph(builder, 0.0 if self.scheme else setting)
        plant.set_contact_model(ContactModel.kPoint)
        plant.mutable_gravity_field().set_gravity_vector([0, 0, -gravity])
        return builder, plant

    def go(self, builder, plant, setting, duration, start):
        """Return the coordinates at the end, and processor time."""
        diagram = builder.Build()
        simulator = Simulator(diagram)
        context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
        plant.SetPositions(context, start[0])
        plant.SetVelocities(context, start[1])
        if self.scheme:
            ResetIntegratorFromFlags(simulator, self.scheme, 0.1)
            simulator.get_mutable_integrator().set_target_accuracy(setting)
        simulator.Initialize()
        begin = time.process_time()
        simulator.AdvanceTo(duration)
        return plant.GetPositions(context), time.process_time() - begin

    def rough(self, setting, mu, d):
        made = ProximityProperties()
        AddContactMaterial(
            dissipation=d,
            point_stiffness=2 * self.stiffness(setting),
            friction=CoulombFriction(mu, mu),
            properties=made,
        )
        return made

    def floor(self, plant, rough, ceiling=False):
        world = plant.world_body()
        plant.RegisterCollisionGeometry(world, RigidTransform(), HalfSpace(), "floor", rough)
        if ceiling:
            pose = RigidTransform(RotationMatrix(np.diag([1.0, -1, -1])), [0, 0, p.CEILING])
            plant.RegisterCollisionGeometry(world, pose, HalfSpace(), "ceiling", rough)

    def ball(self, plant, rough):
        body = plant.AddRigidBody("ball", SpatialInertia.SolidSphereWithMass(1.0, p.RADIUS))
        plant.RegisterCollisionGeometry(body, RigidTransform(), Sphere(p.RADIUS), "ball", rough)

    def roll(self, s):
        builder, plant = self.plant(s)
        rough = self.rough(s, p.MU, 50.0)
        self.floor(plant, rough)
        self.ball(plant, rough)
        plant.Finalize()
        start = [1, 0, 0, 0, 0, 0, p.RADIUS - p.G / self.stiffness(s)], [0, 0, 0, p.SPEED, 0, 0]
        q, took = self.go(builder, plant, s, p.ROLLS, start)
        return q[4], took

    def fall(self, s):
        builder, plant = self.plant(s)
        shape = UnitInertia(*p.inertia(p.HALF))
        plant.AddRigidBody("box", SpatialInertia(1.0, np.zeros(3), shape))
        plant.Finalize()
        start = [1, 0, 0, 0, 0, 0, 0], [*p.SPIN, 0, 0, 0]
        q, took = self.go(builder, plant, s, p.FALLS, start)
        return p.marked(q[4:], p.matrix(*q[:4])), took

    def strikes(self, s, z, speed, e, first, gravity, duration):
        builder, plant = self.plant(s, gravity)
        rough = self.rough(s, 0.0, p.hunt_crossley(e, first))
        self.floor(plant, rough, ceiling=gravity == 0)
        self.ball(plant, rough)
        plant.Finalize()
        start = [1, 0, 0, 0, 0, 0, z], [0, 0, 0, 0, 0, -speed]
        q, took = self.go(builder, plant, s, duration, start)
        return q[6], took

    def stops(self, s):
        return self.strikes(s, p.CEILING / 2, p.THROWN, p.KEEPS, p.THROWN, 0.0, p.STOPS)

    def bounce(self, s, e):
        first = np.sqrt(2 * p.G * p.DROP)
        return self.strikes(s, p.RADIUS + p.DROP, 0.0, e, first, p.G, p.BOUNCES[e])

    def slide(self, plant, name, mass, parent, axis):
        body = plant.AddRigidBody(name, SpatialInertia.SolidSphereWithMass(mass, p.RADIUS))
        frames = parent.body_frame(), body.body_frame()
        return body, plant.AddJoint(PrismaticJoint(name, *frames, axis))

    def stick_slip(self, s):
        """The block is a ball that cannot turn, on two slides."""
        builder, plant = self.plant(s)
        rough, tiny = self.rough(s, p.MU, 50.0), 1e-6
        self.floor(plant, rough)
        world = plant.world_body()
        carrier, along = self.slide(plant, "along", tiny, world, [1, 0, 0])
        block, up = self.slide(plant, "up", 1.0 - tiny, carrier, [0, 0, 1])
        plant.RegisterCollisionGeometry(block, RigidTransform(), Sphere(p.RADIUS), "block", rough)
        spring = LinearSpringDamper(carrier, [0, 0, 0], world, [-10, 0, 0], 10.0, p.SPRING, 0.0)
        plant.AddForceElement(spring)
        plant.Finalize()
        q = np.zeros(2)
        q[along.position_start()] = p.DRAWN
        q[up.position_start()] = p.RADIUS - p.G / self.stiffness(s)
        q, took = self.go(builder, plant, s, p.SLIDES, (q, np.zeros(2)))
        return q[along.position_start()], took

    def pleiades(self, s):
        builder, plant = self.plant(s, 0.0)
        for k in range(7):
            half, _ = self.slide(plant, f"x{k}", 1e-9, plant.world_body(), [1, 0, 0])
            self.slide(plant, f"y{k}", k + 1.0 - 1e-9, half, [0, 1, 0])
        plant.Finalize()
        stars = builder.AddSystem(Stars())
        builder.Connect(plant.get_state_output_port(), stars.get_input_port(0))
        builder.Connect(stars.get_output_port(0), plant.get_applied_generalized_force_input_port())
        q, took = self.go(builder, plant, s, p.YEARS, (np.zeros(14), p.FLY.ravel()))
        return p.STARS + q.reshape(7, 2), took


def variant(name, scheme, settings, without=()):
    """Return what one way solves."""
    way = Way(scheme)
    every = {
        "rolling": way.roll, "free fall": way.fall, "stops": way.stops, "stick-slip": way.stick_slip,
        "bounce e=0.5": lambda s: way.bounce(s, 0.5), "bounce e=1": lambda s: way.bounce(s, 1.0),
        "Pleiades": way.pleiades,
    }  # fmt: skip
    return p.Variant(name, scheme is not None, settings, every, {})


if __name__ == "__main__":
    tight = (1e-2, 1e-4, 1e-6, 1e-8)
    ways = [
        variant("discrete", None, (1e-2, 1e-3, 1e-4)),
        variant("CENIC", "cenic", tight),
        variant("RK3", "runge_kutta3", (*tight, 1e-10)),
    ]
    p.main(importlib.metadata.version("drake"), ways)
