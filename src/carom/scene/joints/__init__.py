"""Joints, defined in world coordinates for the initial position of the system.

Pass a definition to `Scene.add_joint`, with the two bodies that it joins. Anchors are points [m], and axes are
directions (they are normalised; the zero vector is refused), all in world axes. An anchor that may be left out
is by default the mass centre of the child.
"""

from __future__ import annotations

from carom.arguments import members_of
from carom.scene.values import subclasses_in

# isort: off
# The registry: a line a joint, numbered in this order. A new one comes last.
from carom.scene.joints.pairs import Spherical as Spherical
from carom.scene.joints.pairs import Revolute as Revolute
from carom.scene.joints.pairs import Fixed as Fixed
from carom.scene.joints.pairs import Prismatic as Prismatic
from carom.scene.joints.special import Distance as Distance
from carom.scene.joints.rolling import KnifeEdge as KnifeEdge
from carom.scene.joints.pairs import Cylindrical as Cylindrical
from carom.scene.joints.special import Universal as Universal
from carom.scene.joints.pairs import Planar as Planar
from carom.scene.joints.pairs import PointOnLine as PointOnLine
from carom.scene.joints.pairs import PointOnPlane as PointOnPlane
from carom.scene.joints.special import Screw as Screw
from carom.scene.joints.rolling import RollingSphere as RollingSphere
from carom.scene.joints.rolling import RollingDisc as RollingDisc
from carom.scene.joints.on_curve import PointOnCurve as PointOnCurve
from carom.scene.joints.on_curve import CurveOnPoint as CurveOnPoint
# isort: on

from carom.scene.joints.belt import Belt as Belt
from carom.scene.joints.clearance import Clearance as Clearance
from carom.scene.joints.definition import JointDefinition as JointDefinition
from carom.scene.joints.joint import Joint as Joint
from carom.scene.joints.tether import Tether as Tether

JOINTS = subclasses_in(globals(), JointDefinition)

#: what `Scene.add_joint` makes stops, forces or constraints of
OF_PARTS = (Tether, Clearance, Belt)

__getattr__ = members_of("carom.joints", [joint.__name__ for joint in (*JOINTS, *OF_PARTS)])


def __dir__() -> list[str]:
    return ["Joint", "JointDefinition", *(joint.__name__ for joint in (*JOINTS, *OF_PARTS))]
