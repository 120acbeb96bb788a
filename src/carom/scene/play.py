"""Play between joints: gears with backlash, keys in their slots."""

from __future__ import annotations

from itertools import count
from typing import NamedTuple

from carom import arguments, checks
from carom.scene.coordinates import Factors
from carom.scene.endless_belt import SceneBelts
from carom.scene.forces import AppliedForce, SceneForces
from carom.scene.friction import FrictionLaw, bound_of, isotropic
from carom.scene.joint_friction import JointFriction
from carom.scene.joints import Joint
from carom.scene.restitution import Restitution
from carom.scene.stops import Stop


class Play(NamedTuple):
    """The parts of a play. `Scene.add_play` makes it."""

    lower: Stop
    upper: Stop
    friction: AppliedForce | None


class ScenePlay(SceneBelts, SceneForces):
    """The method of `Scene` for play, which consists of stops and a force."""

    @arguments.known
    def add_play(
        self,
        joint: Joint | str | Factors,
        lower: float,
        upper: float,
        *,
        restitution: float | Restitution = 0.0,
        friction: float | FrictionLaw = 0.0,
        impact_law: str = "newton",
        coordinate: int = 0,
        name: str | None = None,
    ) -> Play:
        """Add play between joints: a sum of their coordinates is free between two limits.

        A gear with backlash has ``{"first": 1.0, "second": ratio}``: the wheels turn freely against each other
        until their teeth strike, and then turn together. A key in its slot, a rack and a worm have play in the
        same way. Both limits are stops (see `add_stop`), with located impacts, restitution and persistent
        contact.

        Parameters
        ----------
        joint
            A mapping from joints, their names, or pairs (joint, index of a coordinate), to factors, none of
            them 0; for one coordinate alone a joint or its name.
        lower, upper
            Limits of ``s = sum of factor_k (q_k - q_k(0))`` [rad], or [m] if any coordinate is a displacement;
            then the factors of angles are lengths. `lower` must be below `upper`, and s is 0 at the start.
        restitution
            Coefficient of restitution of both limits, from 0 (default) to 1, or its law: a function of the
            speed s' of approach.
        friction
            Dry friction along s, at the limits and between them: a torque [N m] or force [N] against s', or its
            law; on joint k it acts as factor_k times this. Default 0.
        impact_law
            As for `add_stop`.
        coordinate
            Index of the coordinate of a single joint. Default 0.
        name
            Name of the play. Default ``"play1"``, ``"play2"``, ... Its parts have the names ``"<name>.lower"``,
            ``"<name>.upper"`` and ``"<name>.friction"``.

        Returns
        -------
        Play
            Both stops, and the friction, None without it.

        Raises
        ------
        ValueError
            If an argument is invalid, or `lower` is not below `upper`.

        Examples
        --------
        >>> import carom
        >>> scene, wheels = carom.Scene(), []
        >>> for k, x in enumerate((0.0, 0.3)):
        ...     wheel = scene.add_body(carom.Cylinder(0.1, 0.02), mass=1.0, position=(x, 0, 0))
        ...     wheels.append(scene.add_joint(carom.joints.Revolute((x, 0, 0), (0, 0, 1)), carom.GROUND, wheel))
        >>> play = scene.add_play({wheels[0]: 1.0, wheels[1]: 2.0}, -0.01, 0.01, restitution=0.3)
        >>> play.upper
        Stop('play1.upper', '1 joint1 + 2 joint2', upper=0.01, restitution=0.3)
        """
        lower, upper = checks.number("lower", lower), checks.number("upper", upper)
        if not lower < upper:
            raise ValueError(f"lower must be below upper, got {lower:g} and {upper:g}")
        bound = bound_of(isotropic("friction", friction))
        if name is None:
            own = {stop.name for stop in self.stops}
            name = next(f"play{k}" for k in count(1) if f"play{k}.lower" not in own)
        of = self._joint_or_combination(joint)
        ends = [
            self._parts.make(
                Stop, "stop", f"{name}.{side}", False, joint=of, coordinate=coordinate,
                restitution=restitution, impact_law=impact_law, **{side: end},
            )
            for side, end in (("lower", lower), ("upper", upper))
        ]  # fmt: skip
        rubs = None
        if bound > 0.0:
            definition = JointFriction(of, friction, coordinate=coordinate)
            rubs = self.add_force(definition, name=f"{name}.friction")
        return Play(ends[0], ends[1], rubs)
