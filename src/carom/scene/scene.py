"""The scene: what the user states."""

from __future__ import annotations

from numpy.typing import ArrayLike

from carom import check
from carom.scene.bodies import GROUND, Body, Ground, HalfSpace, make_body, make_half_space
from carom.scene.contacts import Contact, check_gap, make_contact
from carom.scene.forces import FORCES, AppliedForce, ForceDefinition, make_force
from carom.scene.joints import JOINTS, Joint, JointDefinition, make_joint
from carom.scene.registry import Registry
from carom.scene.shapes import Shape
from carom.scene.summary import counts, summary


class Scene:
    """Bodies, half-spaces, contacts, joints and forces, as they stand at the start.

    The ``add_*`` methods check what they are given at once and return a frozen handle. Names are
    unique among all parts; ``scene["die"]`` is the part of that name.

    Parameters
    ----------
    gravity : (3,), default (0, 0, -9.81)
        Acceleration in world axes [m/s^2].

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
        self._gravity = check.finite_array("gravity", gravity, (3,), unit="m/s^2")
        self._gravity.setflags(write=False)
        self._parts = Registry()
        self._pairs: set[tuple[Body, HalfSpace]] = set()

    def add_half_space(
        self, point: ArrayLike, normal: ArrayLike, *, name: str | None = None
    ) -> HalfSpace:
        """Add a fixed half-space that bodies may strike.

        Parameters
        ----------
        point : (3,)
            Any point of its plane [m].
        normal : (3,)
            From the half-space into free space; made a unit vector.
        name
            Default ``"half_space1"``, ``"half_space2"``, ...
        """
        index, name = self._parts.new(HalfSpace, name, "half_space")
        return self._parts.add(make_half_space(index, name, point, normal))

    def add_body(
        self,
        shape: Shape | None = None,
        *,
        mass: float | None = None,
        density: float | None = None,
        inertia: ArrayLike | None = None,
        position: ArrayLike = (0.0, 0.0, 0.0),
        orientation: ArrayLike = (1.0, 0.0, 0.0, 0.0),
        velocity: ArrayLike = (0.0, 0.0, 0.0),
        angular_velocity: ArrayLike = (0.0, 0.0, 0.0),
        name: str | None = None,
    ) -> Body:
        """Add a rigid body.

        Parameters
        ----------
        shape
            `Sphere`, `Box`, `Capsule`, `Cylinder` or `Convex`; may be left out where nothing
            touches the body.
        mass, density
            Exactly one of the two: [kg], or [kg/m^3] of the shape; above 0.
        inertia : (3,) or (3, 3)
            Principal moments along the body axes, or the symmetric matrix in body axes, about the
            mass centre [kg m^2]. Default: that of the solid shape; needed where there is none.
        position : (3,)
            Of the mass centre, in the world [m].
        orientation : (4,)
            Unit quaternion (w, x, y, z), body to world.
        velocity : (3,)
            Of the mass centre, in world axes [m/s].
        angular_velocity : (3,)
            In world axes [rad/s].
        name
            Default ``"body1"``, ``"body2"``, ...

        Raises
        ------
        ValueError
            If an argument is outside its range, the inertia is that of no body, or the name is taken.
        """
        index, name = self._parts.new(Body, name, "body")
        motion = (position, orientation, velocity, angular_velocity)
        body = make_body(index, name, shape, mass, density, inertia, *motion)
        return self._parts.add(body)

    def add_contact(
        self,
        body: Body,
        half_space: HalfSpace,
        *,
        restitution: float = 0.5,
        friction: float = 0.0,
        impact_law: str = "newton",
        name: str | None = None,
    ) -> Contact:
        """Let a body and a half-space touch.

        Parameters
        ----------
        body
            With a shape other than `Cylinder`, and not inside the half-space.
        half_space
            What it may strike.
        restitution
            e, from 0 (plastic) to 1 (elastic). Default 0.5.
        friction
            Coulomb's mu, at least 0. Default 0.
        impact_law : {"newton", "poisson", "stronge"}
            What e compares: speeds, impulses or works. Default ``"newton"``.
        name
            Default: the names of both, such as ``"die-ground"``.
        """
        self._parts.member("body", body, (Body,))
        self._parts.member("half_space", half_space, (HalfSpace,))
        if (body, half_space) in self._pairs:
            raise ValueError(
                f"body {body.name!r} and half_space {half_space.name!r} must be given once, "
                "got a second contact of the two"
            )
        name = f"{body.name}-{half_space.name}" if name is None else name
        index, name = self._parts.new(Contact, name, "contact")
        law = (restitution, friction, impact_law)
        contact = self._parts.add(make_contact(index, name, body, half_space, *law))
        self._pairs.add((body, half_space))
        return contact

    def add_joint(
        self,
        definition: JointDefinition,
        parent: Body | Ground,
        child: Body,
        *,
        name: str | None = None,
    ) -> Joint:
        """Join two bodies, or a body and the ground.

        Parameters
        ----------
        definition
            Of `carom.joints`: what is held, placed in the world at the start.
        parent
            A body, or `carom.GROUND`.
        child
            Another body.
        name
            Default ``"joint1"``, ``"joint2"``, ...
        """
        check.instance("definition", definition, JOINTS)
        self._parts.pair(parent, child)
        index, name = self._parts.new(Joint, name, "joint")
        return self._parts.add(make_joint(index, name, definition, parent, child))

    def add_force(
        self,
        definition: ForceDefinition,
        parent: Body | Ground = GROUND,
        child: Body | None = None,
        *,
        name: str | None = None,
    ) -> AppliedForce:
        """Add a force on `child`, or between `parent` and `child`.

        Both ``add_force(definition, child)``, where the ground is the parent, and
        ``add_force(definition, parent, child)`` are allowed.

        Parameters
        ----------
        definition
            Of `carom.forces`.
        parent
            A body, or `carom.GROUND`. A body given alone is the child.
        child
            Another body.
        name
            Default ``"force1"``, ``"force2"``, ...
        """
        check.instance("definition", definition, FORCES)
        if child is None and isinstance(parent, Body):
            parent, child = GROUND, parent
        self._parts.pair(parent, child)
        index, name = self._parts.new(AppliedForce, name, "force")
        return self._parts.add(make_force(index, name, definition, parent, child))

    @property
    def gravity(self):
        """Acceleration of gravity (3,), world axes [m/s^2]."""
        return self._gravity

    @property
    def bodies(self) -> tuple[Body, ...]:
        """The bodies, in the order added."""
        return self._parts.parts(Body)

    @property
    def half_spaces(self) -> tuple[HalfSpace, ...]:
        """The half-spaces, in the order added."""
        return self._parts.parts(HalfSpace)

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """The contacts, in the order added."""
        return self._parts.parts(Contact)

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The joints, in the order added."""
        return self._parts.parts(Joint)

    @property
    def forces(self) -> tuple[AppliedForce, ...]:
        """The forces, in the order added."""
        return self._parts.parts(AppliedForce)

    def __getitem__(self, name: str):
        """Return the part called `name`; a `KeyError` suggests the nearest one."""
        return self._parts[name]

    def validate(self) -> None:
        """Refuse a scene that cannot start: no bodies, or one inside what it touches.

        Raises
        ------
        ValueError
            Naming the contact, how deep the body is, and what to do.
        """
        if not self.bodies:
            raise ValueError("scene must have at least one body, got none; add it with add_body")
        for contact in self.contacts:
            check_gap(contact)

    def __repr__(self) -> str:
        return f"<Scene: {counts(self)}>"

    def __str__(self) -> str:
        return summary(self)
