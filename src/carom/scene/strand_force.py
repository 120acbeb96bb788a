"""`BeltStrand`: the tension of a strand of a belt, or of a part of a rope, which pulls and does not push."""

from __future__ import annotations

from dataclasses import dataclass

from carom import arguments, fields
from carom.fields import Integer, Number, Value
from carom.scene.coordinates import Along, joint_or_combination
from carom.scene.more_forces import PUSH, AlongJoint

PULLS = 2  # in the column `limited` of `PUSH`


@arguments.known
@dataclass(frozen=True, eq=False)
class BeltStrand(AlongJoint):
    """A spring along a joint coordinate, or a sum of them, that pulls only: a strand of an elastic belt.

    Its tension is ``tension + stiffness s + damping s'``, or 0 where this is below 0 and it hangs slack, and it
    acts against the growth of the coordinate s. `Scene.add_joint` makes two of them of a `carom.joints.Belt`
    with a stiffness, and `Scene.add_rope` one of each part of a rope with a stiffness.

    Parameters
    ----------
    joint : Joint, str or mapping
        The joint, or its name; or a mapping from joints to factors, which states a sum of their coordinates: of
        a strand between two wheels its radii, one of them negative.
    tension : float
        Tension where the coordinate is 0 [N]; below 0 for a strand that hangs slack there. Default 0.
    stiffness, damping : float
        [N/m] and [N s/m] along a displacement, or a sum in which angles have lengths as factors; [N m/rad] and
        [N m s/rad] along an angle; at least 0. Default 0.
    coordinate : int
        Index of the coordinate of the joint. Default 0.
    """

    table = PUSH
    has_kinks = True

    joint: Along = Value(joint_or_combination)
    tension: Number = fields.number(0.0)
    stiffness: Number = fields.number(0.0, least=0.0)
    damping: Number = fields.number(0.0, least=0.0)
    coordinate: Integer = fields.integer(0, least=0)

    def _rows(self, force, arrays) -> list[dict[str, float]]:
        row = {"coordinate": arrays.coordinate(self.joint, self.coordinate), "limited": PULLS}
        row |= {"stiffness": self.stiffness, "damping": self.damping}
        if self.stiffness > 0.0:
            row["rest"] = -self.tension / self.stiffness
        else:
            row["force"] = -self.tension
        return [row]
