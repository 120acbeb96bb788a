"""`Belt`: a belt or chain without mass round two wheels, which it turns without slip."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import Any

from carom import arguments, checks, fields
from carom.fields import Flag, Number, NumberOrNone, Value, VectorOrNone, Word
from carom.scene.materials import IMPACT_LAWS
from carom.scene.restitution import restitution


@arguments.known
@dataclass(frozen=True, eq=False)
class Belt:
    """A belt, chain or toothed belt round a wheel of the parent and one of the child, without slip.

    Both wheels turn in `Revolute` joints with parallel axes on one carrier, the ground or a body. Strand 1
    pulls the child along where the coordinate of the parent's hinge grows; strand 2 is the other one. The
    strands pull at both wheels, along their lines, so hinges carry them, and friction by load knows them.

    ==================  ==================================================================================
    as it is            the motion is that of a gear pair with the ratio of the radii. The strands have
                        the tensions `tension` + P/2 and `tension` - P/2, with the force P round the wheels,
                        also where one of them would push
    ``one_sided=True``  a strand pulls or hangs: the belt is a closed rope, with `slack`, and gets taut
                        with a jerk
    ``stiffness=k``     each strand is a spring that pulls only: `tension` + k times its stretch
    ==================  ==================================================================================

    `Scene.add_joint` makes a constraint, stops or forces of it. ``solution["belt1"].tension`` (T, 2) has both
    tensions of a belt as it is; else ``solution["belt1.1"].tension`` and ``solution["belt1.2"].tension``.

    Parameters
    ----------
    radius_parent, radius_child : float
        Radii of the wheels at the belt's centre line [m], above 0.
    crossed : bool
        Whether the strands cross, so that the wheels turn in opposite directions. Default False.
    tension : float
        Tension of both strands at the start, at rest [N]. Default 0; not for one-sided strands without a
        stiffness.
    stiffness : float, optional
        Of each strand [N/m], above 0. Default: strands have fixed lengths.
    damping : float
        Of each elastic strand [N s/m]. Default 0.
    one_sided : bool
        Whether strands of fixed length pull only. Default False. Elastic strands always do.
    slack : float
        By how much the belt is longer than a taut one [m], half of it in each strand at the start. Default 0;
        for strands that pull only, without a tension.
    plane : (3,), optional
        A point of the plane of the belt, in the world at the start [m]. Default: midway between the mass
        centres of the wheels, seen along the axis.
    restitution : float or Restitution
        Of the jerk by which a one-sided strand with slack gets taut, from 0 (default) to 1, or its law: a
        function of the speed [m/s].
    impact_law : str
        As for `Scene.add_stop`.
    """

    radius_parent: Number = fields.length()
    radius_child: Number = fields.length()
    crossed: Flag = fields.flag(False)
    _: KW_ONLY
    tension: Number = fields.number(0.0, least=0.0, unit="N")
    stiffness: NumberOrNone = fields.number(None, above=0.0, unit="N/m")
    damping: Number = fields.number(0.0, least=0.0, unit="N s/m")
    one_sided: Flag = fields.flag(False)
    slack: Number = fields.number(0.0, least=0.0, unit="m")
    plane: VectorOrNone = fields.vector(None)
    restitution: Value[Any, Any] = restitution(0.0)
    impact_law: Word = fields.word(IMPACT_LAWS, "newton")

    def __post_init__(self):
        if self.damping > 0.0 and self.stiffness is None:
            raise ValueError(
                f"damping must be left out of a belt without stiffness, got {self.damping:g}"
            )
        rigid = self.stiffness is None
        if self.restitution != 0.0 and not (rigid and self.one_sided and self.slack > 0.0):
            raise ValueError(
                "restitution must be left out of a belt without slack, whose strands are always taut, with a "
                f"stiffness, or that is not one_sided, got {checks.shown(self.restitution)}"
            )
        if self.slack > 0.0 and (self.tension > 0.0 or (rigid and not self.one_sided)):
            raise ValueError(
                "slack must be left out of a belt with a tension, and of strands that also push (see "
                f"one_sided), got {self.slack:g} m"
            )
        if self.one_sided and rigid and self.tension > 0.0:
            raise ValueError(
                "tension must be left out of strands of fixed length that pull only, which take what the "
                f"motion needs, got {checks.shown(self.tension)}; give a stiffness"
            )

    @property
    def is_relation(self) -> bool:
        """Whether it is a relation of both angles."""
        return self.stiffness is None and not self.one_sided
