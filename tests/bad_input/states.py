"""Calls that state something: shapes, scenes, joints, forces, constraints."""

import numpy as np

import carom
from bad_input.things import FACES, TETRAHEDRON, of_nothing, parts
from carom import constraints, forces, joints


def stated():
    """Return functions of (callable, arguments) by name."""

    def of_scene(method, /, **given):
        """A method of a scene; a text is the name of a part."""

        def make():
            p = parts()
            return getattr(p.scene, method), {
                k: getattr(p, v[1:]) if isinstance(v, str) and v[:1] == "@" else v
                for k, v in given.items()
            }

        return make

    def with_part(kind, /, **given):
        def make():
            p = parts()
            got = {
                k: getattr(p, v[1:]) if isinstance(v, str) and v[:1] == "@" else v
                for k, v in given.items()
            }
            return kind, got

        return make

    def joined(definition):
        p = parts()
        return p.scene.add_constraint, dict(definition=definition(p), name="mine", replace=True)

    def belted():
        p = parts()
        for k in range(2):
            wheel = p.scene.add_body(
                carom.Cylinder(0.1, 0.02), mass=1.0, position=(5 + k, 0, 0), name=f"w{k}"
            )
            p.scene.add_joint(joints.Revolute((5 + k, 0, 0), (0, 0, 1)), carom.GROUND, wheel)
        over = [carom.Pulley(name, 0.1, (0, 0, 1)) for name in ("w0", "w1")]
        return p.scene.add_belt, dict(
            over=over, tension=10.0, stiffness=1e4, damping=1.0, slack=0.0, restitution=0.0,
            impact_law="newton", name="new",
        )  # fmt: skip

    three = (1.0, 0.0, 0.0)
    number = dict(restitution=0.5, friction=0.1, friction_held=0.1, stiffness=1.0, rolling_friction=0.0,
                  pivoting_friction=0.0, tangential_restitution=0.5)  # fmt: skip
    words = dict(impact_law="newton", multiple="sequential")
    shapes = {
        "Sphere": (carom.Sphere, dict(radius=0.1)),
        "Box": (carom.Box, dict(lx=1.0, ly=2.0, lz=3.0, radius=0.1)),
        "Capsule": (carom.Capsule, dict(radius=0.1, length=1.0)),
        "Cylinder": (carom.Cylinder, dict(radius=0.1, length=1.0)),
        "Disc": (carom.Disc, dict(radius=0.1, inner_radius=0.05)),
        "Ellipsoid": (carom.Ellipsoid, dict(a=1.0, b=2.0, c=3.0)),
        "Convex": (carom.Convex, dict(points=TETRAHEDRON, radius=0.1)),
        "Mesh": (carom.Mesh, dict(vertices=TETRAHEDRON, faces=FACES, parts=[TETRAHEDRON])),
        "Profile": (
            carom.Profile,
            dict(outline=[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], thickness=0.1, corners=[0, 1, 2, 3]),
        ),
        "Compound": (
            carom.Compound,
            dict(parts=[(carom.Sphere(0.1), three), (carom.Sphere(0.1), (-1.0, 0, 0))], masses=[1.0, 2.0],
                 centroid=None),
        ),
        "Part": (
            carom.Part,
            dict(shape=carom.Sphere(0.1), position=three, orientation=(1, 0, 0, 0), material=None),
        ),
        "Look": (
            carom.Look,
            dict(shape=carom.Sphere(0.1), position=three, orientation=(1, 0, 0, 0), color=None),
        ),
    }  # fmt: skip
    found = {}
    for name, (kind, given) in shapes.items():
        found[name] = lambda kind=kind, given=given: (kind, given)
        if name in ("Part", "Look"):
            continue
        found[f"{name}.inertia"] = lambda kind=kind, given=given: (
            kind(**given).inertia,
            dict(mass=1.0),
        )
        found[f"{name}.support"] = lambda kind=kind, given=given: (
            kind(**given).support, dict(direction=three),
        )  # fmt: skip
    found |= {
        "euler": lambda: (carom.euler, dict(axes="zyx", angles=(90.0, 0.0, 30.0))),
        "axis_angle": lambda: (carom.axis_angle, dict(axis=three, angle=90.0)),
        "Material": lambda: (carom.Material, dict(**number, young=1e9, poisson=0.3)),
        "Stiffness": lambda: (carom.Stiffness, dict(k=1e6, exponent=1.5)),
        "Hertz": lambda: (carom.Hertz, dict(young=1e9, poisson=0.3, radius=0.1)),
        "Friction": lambda: (
            carom.Friction, dict(
                static=0.5, kinetic=0.3, speed=0.1, exponent=1.0, axis=None, along=None, across=None, of="body"
            ),
        ),
        "Friction anisotropic": lambda: (
            carom.Friction, dict(
                axis=three, along=0.1, across=0.5, of="world", static=None, kinetic=None, speed=None,
                exponent=1.0,
            ),
        ),
        "Friction.fit": lambda: (
            carom.Friction.fit, dict(function=lambda v: 0.5, speeds=(0.1, 1.0), accuracy=1e-8),
        ),
        "Restitution.fit": lambda: (
            carom.Restitution.fit, dict(function=lambda v: 0.5, speeds=(0.1, 1.0), accuracy=1e-8),
        ),
        "Friction.table": lambda: (carom.Friction.table, dict(speeds=(0.1, 1.0), values=(0.9, 0.5))),
        "Profile.involute": lambda: (
            carom.Profile.involute,
            dict(teeth=20, module=0.002, thickness=0.01, pressure_angle=0.35, backlash=1e-4, shift=0.1,
                 addendum=1.0, dedendum=1.25),
        ),
        "Profile.points": lambda: (
            carom.Profile([(0, 0), (1, 0), (0, 1)], 0.1, "all").points, dict(count=12),
        ),
        "Friction.slope": lambda: (carom.Friction(0.5, 0.3, 0.1).slope, dict(speed=1.0)),
        "Restitution": lambda: (carom.Restitution.power(0.5), dict(speed=1.0)),
        "Restitution.power": lambda: (
            carom.Restitution.power, dict(value=0.5, speed=1.0, exponent=-0.25, maximum=0.9),
        ),
        "Restitution.viscoelastic": lambda: (carom.Restitution.viscoelastic, dict(c=0.2)),
        "Restitution.table": lambda: (
            carom.Restitution.table, dict(speeds=(0.1, 1.0), values=(0.9, 0.5)),
        ),
        "Restitution.slope": lambda: (carom.Restitution.power(0.5).slope, dict(speed=1.0)),
        "ContactLaw": lambda: (
            carom.scene.ContactLaw, {**number, **words, "adhesion": 0.5, "of_materials": ("friction",)}
        ),
        "Options": lambda: (
            carom.Options, carom.Options(layer_width=1e-6, max_step=0.1, corner_exponent=1.5).as_dict()
        ),
        "Scene": lambda: (carom.Scene, dict(gravity=(0, 0, -9.81))),
        "Scene.add_half_space": of_scene(
            "add_half_space", point=(0, 0, 0), normal=(0, 0, 1), material=carom.Material(0.5, 0.1), name="wall",
            color="red", surface_velocity=(1.0, 0, 0), surface_spin=((0, 0, 1.0), 2.0, three), replace=True,
        ),
        "Scene.add_body": of_scene(
            "add_body", shape=carom.Sphere(0.1), mass=1.0, density=None, inertia=(1.0, 1.0, 1.0),
            position=three, orientation=(1.0, 0, 0, 0), velocity=three, angular_velocity=three,
            material=carom.Material(0.5, 0.1), name="new", color="red", look=carom.Sphere(0.2), modes=None,
            replace=True,
        ),
        "Scene.add_body of a density": of_scene(
            "add_body", shape=carom.Sphere(0.1), mass=None, density=1.0, inertia=None,
            position=three, orientation=(1.0, 0, 0, 0), velocity=three, angular_velocity=three,
            material=None, name="new", color=None, look=None, modes=None, replace=False,
        ),
        "Scene.add_static": of_scene(
            "add_static", shape=carom.Sphere(0.1), position=three, orientation=(1.0, 0, 0, 0),
            material=carom.Material(0.5, 0.1), name="new", color="red", surface_velocity=(1.0, 0, 0),
            surface_spin=((0, 0, 1.0), 2.0, three), modes=None, replace=True,
        ),
        "Scene.add_surface": of_scene(
            "add_surface", definition=carom.surfaces.InsideSphere(9.0), position=three,
            orientation=(1.0, 0, 0, 0), material=carom.Material(0.5, 0.1), name="new", color="red",
            surface_velocity=(1.0, 0, 0), surface_spin=((0, 0, 1.0), 2.0, three), replace=True,
        ),
        "surfaces.InsideSphere": lambda: (carom.surfaces.InsideSphere, dict(radius=1.0)),
        "surfaces.InsideCylinder": lambda: (carom.surfaces.InsideCylinder, dict(radius=1.0, length=2.0)),
        "surfaces.InsideCone": lambda: (carom.surfaces.InsideCone, dict(half_angle=0.5)),
        "surfaces.InsideTorus": lambda: (carom.surfaces.InsideTorus, dict(radius=2.0, tube_radius=1.0)),
        "Scene.add_joint": of_scene(
            "add_joint", definition=joints.Spherical((0, 0, 0)), parent="@ball", child="@box",
            parent_frame=(three, (1.0, 0, 0, 0)), child_frame=(three, (1.0, 0, 0, 0)), breaks_at=5.0,
            name="new", replace=True,
        ),
        "Scene.add_force": of_scene(
            "add_force", definition=forces.Torque(three), parent="@ball", child="@box", name="new",
            replace=True,
        ),
        "Scene.add_constraint": lambda: joined(lambda p: constraints.Gear(p.hinge, p.slide, 2.0)),
        "Scene.add_stop": of_scene(
            "add_stop", joint="@hinge", lower=-1.0, upper=None, restitution=0.5, impact_law="newton",
            stiffness=carom.Stiffness(1e3), coordinate=0, name="new", replace=True,
        ),
        "Scene.add_play": of_scene(
            "add_play", joint="@hinge", lower=-1.0, upper=1.0, restitution=0.5, friction=0.1,
            impact_law="newton", coordinate=0, name="new",
        ),
        "Scene.switch": of_scene("switch", part="@hinge", at=0.5, off=True, name="new"),
        "Scene.add_belt": belted,
        "Scene.add_rope": of_scene(
            "add_rope", over=["ball", "box"], length=100.0, stiffness=None, damping=0.0, restitution=0.5,
            impact_law="newton", name="new",
        ),
        "Scene.add_contact": of_scene(
            "add_contact", body="@box", other="@floor", **number, **words, adhesion=0.5, name="new",
            replace=True,
        ),
        "Scene.set_contact_default": of_scene(
            "set_contact_default", **number, **words, combine="average", all_pairs=True
        ),
        "Scene.ignore_contact": of_scene("ignore_contact", body="@ball", other="@box"),
        "Scene.contact_law": of_scene("contact_law", body="@ball", other="@box"),
        "Scene.pairs_by_default": of_scene("pairs_by_default"),
        "Scene.copy": of_scene("copy"),
        "Scene.replace": of_scene("replace", part="ball", mass=1.0, color="red", position=three),
        "Scene.remove": of_scene("remove", part="ball", dependents=True),
        "Scene.validate": of_scene("validate"),
        "Scene.check": of_scene("check"),
    }  # fmt: skip

    placed = dict(anchor=three, axis=(0, 0, 1.0))
    found |= {
        "joints.Revolute": lambda: (joints.Revolute, placed),
        "joints.Spherical": lambda: (
            joints.Spherical, dict(anchor=three, axis=three, start=(1.0, 0.0, 0.0, 0.0))
        ),
        "joints.Fixed": lambda: (joints.Fixed, dict(anchor=three)),
        "joints.Prismatic": lambda: (joints.Prismatic, placed),
        "joints.Cylindrical": lambda: (joints.Cylindrical, placed),
        "joints.Screw": lambda: (joints.Screw, dict(**placed, pitch=0.1)),
        "joints.Universal": lambda: (
            joints.Universal, dict(anchor=three, axis_parent=three, axis_child=(0, 1.0, 0)),
        ),
        "joints.Planar": lambda: (joints.Planar, dict(normal=(0, 0, 1.0), anchor=three)),
        "joints.PointOnLine": lambda: (joints.PointOnLine, dict(anchor=three, direction=three)),
        "joints.PointOnPlane": lambda: (joints.PointOnPlane, dict(anchor=three, normal=three)),
        "joints.PointOnCurve": lambda: (
            joints.PointOnCurve,
            dict(
                curve=carom.curves.Spline([three, (0, 0, 0.0)]), anchor=three, side=three, restitution=0.5,
                friction=0.2, impact_law="newton",
            ),
        ),
        "joints.CurveOnPoint": lambda: (
            joints.CurveOnPoint, dict(curve=carom.curves.Spline([three, (0, 0, 0.0)]), anchor=three),
        ),
        "curves.Spline": lambda: (
            carom.curves.Spline, dict(points=[three, (0, 0, 0.0), (0, 1.0, 0)], closed=True),
        ),
        "curves.Curve": lambda: (
            carom.curves.Curve, dict(function=lambda u: (u, 0, 0), start=0.0, end=1.0, closed=False),
        ),
        "curves.Curve.point": lambda: (carom.curves.Spline([three, (0, 0, 0.0)]).point, dict(s=0.1)),
        "curves.Curve.tangent": lambda: (carom.curves.Spline([three, (0, 0, 0.0)]).tangent, dict(s=0.1)),
        "curves.Curve.nearest": lambda: (carom.curves.Spline([three, (0, 0, 0.0)]).nearest, dict(point=three)),
        "surfaces.HeightField": lambda: (
            carom.surfaces.HeightField, dict(heights=np.eye(4), spacing=(1.0, 2.0), corner=(0.0, 1.0)),
        ),
        "surfaces.HeightField.height": lambda: (
            carom.surfaces.HeightField(np.eye(4), 1.0).height, dict(x=0.1, y=0.2),
        ),
        "surfaces.Surface": lambda: (
            carom.surfaces.Surface,
            dict(function=lambda x, y, z: z - 0.1 * x * x, bounds=[(-1.0, -1, -1), (1, 1, 1)],
                 gradient=lambda x, y, z: (-0.2 * x, 0.0, 1.0),
                 hessian=lambda x, y, z: np.diag([-0.2, 0.0, 0.0])),
        ),
        "joints.Distance": lambda: (
            joints.Distance,
            dict(anchor_parent=three, anchor_child=(0, 0, 0.0), lower=0.5, upper=2.0, restitution=0.5,
                 impact_law="poisson"),
        ),
        "joints.Clearance": lambda: (
            joints.Clearance,
            dict(anchor=three, axis=(0, 1, 0.0), radial=1e-3, axial=1e-3, length=0.1, radius=0.01, friction=0.1,
                 restitution=0.5, impact_law="poisson"),
        ),
        "joints.Belt": lambda: (
            joints.Belt,
            dict(radius_parent=0.1, radius_child=0.2, crossed=False, tension=0.0, stiffness=None, damping=0.0,
                 one_sided=True, slack=0.1, plane=three, restitution=0.5, impact_law="newton"),
        ),
        "joints.Tether": lambda: (
            joints.Tether,
            dict(length=1.0, anchor_parent=three, anchor_child=three, restitution=0.5, impact_law="newton"),
        ),
        "Pulley": lambda: (
            carom.Pulley, dict(wheel="wheel", radius=1.0, axis=three, friction=0.0, center=three, turns=0),
        ),
        "joints.KnifeEdge": lambda: (
            joints.KnifeEdge, dict(anchor=three, direction=three, normal=(0, 0, 1.0)),
        ),
        "joints.RollingSphere": lambda: (joints.RollingSphere, dict(radius=1.0, normal=(0, 0, 1.0))),
        "joints.RollingSphere.contact": lambda: (joints.RollingSphere(1.0).contact, dict(centre=three)),
        "joints.RollingDisc": lambda: (
            joints.RollingDisc, dict(radius=1.0, axis=three, normal=(0, 0, 1.0)),
        ),
        "joints.RollingDisc.contact": lambda: (
            joints.RollingDisc(1.0, three).contact, dict(centre=three),
        ),
        "forces.Spring": lambda: (
            forces.Spring,
            dict(stiffness=1.0, anchor_parent=three, anchor_child=(0, 0, 0.0), rest_length=1.0, damping=1.0),
        ),
        "forces.Force": lambda: (forces.Force, dict(vector=three, anchor=three, follow=True)),
        "forces.Torque": lambda: (forces.Torque, dict(vector=three, follow=True)),
        "forces.Bushing": lambda: (
            forces.Bushing,
            dict(stiffness=1.0, turn_stiffness=1.0, damping=(1.0, 2.0), turn_damping=(1.0, 2.0), axis=three,
                 anchor=three),
        ),
        "forces.CurveSpring": lambda: (
            forces.CurveSpring,
            dict(anchor_parent=three, anchor_child=(0, 0, 0.0), tension=[[0.0, 1.0], [0.0, 2.0]], damping=1.0),
        ),
        "forces.JointSpring": with_part(
            forces.JointSpring, joint="@hinge", stiffness=1.0, damping=1.0, rest=0.1, coordinate=0
        ),
        "forces.JointForce": with_part(forces.JointForce, joint="@hinge", force=1.0, coordinate=0),
        "forces.Actuator": with_part(
            forces.Actuator, joint="@hinge", gain=2.0, bias=(0.1, -1.0, -0.1), gear=3.0, control=0.2,
            control_range=(-1.0, 1.0), force_range=(-5.0, 5.0), coordinate=0,
        ),
        "forces.PositionServo": with_part(
            forces.PositionServo, joint="@hinge", kp=2.0, kd=0.1, limit=3.0, target=0.2, no_load=5.0,
            coordinate=0,
        ),
        "forces.VelocityServo": with_part(
            forces.VelocityServo, joint="@hinge", kv=2.0, limit=3.0, target=0.2, no_load=5.0, coordinate=0,
        ),
        "forces.JointFriction": with_part(
            forces.JointFriction, joint="@hinge", bound=1.0, coordinate=0, mu=None, radius=None, length=None
        ),
        "forces.JointFriction by load": with_part(
            forces.JointFriction, joint="@hinge", bound=None, coordinate=0, mu=0.2, radius=0.1, length=0.3
        ),
        "forces.Drive": with_part(
            forces.Drive, joint="@hinge", bound=1.0, coordinate=0, rate=1.0, motion=None
        ),
        "forces.Drive of a motion": with_part(
            forces.Drive, joint="@hinge", bound=1.0, coordinate=0, rate=None, motion=of_nothing
        ),
        "forces.BeltStrand": with_part(
            forces.BeltStrand, joint="@hinge", tension=1.0, stiffness=10.0, damping=0.1, coordinate=0
        ),
        "forces.JointInertia": with_part(forces.JointInertia, joint="@hinge", inertia=1.0, coordinate=0),
        "forces.UserForce": lambda: (
            forces.UserForce, dict(bodies=[parts().ball], function=of_nothing, potential=of_nothing),
        ),
        "forces.Drag": lambda: (forces.Drag, dict(density=1.2, coefficient=0.5, area=0.1)),
        "forces.Wind": lambda: (
            forces.Wind, dict(velocity=three, density=1.2, coefficient=0.5, area=0.1),
        ),
        "forces.Magnus": lambda: (
            forces.Magnus, dict(density=1.2, coefficient=1.0, radius=0.1, velocity=three),
        ),
        "forces.Buoyancy": lambda: (forces.Buoyancy, dict(density=1.2, surface=0.1, volume=0.1)),
        "constraints.Coupling": lambda: (constraints.Coupling, dict(factors={parts().hinge: 1.0})),
        "constraints.Gear": with_part(constraints.Gear, first="@hinge", second="@slide", ratio=2.0),
        "constraints.Driver": with_part(
            constraints.Driver, joint="@hinge", rate=1.0, motion=None, coordinate=0, limit=2.0
        ),
        "constraints.Driver of a motion": with_part(
            constraints.Driver, joint="@hinge", rate=None, motion=of_nothing, coordinate=0, limit=None
        ),
        "constraints.Rows": lambda: (
            constraints.Rows, dict(bodies=[parts().ball], function=of_nothing, rows=1, position=of_nothing),
        ),
    }  # fmt: skip
    return found
