"""Names from formulas and from other libraries, with those that carom has: the hints of its messages.

Names are compared without capitals and underscores. What stands for them is a name of carom, or a sentence.
"""

from __future__ import annotations

from difflib import get_close_matches

ALIKE = 0.7  # of two names, from 0 to 1, where one may be a slip for the other

#: arguments and attributes, with other names of them
VALUES = {
    "friction": "mu mu_s mus friction_coefficient coefficient_of_friction lateralFriction",
    "friction_held": "mu_held",
    "restitution": "e eps cor bounce bounciness elasticity restitution_coefficient",
    "rolling_friction": "mu_r rollingFriction",
    "pivoting_friction": "spinningFriction torsional_friction",
    "adhesion": "adhesive_force cohesion stickiness suction",
    "impact_law": "law model",
    "stiffness": "k ke spring_constant",
    "damping": "c d kd damping_coefficient viscosity",
    "rest_length": "l0 length0 natural_length",
    "mass": "m weight",
    "density": "rho",
    "inertia": "I J moi moment inertia_tensor",
    "position": "pos x xyz origin location translation p",
    "orientation": "quat q quaternion rotation rot rpy attitude R pose",
    "velocity": "vel v linear_velocity v0 lin_vel",
    "angular_velocity": "omega w angvel ang_vel angular",
    "shape": "geom geometry size box",
    "color": "colour rgba rgb c facecolor",
    "gravity": "g",
    "point": "anchor origin position offset",
    "anchor": "pivot pos point position origin",
    "normal": "n axis up direction",
    "name": "label id",
    "t": "time times",
    "time": "t",
    "total_energy": "energy",
    "energy": "total_energy",
    "coordinate": "angle displacement q",
    "rate": "angular_rate qdot",
    "scale": "unit units",
    "torque": "moment",
    "duration": "T time t tf t_end t_max t_final end tspan t_span",
    "step": "dt h timestep time_step step_size stepsize max_step",
    "save_at": "t_eval saveat output_times",
    "save_every": "stride every decimation",
    "method": "integrator solver scheme",
    "rtol": "reltol tol tolerance",
    "atol": "abstol",
    "events": "event",
    "progress": "verbose progress_bar",
    "save": "path filename file output",
    "lower": "low minimum min",
    "upper": "high maximum max",
    "parent": "body1 body_a bodyA base",
    "child": "body2 body_b bodyB body",
    "other": "other_body ground plane",
    "definition": "joint force constraint",
    "law": "impact_law model",
    "inverse_mass": "W delassus",
    "radius": "r R",
    "length": "height h L",
    "runs": "n size samples n_samples n_runs num_runs count repeats",
    "workers": "n_jobs jobs n_workers num_workers max_workers processes n_processes threads cores",
    "executor": "backend pool parallel",
    "seed": "random_state rng",
    "vary": "params parameters inputs variables",
    "impacts": "collisions hits",
    "bodies": "links rigid_bodies",
    "to_pandas": "to_dataframe to_df df dataframe",
    "to_xarray": "to_dataset",
    "path": "filename file fname where",
    "evaluate": "sol interpolate interp at",
    "replace": "set update modify change edit set_body",
    "remove": "delete pop discard drop remove_body",
    "copy": "clone duplicate deepcopy",
    "advance": "step run integrate step_simulation",
    "set_force": "apply_force set_control",
}
#: arguments and attributes that are stated in another place
PLACES = {
    "state it for a contact, add_contact(..., friction=) or set_contact_default(friction=), or in a Material":
        "friction mu",
    "state it for a contact, add_contact(..., restitution=) or set_contact_default(restitution=), or in a "
    "Material": "restitution",
    "it is an argument of carom.simulate": "rtol atol",
    "a body that never moves is made by add_static": "fixed static is_static kinematic",
}  # fmt: skip
_JOINTS = (
    "Revolute Prismatic Spherical Cylindrical Universal Planar Fixed Distance PointOnLine PointOnPlane Screw "
    "PointOnCurve add_joint"
)
#: arguments that functions and classes do not have, with what stands for them: by their names
ARGUMENTS = {
    _JOINTS: {
        "limits of a joint are stops: scene.add_stop(joint, lower=, upper=, restitution=)":
            "limits limit range lower upper stop stops",
        "friction of a joint is a force: scene.add_force(carom.forces.JointFriction(joint, ...))":
            "friction mu friction_torque frictionloss dry_friction",
        "a spring or a damper of a joint is a force: "
        "scene.add_force(carom.forces.JointSpring(joint, stiffness=, damping=))":
            "damping stiffness spring spring_constant damping_coefficient viscous_friction compliance",
        "a joint breaks by add_joint(..., breaks_at=), and is released by scene.switch(joint, at=)":
            "break_force break_torque breaking_force breakable max_force release detach",
        "a joint with clearance is carom.joints.Clearance(anchor, axis, radial=)": "clearance gap tolerance",
        "play between joints is scene.add_play({joint: factor, ...}, lower, upper, restitution=)":
            "backlash play",
        "a motor is scene.add_constraint(carom.constraints.Driver(joint, rate=)) or "
        "scene.add_force(carom.forces.JointForce(joint, torque))": "motor torque force speed rate drive "
        "velocity",
        "the inertia of a motor is scene.add_force(carom.forces.JointInertia(joint, inertia))":
            "armature rotor_inertia",
    },
    "add_stop": {"they are two arguments: lower= and upper=": "limits limit range bounds"},
    "film still animate": {
        "width and height in pixels are size=(1280, 720)": "resolution width height dpi figsize pixels",
        'the place of the camera is view="oblique", "front", ... and zoom=; follow= keeps a body in the middle':
            "camera eye elev azim azimuth elevation angle",
        "the length of the film is the run from start= to end= at speed=": "duration frames slow_motion "
        "playback",
    },
    "simulate ensemble Run": {
        "limits of a run are in options=carom.Options(...); limits of a joint are stops, "
        "scene.add_stop(joint, lower=, upper=)": "limits limit",
        "it is options=carom.Options(max_step=...)": "max_step maxstep hmax dt_max",
        "gravity is that of the scene: scene.gravity = (0, 0, -9.81)": "gravity",
        "steps are chosen by the tolerances rtol= and atol=, or given by step=": "substeps n_substeps "
        "iterations",
    },
    "add_contact set_contact_default Material": {
        "contacts are rigid: what damps an impact is restitution=": "damping c kd solref solimp dissipation",
        "contacts are rigid; stiffness= shares an impact between several contacts": "compliance young "
        "modulus E",
    },
}  # fmt: skip
_JOINT = "it is made by add_joint(carom.joints.{}(...), parent, child)"
_SHAPED = "a body with a shape is made by add_body(carom.{}(...), mass=...)"
_VIEWED = (
    "a motion is looked at by carom.view(solution), solution.plot() and carom.film(solution, path)"
)
_ELSEWHERE = "it is carom.{0}.{1}"
_OF_SCENE = {
    "a motor is made by add_constraint(carom.constraints.Driver(...)), which prescribes the motion of a joint, "
    "or by add_force(carom.forces.JointForce(...)), which applies a force": "add_motor",
    "a motor with a control is made by add_force(carom.forces.Actuator(...)); in a carom.Run, run.ctrl sets it":
        "add_actuator add_servo",
    "a spring is made by add_force(carom.forces.Spring(...))": "add_spring",
    "a damper is a spring without stiffness: add_force(carom.forces.Spring(stiffness=0, damping=...))":
        "add_damper add_dashpot",
    "a torque is made by add_force(carom.forces.Torque(...))": "add_torque",
    "a gear is made by add_constraint(carom.constraints.Gear(...))": "add_gear",
    "a limit of a joint is made by add_stop": "add_limit add_joint_limit",
    "a floor is made by add_half_space": "add_floor add_ground add_plane add_ground_plane",
    "a wall is made by add_half_space, where it has no end, or by add_static": "add_wall",
    "a body that never moves is made by add_static": "add_fixed add_obstacle add_static_body",
    "curved ground is made by add_surface(carom.surfaces...)": "add_bowl add_pipe add_terrain add_heightfield",
    _SHAPED.format("Box"): "add_box add_cube",
    _SHAPED.format("Sphere"): "add_sphere add_ball add_particle add_point_mass",
    _SHAPED.format("Cylinder"): "add_cylinder",
    _SHAPED.format("Capsule"): "add_capsule",
    "a mesh is a shape: add_body(carom.Mesh.load(path), mass=...)": "add_mesh load_mesh",
    "bodies are made by add_body": "add add_rigid_body add_link create_body create_multi_body",
    _JOINT.format("Revolute"): "add_hinge add_revolute add_revolute_joint add_pin add_pivot",
    _JOINT.format("Prismatic"): "add_slider add_slide add_prismatic",
    _JOINT.format("Spherical"): "add_ball_joint add_spherical add_socket",
    _JOINT.format("Fixed"): "add_weld add_fixed_joint",
    _JOINT.format("Distance"): "add_rod add_distance",
    "a cord that goes slack is add_joint(carom.joints.Tether(...)), an elastic one "
    "add_force(carom.forces.CurveSpring(...)), a rod add_joint(carom.joints.Distance(...))":
        "add_cable add_string add_tether add_chain",
    "a conveyor is a fixed part whose surface moves: add_half_space(..., surface_velocity=), or add_static":
        "add_conveyor add_conveyor_belt add_treadmill",
    "a joint that is switched on is stated by add_joint and switch(joint, at=, off=False); "
    "in a loop of your own by carom.Run.switch": "attach grasp",
    "switch(joint, at=) takes a joint out of the motion": "detach release break_joint add_switch disable",
    "a turntable is a fixed part whose surface turns: add_half_space(..., surface_spin=), or add_static":
        "add_turntable",
    "stairs are made of static boxes by add_static": "add_stairs add_steps",
    "a rope over wheels is add_rope, with carom.Pulley; a belt of two is add_joint(carom.joints.Belt(...))":
        "add_pulley add_tendon add_belt_drive",
    "a belt over several wheels is add_belt, with carom.Pulley": "add_serpentine add_chain_drive add_tensioner",
    "a bushing is add_force(carom.forces.Bushing(...))": "add_bushing add_mount",
    "gravity is an attribute: scene.gravity = (0, 0, -9.81)": "set_gravity",
    "it is stated by set_contact_default, or for one pair by add_contact":
        "set_friction set_restitution set_material collisions add_collision contact_material",
    "a scene is simulated by carom.simulate(scene, duration), a carom.Run by advance()":
        "simulate run step solve integrate step_simulation",
    "a part is scene[name]": "get get_body body find part",
    "sensors are readings of the solution: solution.evaluate(t), solution[name]": "add_sensor",
    "model files are read by carom.load_model(path)": "load from_mjcf from_urdf load_mjcf load_urdf",
    "a file has a solution with its scene: carom.simulate(scene, duration).save(path)": "save to_file",
    _VIEWED: "show plot draw render animate view",
}  # fmt: skip
_OF_SOLUTION = {
    'tables are written by save("run.csv"), or made by to_pandas()': "to_csv to_parquet to_excel",
    'it is written by save("run.nc"), and read by carom.Solution.load("run.nc")':
        "to_netcdf to_hdf5 to_file dump write export_data",
    "a film is made by carom.film(solution, path)": "film animate video to_mp4 to_gif render movie",
    "it is shown by carom.view(solution)": "show view display",
    "forces of contacts are forces and contact_force, those of joints joint_reactions": "reactions lambda_",
    "coordinates of a joint are joint_coordinates(name)": "qpos qvel joint_angles angle angles joints",
    "controls of a model are solution.scene.robot.ctrl(solution)": "ctrl control controls",
    "a sensor of a model is read by its name: solution[name]": "sensors sensor sensordata",
    "bodies are those of its scene: solution.scene.bodies, solution[name]": "bodies",
}  # fmt: skip
_OF_ENSEMBLE = {
    'tables are written by save("runs.csv"), or made by to_pandas()': "to_csv to_excel",
    "one run is made again by solution(number)": "runs solutions results trajectories",
}
_OF_BODY = {
    "forces and impacts are those of contacts, joints and springs, by their names: "
    'solution["die-ground"].force': "force forces torque impacts contacts contact_force",
    "it is numpy.linalg.norm(velocity, axis=-1)": "speed",
    "momentum is mass times velocity: scene[name].mass * velocity": "momentum",
    'angles are made by SciPy: Rotation.from_quat(orientation[..., [1, 2, 3, 0]]).as_euler("xyz")':
        "euler euler_angles rpy angles",
}  # fmt: skip
#: names of classes and modules, with what people call them
MEMBERS = {
    "Scene": _OF_SCENE,
    "Run": {
        "a scene is simulated by carom.simulate(scene, duration), a carom.Run by advance()": "simulate",
        "coordinates of a model are model.qpos(run.state), model.qvel(run.state)": "qpos qvel data",
    },
    "SystemState": {"coordinates of a model are model.qpos(state), model.qvel(state)": "qpos qvel"},
    "Solution": _OF_SOLUTION,
    "Ensemble": _OF_ENSEMBLE,
    "BodyState": _OF_BODY,
    #: kinds of plots
    "plot": {
        "joints": "angles angle coordinates joint joint_coordinates rates qpos qvel reactions reaction "
        "joint_reactions",
        "forces": "force torques torque loads controls",
        "trajectory": "position positions path paths motion bodies xyz top side",
        "energy": "energies ledger balance kinetic potential",
        "contacts": "contact modes intervals gaps",
        "phase": "phase_plane phase_space portrait velocity velocities speed",
        "impacts": "collisions hits impulses bounces",
        "a picture at one time is carom.films.still(solution, time), a film carom.film(solution, path)":
            "scene 3d still film animation",
    },
    "JointView": {
        "coordinate": "position", "rate": "velocity speed omega", "force": "reaction reactions load",
        "impulses": "impulse joint_impulses impacts",
    },
    "carom": {
        "Scene": "World Simulation Simulator System Space Engine MultibodyPlant ChSystem ChSystemNSC",
        "Sphere": "Ball",
        "Box": "Cube Cuboid",
        "Capsule": "Rod Pill",
        "Convex": "ConvexHull Hull Polyhedron",
        "simulate": "solve integrate step solve_ivp odeint",
        "ensemble": "monte_carlo sweep batch parallel",
        "view": "show render animate display",
        "euler": "rpy from_euler quaternion quat rotation",
        "load_model": "load_mjcf load_urdf read_urdf from_urdf from_mjcf MjModel",
        "a run is read by carom.Solution.load(path), a robot by carom.load_model(path), a mesh by "
        "carom.Mesh.load(path)": "load read open load_solution",
        "a run is written by solution.save(path)": "save dump write",
        "a plot is made by solution.plot(), and by the functions of carom.plots": "plot",
        "a floor is made by scene.add_half_space(point, normal)": "Plane HalfSpace Ground Floor",
        "a body is made by scene.add_body(shape, mass=...)": "Body RigidBody Particle PointMass",
        "a body that never moves is made by scene.add_static(shape)": "StaticBody Static",
        "a contact is made by scene.add_contact(body, other)": "Contact Collision",
        _ELSEWHERE.format("joints", "Revolute"): "Hinge Revolute HingeJoint RevoluteJoint PivotJoint",
        "a hinge is carom.joints.Revolute, and a rod carom.joints.Distance": "PinJoint",
        _ELSEWHERE.format("joints", "Prismatic"): "Prismatic Slider PrismaticJoint",
        _ELSEWHERE.format("joints", "Spherical"): "Spherical BallJoint",
        _ELSEWHERE.format("joints", "Fixed"): "Fixed Weld FixedJoint WeldJoint",
        _ELSEWHERE.format("forces", "Spring"): "Spring DampedSpring Damper",
        _ELSEWHERE.format("forces", "Force"): "Force",
        _ELSEWHERE.format("forces", "Torque"): "Torque",
        _ELSEWHERE.format("constraints", "Driver"): "Motor Driver Actuator",
        _ELSEWHERE.format("constraints", "Gear"): "Gear",
        "a cord that goes slack is carom.joints.Tether, an elastic one carom.forces.CurveSpring":
            "Rope Cable Tether SlideJoint",
        "a conveyor is a fixed part with a surface that moves: scene.add_half_space(..., surface_velocity=)":
            "Conveyor ConveyorBelt",
        "a belt over wheels is carom.joints.Belt, one that carries is a surface that moves: "
        "scene.add_half_space(..., surface_velocity=)": "Belt",
    },
    "carom.joints": {
        "Revolute": "hinge rotational pin pivot continuous RevoluteJoint HingeJoint",
        "Spherical": "ball socket BallJoint",
        "Prismatic": "slide slider translational PrismaticJoint",
        "Fixed": "weld rigid FixedJoint",
        "Distance": "rod",
        "Tether": "rope cable cord string SlideJoint",
        "Belt": "chain TimingBelt ToothedBelt BeltDrive",
        "a hinge is Revolute, and a rod is Distance": "PinJoint",
        "Universal": "cardan",
        "RollingSphere": "RollingJoint RollingBall",
        "RollingDisc": "wheel",
        "a body without a joint moves freely": "free freejoint floating sixdof",
        "a motor is carom.constraints.Driver or carom.forces.JointForce": "motor driver actuator",
        "a gear is carom.constraints.Gear": "gear",
        "a spring is carom.forces.Spring, or carom.forces.JointSpring along a joint": "spring bushing",
        "a limit is made by scene.add_stop(joint, upper=...)": "limit stop",
    },
    "carom.forces": {
        "a damper is a spring without stiffness: carom.forces.Spring(stiffness=0, damping=...)":
            "Damper Dashpot LinearDamper",
        "JointSpring": "TorsionSpring TorsionalSpring RotationalSpring RotarySpring JointDamper",
        "Spring": "LinearSpring DampedSpring SpringDamper",
        "Force": "Constant ConstantForce Thruster Load PointForce",
        "Torque": "Moment Couple",
        "JointForce": "Motor JointTorque JointActuator",
        "Actuator": "GeneralActuator ForceActuator",
        "PositionServo": "Servo PositionActuator Position PDController PDServo",
        "JointFriction": "DryFriction CoulombFriction",
        "Drive": "Clutch SlipClutch TorqueLimiter Brake LimitedMotor SpeedServo VelocityMotor",
        "VelocityServo": "VelocityActuator Velocity",
        "JointInertia": "Armature Rotor ReflectedInertia",
        "Bushing": "Mount",
        "an elastic rope is scene.add_rope(..., stiffness=...), one of fixed length carom.joints.Tether":
            "Rope Cable Tether",
        "Drag": "AirDrag AirResistance FluidDrag Aerodynamic",
        "Magnus": "Lift SpinLift",
        "Buoyancy": "Archimedes Buoyant Float",
        "UserForce": "Custom CustomForce Function Field Wrench",
        "gravity is that of the scene: carom.Scene(gravity=...)": "Gravity",
        "friction of contacts is stated by scene.add_contact(..., friction=)": "Friction",
    },
    "carom.constraints": {
        "Driver": "Motor RotationMotor SpeedMotor PrescribedMotion Actuator",
        "Coupling": "Rack RackAndPinion Differential Mimic",
        "a belt over wheels is carom.joints.Belt, a rope scene.add_rope": "Pulley Belt Chain",
        "a rope that rubs on a drum is carom.Pulley(..., friction=...), in scene.add_rope": "Capstan BandBrake",
        "Gear": "GearJoint GearRatio",
        "Rows": "Custom UserConstraint Nonholonomic",
        "a limit is made by scene.add_stop(joint, upper=...)": "Limit Stop RotaryLimit",
        _ELSEWHERE.format("joints", "Fixed"): "Weld Fixed",
        _ELSEWHERE.format("joints", "Distance"): "Distance Rod",
        _ELSEWHERE.format("joints", "Revolute"): "Hinge Revolute",
    },
}  # fmt: skip


