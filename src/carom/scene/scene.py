"""`Scene`: the description of a system."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.scene.bodies import GROUND, Body, Ground, HalfSpace, StaticBody, mass_and_inertia
from carom.scene.changes import KINDS, list_of, renewed
from carom.scene.changes import dependents as dependents_of
from carom.scene.constraints import CONSTRAINTS, Constraint, ConstraintDefinition
from carom.scene.contacts import Contact, check_gap
from carom.scene.forces import FORCES, AppliedForce, ForceDefinition, force_on, sides
from carom.scene.joints import JOINTS, Joint, JointDefinition
from carom.scene.look import Look, checked_look
from carom.scene.materials import Material
from carom.scene.moving_surfaces import GivenSpin
from carom.scene.named_parts import with_parts
from carom.scene.pairs import Pairs
from carom.scene.registry import Derived, Registry
from carom.scene.restitution import Restitution
from carom.scene.shapes import Shape
from carom.scene.shapes.mesh import shape_given
from carom.scene.shown import Shown
from carom.scene.stops import RailContact, Stop
from carom.scene.summary import counts, summary
from carom.scene.surfaces import SURFACES, SurfaceDefinition
from carom.scene.touching import TouchingPairs
from carom.scene.values import in_scene

if TYPE_CHECKING:
    from carom.geometry.attitude import Orientation
    from carom.results.robot import Robot


#: an example of a value that each kind of part has
_VALUES = {
    Body: "mass=...", HalfSpace: "point=...", StaticBody: "position=...", Joint: "definition=...",
    AppliedForce: "definition=...", Constraint: "definition=...", Stop: "restitution=...",
    Contact: "friction=...",
}  # fmt: skip


@in_scene
@arguments.known
class Scene(Shown, TouchingPairs):
    """A system of bodies, half-spaces, contacts, joints and forces, with its initial state.

    The ``add_*`` methods check their arguments at once and return the new part, a read-only object. Each part
    has a name that is unique in the scene: ``scene["die"]`` is the part with the name "die", ``"die" in scene``
    says whether there is one, and ``for part in scene`` goes through all. With ``replace=True`` they put the
    new part in the place of the one that has its name. `replace` and `remove` change a scene too; a solution
    keeps the scene as it was.

    Parameters
    ----------
    gravity : (3,), default (0, 0, -9.81)
        Acceleration in world axes [m/s^2]. It may be set later: ``scene.gravity = (0, 0, -1.62)``.

    Attributes
    ----------
    look : tuple of Look
        What is seen in pictures, pages and films besides the parts of the scene, in world axes. It touches
        nothing. It may be set: ``scene.look = [carom.Look(...)]``.

    Examples
    --------
    >>> import carom
    >>> scene = carom.Scene()
    >>> ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="ground")
    >>> ball = scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 1), name="ball")
    >>> scene.add_contact(ball, ground, restitution=0.8)
    Contact('ball-ground', restitution=0.8, friction=0, impact_law='newton')
    """

    def __init__(self, gravity: ArrayLike = (0.0, 0.0, -9.81)):
        self._parts = Registry()
        self._pairs = Pairs(self._parts)
        self.gravity = gravity
        #: the scene for solutions, and the results of this one when it was made
        self._snapshot: tuple = None, None
        self._in_radians: set[str] = set()  # stops whose file has radians
        self._robot: Robot | None = None
        self._look: tuple[Look, ...] = ()

    @arguments.known
    def add_half_space(
        self,
        point: ArrayLike,
        normal: ArrayLike,
        *,
        material: Material | None = None,
        color: str | ArrayLike | None = None,
        surface_velocity: ArrayLike | Callable | None = None,
        surface_spin: GivenSpin | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> HalfSpace:
        """Add a fixed solid half-space behind a plane, for example a floor.

        Parameters
        ----------
        point : (3,)
            A point of its surface, which is a plane [m].
        normal : (3,)
            Normal of the surface, out of the half-space into free space; it is normalised.
        material
            Material of its surface, see `set_contact_default`.
        color : str or (3,)
            Colour in pages, pictures and films, as for `add_body`. Default: grey.
        surface_velocity, surface_spin
            Motion of its surface in itself, as for `add_static`: a belt, a turntable. The velocity must be in
            the plane, the axis along the normal; the spin is about `point`, if no other point is given.
        name
            Name in the scene. Default ``"half_space1"``, ``"half_space2"``, ...
        replace : bool
            True: a half-space that has this name is replaced, and what refers to it then refers to the new one.
            Default False: a name that is taken is refused.
        """
        motion: Any = surface_velocity, surface_spin
        index, name = self._parts.new(HalfSpace, name, "half_space", replace)
        return self._parts.add(HalfSpace(index, name, point, normal, material, color, *motion))

    @arguments.known
    def add_body(
        self,
        shape: Shape | None = None,
        *,
        mass: float | None = None,
        density: float | None = None,
        inertia: ArrayLike | None = None,
        position: ArrayLike = (0.0, 0.0, 0.0),
        orientation: Orientation = (1.0, 0.0, 0.0, 0.0),
        velocity: ArrayLike = (0.0, 0.0, 0.0),
        angular_velocity: ArrayLike = (0.0, 0.0, 0.0),
        material: Material | None = None,
        color: str | ArrayLike | None = None,
        look: Shape | Look | Sequence[Shape | Look] | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> Body:
        """Add a rigid body.

        Parameters
        ----------
        shape
            `Sphere`, `Box`, `Capsule`, `Cylinder`, `Disc`, `Ellipsoid`, `Convex`, `Mesh`,
            `Profile` or `Compound`; or an object of trimesh, as a `Mesh`. A body without a shape cannot touch
            anything.
        mass, density
            Exactly one of the two, above 0: the mass [kg], or the density of the shape [kg/m^3].
        inertia : (3,) or (3, 3)
            Inertia about the mass centre [kg m^2]: principal moments along the body axes, or the symmetric
            matrix in body axes. Default: the inertia of the solid shape. A body without a shape needs it.
        position : (3,)
            Initial position of the mass centre, in the world [m].
        orientation : (4,), (3, 3) or scipy.spatial.transform.Rotation
            Initial orientation, body to world: a unit quaternion (w, x, y, z) with the scalar first, a rotation
            matrix, or a SciPy Rotation. `carom.euler` and `carom.axis_angle` compute quaternions from angles in
            degrees. A small error of normalisation (below 1e-3), as in (0.7071, 0, 0, 0.7071), is corrected.
        velocity : (3,)
            Initial velocity of the mass centre, in world axes [m/s].
        angular_velocity : (3,)
            Initial angular velocity, in world axes [rad/s].
        material
            Material of its surface, see `set_contact_default`.
        color : str or (3,)
            Colour in pages, pictures and films: a colour name of matplotlib (``"tab:red"``, ``"gold"``),
            ``"#rrggbb"``, or red, green and blue from 0 to 1. Default: a colour of the palette.
        look : Look, shape, or sequence of them
            What pages, pictures, films and exports show in place of the shape. It touches nothing. Default: the
            shape. An empty sequence: nothing is seen.
        name
            Name in the scene. A cube with "die" in its name is drawn with pips. Default ``"body1"``,
            ``"body2"``, ...
        replace : bool
            True: a body that has this name is replaced, and what refers to it then refers to the new one.
            Default False: a name that is taken is refused.

        Raises
        ------
        ValueError
            If an argument is outside its range, no rigid body can have the inertia, or another part has the
            name.

        Examples
        --------
        >>> scene = carom.Scene()
        >>> die = scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.3), name="die")
        >>> print(die.inertia[0].round(12))  # m a^2 / 6
        [1.066667e-06 0.000000e+00 0.000000e+00]
        >>> scene.add_body(carom.Sphere(0.1), mass=-1.0)
        Traceback (most recent call last):
            ...
        ValueError: mass must be finite and above 0 [kg], got -1.0
        """
        index, name = self._parts.new(Body, name, "body", replace)
        shape = shape_given(shape)
        mass, inertia = mass_and_inertia(shape, mass, density, inertia)
        motion: Any = position, orientation, velocity, angular_velocity, material, color, look
        return self._parts.add(Body(index, name, shape, mass, inertia, *motion))

    @arguments.known
    def add_static(
        self,
        shape: Shape,
        *,
        position: ArrayLike = (0.0, 0.0, 0.0),
        orientation: Orientation = (1.0, 0.0, 0.0, 0.0),
        material: Material | None = None,
        color: str | ArrayLike | None = None,
        surface_velocity: ArrayLike | Callable | None = None,
        surface_spin: GivenSpin | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> StaticBody:
        """Add a solid that never moves: a wall, a peg, a ramp, a mesh.

        Bodies touch it as they touch each other. It has no mass and no degrees of freedom, and it does not
        connect the bodies that touch it to one island.

        Parameters
        ----------
        shape
            As for `add_body`.
        position : (3,)
            Position of the origin of the shape (its mass centre), in the world [m].
        orientation
            As for `add_body`.
        material
            Material of its surface, see `set_contact_default`.
        color : str or (3,)
            Colour in pages, pictures and films, as for `add_body`. Default: grey.
        surface_velocity : (3,), callable or scipy.interpolate.PPoly
            Velocity [m/s] with which its surface moves in itself while the solid stays where it is, as a belt
            does. At a contact only the tangential part acts. Or a function ``t -> (velocity, acceleration)``,
            each (3,), as that of a `Driver`, or the velocity as a piecewise polynomial with values (3,)
            (`scipy.interpolate.PPoly`, `CubicSpline`, ...).
        surface_spin : (axis, rate) or (axis, rate, point)
            Its surface turns in itself about an axis (3,) with this rate [rad/s], as those of turntables and
            rollers do, in addition to `surface_velocity`. The axis goes through `position`, or through `point`
            (3,). The rate may be a function ``t -> (rate, its derivative)`` or a piecewise polynomial. The work
            of both drives is in `Ledger.loads`, the power of each in `Solution.surface_power`.
        name
            Name in the scene. Default ``"static1"``, ``"static2"``, ...
        replace : bool
            True: a static body that has this name is replaced, and what refers to it then refers to the new
            one. Default False: a name that is taken is refused.

        Examples
        --------
        A ball falls on a step:

        >>> scene = carom.Scene()
        >>> step = scene.add_static(carom.Box(1, 1, 0.2), position=(0, 0, 0.1), name="step")
        >>> ball = scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 0.8), name="ball")
        >>> scene.add_contact(ball, step, restitution=0.5, friction=0.3)
        Contact('ball-step', restitution=0.5, friction=0.3, impact_law='newton')
        """
        index, name = self._parts.new(StaticBody, name, "static", replace)
        shape = shape_given(shape)
        look: Any = material, color, surface_velocity, surface_spin
        return self._parts.add(StaticBody(index, name, shape, position, orientation, *look))

    @arguments.known
    def add_surface(
        self,
        definition: SurfaceDefinition,
        *,
        position: ArrayLike = (0.0, 0.0, 0.0),
        orientation: Orientation = (1.0, 0.0, 0.0, 0.0),
        material: Material | None = None,
        color: str | ArrayLike | None = None,
        surface_velocity: ArrayLike | Callable | None = None,
        surface_spin: GivenSpin | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> StaticBody:
        """Add ground that is not a plane: a bowl, a pipe, a funnel, a field of heights.

        Bodies touch it as they touch static bodies, among which it is listed. It reaches as far as its
        definition says, without end; one side of it is solid.

        Parameters
        ----------
        definition
            A surface of `carom.surfaces`.
        position : (3,)
            Position of its origin, in the world [m].
        orientation
            From its axes to the world, as for `add_body`.
        material
            Material of the surface, see `set_contact_default`.
        color : str or (3,)
            Colour in pages, pictures and films, as for `add_body`. Default: grey.
        surface_velocity, surface_spin
            Motion of the surface in itself, as for `add_static`: a drum that turns.
        name
            Name in the scene. Default ``"surface1"``, ``"surface2"``, ...
        replace : bool
            True: a static body that has this name is replaced, and what refers to it then refers to the new
            one. Default False: a name that is taken is refused.

        Examples
        --------
        A ball rolls in a bowl:

        >>> scene = carom.Scene()
        >>> bowl = scene.add_surface(carom.surfaces.InsideSphere(0.5), position=(0, 0, 0.5), name="bowl")
        >>> ball = scene.add_body(carom.Sphere(0.05), mass=1, position=(0, 0, 0.05), name="ball")
        >>> scene.add_contact(ball, bowl, restitution=0.5, friction=0.3)
        Contact('ball-bowl', restitution=0.5, friction=0.3, impact_law='newton')
        """
        checks.instance("definition", definition, SURFACES)
        index, name = self._parts.new(StaticBody, name, "surface", replace)
        place: Any = position, orientation, material, color, surface_velocity, surface_spin
        return self._parts.add(StaticBody(index, name, definition, *place))

    @arguments.known
    def add_joint(
        self,
        definition: JointDefinition,
        parent: Body | Ground | str | None = None,
        child: Body | str | None = None,
        *,
        parent_frame: tuple[ArrayLike, Orientation] | None = None,
        child_frame: tuple[ArrayLike, Orientation] | None = None,
        name: str | None = None,
        replace: bool = False,
    ) -> Joint:
        """Join two bodies, or a body and the ground.

        Parameters
        ----------
        definition
            A joint of `carom.joints`. Its points and axes are in the world at the start; with frames, they are
            in a frame that is fixed in both bodies.
        parent
            A body or its name, or `carom.GROUND`.
        child
            Another body, or its name.
        parent_frame, child_frame
            Position and orientation of this frame in the parent and in the child: a pair (position (3,),
            orientation as for `add_body`), relative to the mass centre, in body axes; for the ground, in the
            world. The coordinates of the joint are 0 where the two frames agree. If the initial positions
            do not fit the joint, `Options(project_start=True)` moves the bodies so that they do; otherwise
            `simulate` refuses them. Default None: the definition is in the world.
        name
            Name in the scene. Default ``"joint1"``, ``"joint2"``, ...
        replace : bool
            True: a joint that has this name is replaced, and what refers to it then refers to the new one.
            Default False: a name that is taken is refused.

        Examples
        --------
        >>> scene = carom.Scene()
        >>> rod = scene.add_body(carom.Box(1, 0.1, 0.1), mass=1.0, position=(0.5, 0, 0), name="rod")
        >>> hinge = carom.joints.Revolute(anchor=(0, 0, 0), axis=(0, 1, 0))
        >>> scene.add_joint(hinge, carom.GROUND, rod, name="hinge")
        Joint('hinge', Revolute, 'GROUND' -> 'rod')
        """
        order = "; the order is add_joint(definition, parent, child)"
        checks.instance("definition", definition, JOINTS, order if _is_side(definition) else "")
        if parent is None or child is None:
            raise TypeError(
                "parent and child must be given: add_joint(definition, carom.GROUND, body) joins a body to the "
                "world, add_joint(definition, parent, child) two bodies; got "
                f"{checks.shown(parent)} and {checks.shown(child)}"
            )
        pair: Any = self._parts.pair(parent, child)
        index, name = self._parts.new(Joint, name, "joint", replace)
        frames: Any = parent_frame, child_frame
        return self._parts.add(Joint(index, name, definition, *pair, frames=frames))

    @arguments.known
    def add_force(
        self,
        definition: ForceDefinition,
        parent: Body | Ground | str = GROUND,
        child: Body | str | None = None,
        *,
        name: str | None = None,
        replace: bool = False,
    ) -> AppliedForce:
        """Add a force on `child`, or between `parent` and `child`.

        There are three forms: ``add_force(definition, child)``, where the ground is the parent;
        ``add_force(definition, parent, child)``; and ``add_force(definition)`` for a definition that contains
        its joint or its bodies (`JointSpring`, `JointForce`, `UserForce`).

        Parameters
        ----------
        definition
            A force of `carom.forces`.
        parent
            A body or its name, or `carom.GROUND`. If only one body is given, it is the child.
        child
            Another body, or its name.
        name
            Name in the scene. Default ``"force1"``, ``"force2"``, ...
        replace : bool
            True: a force that has this name is replaced, and what refers to it then refers to the new one.
            Default False: a name that is taken is refused.
        """
        checks.instance("definition", definition, FORCES)
        definition = self._parts.linked(with_parts(definition, self._parts.member))
        named = force_on(definition)
        if named is not None:
            if child is not None or parent is not GROUND:
                raise ValueError(
                    f"parent and child must be left out with {type(definition).__name__}, which names "
                    f"its own, got {checks.shown(parent)} and {checks.shown(child)}"
                )
            parent, child = sides(named[0])
        if child is None and isinstance(parent, (Body, str)):
            parent, child = GROUND, parent
        if child is None:
            raise TypeError(
                "child must be given: add_force(definition, body) for a force on a body, "
                "add_force(definition, parent, child) for one between two"
            )
        pair: Any = self._parts.pair(parent, child)
        index, name = self._parts.new(AppliedForce, name, "force", replace)
        return self._parts.add(AppliedForce(index, name, definition, *pair))

    @arguments.known
    def add_constraint(
        self, definition: ConstraintDefinition, *, name: str | None = None, replace: bool = False
    ) -> Constraint:
        """Add a constraint beyond joints: a gear, a motor, or user-defined rows.

        Parameters
        ----------
        definition
            A constraint of `carom.constraints`. Its joints and bodies, given as objects or by name, must belong
            to this scene.
        name
            Name in the scene. Default ``"constraint1"``, ``"constraint2"``, ...
        replace : bool
            True: a constraint that has this name is replaced, and what refers to it then refers to the new one.
            Default False: a name that is taken is refused.
        """
        checks.instance("definition", definition, CONSTRAINTS)
        index, name = self._parts.new(Constraint, name, "constraint", replace)
        definition = self._parts.linked(with_parts(definition, self._parts.member))
        return self._parts.add(Constraint(index, name, definition))

    @arguments.known
    def add_stop(
        self,
        joint: Joint | str,
        *,
        lower: float | None = None,
        upper: float | None = None,
        restitution: float | Restitution = 0.0,
        impact_law: str = "newton",
        coordinate: int | str = 0,
        name: str | None = None,
        replace: bool = False,
    ) -> Stop:
        """Add a stop: a limit of a joint coordinate, with impacts and restitution.

        A stop is a unilateral constraint on a coordinate of the joint. Its impacts pass the same boundary layer
        as those of contacts, and their impulses act on the whole mechanism. In `Solution.impacts` the `contact`
        of a stop is the number of contacts of bodies plus the index of the stop. Its impulse has only a normal
        component; for an angle, impulses are in [N m s] and speeds in [rad/s].

        Parameters
        ----------
        joint
            A joint of the scene that has coordinates, or its name.
        lower, upper
            Exactly one of the two: the lower or the upper limit of the coordinate [rad or m]. The coordinate is
            0 at the start. For two limits add two stops.
        restitution
            Coefficient of restitution, from 0 (default) to 1, or its law: a function of the speed of the
            coordinate [rad/s or m/s].
        impact_law
            ``"newton"`` (default), ``"poisson"`` or ``"stronge"``. A stop has no friction, so the laws differ
            only in multiple impacts.
        coordinate
            Index of the coordinate of the joint. Default 0. Of a ball joint (`carom.joints.Spherical`) one of
            ``"rotation"``, ``"swing"`` (a cone) and ``"twist"``. Rotation and swing have upper limits, from 0
            to pi. The twist has no value where the swing is pi, so it needs a limit of the swing.
        name
            Name in the scene. Default ``"stop1"``, ``"stop2"``, ...
        """
        part = self._parts.member("joint", joint, (Joint,))
        index, name = self._parts.new(Stop, name, "stop", replace)
        return self._parts.add(
            Stop(index, name, part, coordinate, lower, upper, restitution, impact_law)
        )

    @arguments.known
    def replace(self, part, **values) -> Any:
        """Replace a part by one with other values, and return it; what refers to it then refers to the new one.

        Values that are not given stay as they are. Joints and forces stay where they are in the world at the
        start, and contacts keep their laws. Positions are checked when the scene is simulated.

        Parameters
        ----------
        part
            The part, or its name.
        **values
            Arguments of the method that adds such parts. For a contact: values of its law. For a joint, force
            or constraint: `definition`, or fields of its definition, as in
            ``scene.replace("spring", stiffness=200)``. A new mass scales the inertia of a body, and a new shape
            has the inertia of the solid, unless `inertia` is given.

        Raises
        ------
        TypeError
            If such a part has no value of a given name.
        ValueError
            If there is no such part, or a value is outside its range; the scene is then as before.

        Examples
        --------
        >>> scene = carom.Scene()
        >>> die = scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.016, name="die")
        >>> print(scene.replace("die", mass=0.008, color="red").inertia[0, 0] / die.inertia[0, 0])
        0.5
        """
        old = self._parts.named("part", part)
        if not values:
            raise TypeError(f"replace needs a value, such as {_VALUES[type(old)]}")
        if "definition" in values and isinstance(old, (AppliedForce, Constraint)):
            values["definition"] = self._parts.linked(values["definition"])
        self._parts.exchange({id(old): renewed(old, values)})
        if isinstance(old, Contact) and values.keys() & {"restitution", "friction"}:
            self._pairs.state(old)
        return self._parts[old.name]

    @arguments.known
    def remove(self, part, *, dependents: bool = False) -> tuple:
        """Remove a part, and return all parts that were removed.

        Contacts of a body, half-space or static body are removed with it. Bodies of a joint that is removed may
        touch again by `set_contact_default`.

        Parameters
        ----------
        part
            The part, or its name.
        dependents : bool
            True: joints of a body are removed with it, and also forces, constraints and stops that refer to
            the part or to these joints. Default False: a part that has such dependents is not removed.

        Raises
        ------
        ValueError
            If there is no such part, or joints, forces, constraints or stops refer to it and `dependents` is
            False; the message names them.
        """
        part = self._parts.named("part", part)
        found = list(dependents_of(self._parts, part))
        others = [one for one in found if not isinstance(one, Contact)]
        if others and not checks.flag("dependents", dependents):
            raise ValueError(
                f"dependents must be True to remove {part.name!r} together with what refers to it: "
                f"{list_of(others)}"
            )
        removed = part, *found
        self._parts.exchange({id(one): None for one in removed})
        for one in removed:
            self._pairs.forget(one)
        return removed

    def copy(self) -> Scene:
        """Return a copy of the scene; a change of one of the two does not change the other.

        Parts of one may be given to methods of the other, where they stand for the parts with their names.
        """
        return self._with(self._parts.copied())

    def _with(self, parts: Registry) -> Scene:
        made: Any = object.__new__(type(self))
        own = {"_parts": parts, "_pairs": self._pairs.copied(parts), "_snapshot": (None, None)}
        vars(made).update(vars(self), **own, _in_radians=set(self._in_radians))
        return made

    def _as_it_is(self) -> Scene:
        """Return the scene for solutions, which cannot be changed: the same one until this scene changes."""
        if self._parts.sealed:
            return self
        if self._snapshot[1] is not self._derived:  # which each change makes anew
            self._snapshot = self._with(self._parts.copied(sealed=True)), self._derived
        return self._snapshot[0]

    def __copy__(self) -> Scene:
        return self.copy()

    def __getstate__(self) -> dict:  # of deep copies, whose parts may be changed, and pickles
        return {**vars(self), "_snapshot": (None, None)}

    @property
    def _derived(self) -> Derived:
        return self._parts.derived

    @property
    def robot(self) -> Robot | None:
        """The model in its own coordinates, where `load_model` has made the scene; else None.

        It is also None when one of its bodies, joints or actuators has been removed.
        """
        robot = self._robot
        if robot is None:
            return None
        return self._derived.once("robot", lambda: robot._followed(self._parts.get))

    @property
    def gravity(self):
        """Acceleration of gravity (3,), world axes [m/s^2]."""
        return self._gravity

    @gravity.setter
    def gravity(self, value) -> None:
        gravity = checks.finite_array("gravity", value, (3,), unit="m/s^2")
        self._parts.changes()
        gravity.setflags(write=False)
        self._gravity = gravity

    @property
    def look(self) -> Any:
        """What is seen besides the parts of the scene: a tuple of `Look`, in world axes."""
        return self._look

    @look.setter
    def look(self, value: Look | Shape | Sequence[Look | Shape] | None) -> None:
        look = () if value is None else checked_look("look", value)
        self._parts.changes()
        self._look = look

    @property
    def bodies(self) -> tuple[Body, ...]:
        """Bodies, in the order in which they were added."""
        return self._parts.parts(Body)

    @property
    def half_spaces(self) -> tuple[HalfSpace, ...]:
        """Half-spaces, in the order in which they were added."""
        return self._parts.parts(HalfSpace)

    @property
    def statics(self) -> tuple[StaticBody, ...]:
        """Static bodies, in the order in which they were added."""
        return self._parts.parts(StaticBody)

    @property
    def fixed(self) -> tuple[HalfSpace | StaticBody, ...]:
        """Half-spaces, then static bodies: the parts that never move and that bodies may touch."""
        return (*self.half_spaces, *self.statics)

    @property
    def joints(self) -> tuple[Joint, ...]:
        """Joints, in the order in which they were added."""
        return self._parts.parts(Joint)

    @property
    def forces(self) -> tuple[AppliedForce, ...]:
        """Forces, in the order in which they were added."""
        return self._parts.parts(AppliedForce)

    @property
    def constraints(self) -> tuple[Constraint, ...]:
        """Constraints beyond joints, in the order in which they were added."""
        return self._parts.parts(Constraint)

    @property
    def stops(self) -> tuple[Stop, ...]:
        """Stops of joints, in the order in which they were added, then contacts of rails that can be left."""
        added = self._parts.parts(Stop)
        rails = (joint for joint in self.joints if joint.can_be_left)
        return (*added, *(RailContact(k, joint) for k, joint in enumerate(rails, len(added))))

    def __getitem__(self, name: str):
        """Return the part with this name; the message of a `KeyError` suggests the nearest name.

        A contact is found as ``"die-ground"`` and as ``"ground-die"``.
        """
        return self._parts[name]

    def __iter__(self) -> Iterator:
        """Go through all parts by kind: bodies, half-spaces, static bodies, joints, forces, ..., contacts."""
        return iter([part for kind in KINDS for part in self._parts.parts(kind)])

    def __contains__(self, name) -> bool:
        """Return whether a part has this name; or, of a part, whether it is one of this scene."""
        return self._parts.has(name)

    def _ipython_key_completions_(self) -> list[str]:
        return [part.name for part in self._parts]

    def validate(self) -> None:
        """Check that the scene can start: it has bodies, and no body penetrates another one or a half-space.

        Raises
        ------
        ValueError
            If it cannot; the message gives the pair, the penetration, and the remedy.
        """
        if not self.bodies:
            raise ValueError("scene must have at least one body, got none; add it with add_body")
        for contact in self.contacts:
            check_gap(contact)
        self._pairs.check_all(self.bodies, self.fixed)

    def check(self):
        """Return the degrees of freedom of the scene, its redundant constraints, and likely mistakes.

        Returns
        -------
        carom.dynamics.mobility.Mobility
            The values for the initial position; in singular positions a mechanism may have more degrees of
            freedom. Print it for a summary.

        Raises
        ------
        ValueError
            As for `validate`.

        Examples
        --------
        A door on two hinges:

        >>> scene = carom.Scene()
        >>> door = scene.add_body(carom.Box(0.9, 0.04, 2), mass=20, position=(0.45, 0, 1), name="door")
        >>> for name, z in (("lower", 0.2), ("upper", 1.8)):
        ...     hinge = carom.joints.Revolute(anchor=(0, 0, z), axis=(0, 0, 1))
        ...     joint = scene.add_joint(hinge, carom.GROUND, door, name=name)
        >>> print(scene.check())
        1 bodies, 10 constraint rows: 1 degrees of freedom
        5 redundant rows, among lower, upper
        """
        from carom.dynamics.mobility import mobility

        self.validate()
        return mobility(self)

    def __repr__(self) -> str:
        return f"<Scene: {counts(self)}>"

    def __str__(self) -> str:
        return summary(self)


def _is_side(part) -> bool:
    """Return whether an object is a parent or child of a joint, not its definition."""
    return isinstance(part, (Body, Ground, str))