#: values of an argument that are those of another one, with a sentence
WORDS = {
    "multiple": {
        "that is an impact law of contacts: scene.add_contact(..., impact_law={!r})": "moreau poisson stronge",
    },
    "impact_law": {
        "that is a law of multiple impact: carom.Options(multiple={!r})": "simultaneous sequential",
    },
}


def _plain(name: str) -> str:
    return name.lower().replace("_", "")


def _by_name(table: dict[str, str]) -> dict[str, str]:
    return {_plain(name): ours for ours, names in table.items() for name in names.split()}


MEANT: dict[str, list[str]] = {}
for _ours, _others in VALUES.items():
    for _other in _others.split():
        MEANT.setdefault(_other, []).append(_ours)
PLACE = {name: said for said, names in PLACES.items() for name in names.split()}
_ARGUMENT = {
    function: {name: said for said, names in table.items() for name in names.split()}
    for functions, table in ARGUMENTS.items()
    for function in functions.split()
}
_MEMBER = {owner: _by_name(table) for owner, table in MEMBERS.items()}


def of_member(owner: str, name: str) -> str:
    """Return what a class or module has for a name from elsewhere: a name or a sentence, "" for none."""
    return _MEMBER.get(owner, {}).get(_plain(name), "")


def of_argument(function: str, name: str) -> str:
    """Return the sentence about an argument that a function or a class does not have, "" for none."""
    return _ARGUMENT.get(function, {}).get(name, "")


def of_word(argument: str, value: str) -> str:
    """Return the sentence about a value that belongs to another argument, "" for none."""
    for said, words in WORDS.get(argument, {}).items():
        near = get_close_matches(value.lower(), words.split(), n=1, cutoff=0.8)
        if near:
            return said.format(near[0])
    return ""


def ending(owner: str, name: str, members, near: str = "") -> str:
    """Return the end of the message about a name that a class or module does not have, "" if nothing is near.

    `near` is a member that is meant where the table of the owner has none.
    """
    meant = of_member(owner, name)
    if meant and not meant.isidentifier():
        return f"; {meant}"
    close = (
        [meant or near] if meant or near else get_close_matches(name, members, n=1, cutoff=ALIKE)
    )
    return f"; did you mean {close[0]!r}?" if close else ""
