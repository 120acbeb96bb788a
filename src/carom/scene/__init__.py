"""The description of a system: shapes, bodies, contacts, joints, forces. NumPy only, no motion."""

from carom.scene import constraints as constraints
from carom.scene import curves as curves
from carom.scene import forces as forces
from carom.scene import joints as joints
from carom.scene import shapes as shapes
from carom.scene.bodies import GROUND as GROUND
from carom.scene.bodies import Body as Body
from carom.scene.bodies import Ground as Ground
from carom.scene.bodies import HalfSpace as HalfSpace
from carom.scene.constraints import Constraint as Constraint
from carom.scene.contacts import Contact as Contact
from carom.scene.forces import AppliedForce as AppliedForce
from carom.scene.joints import Joint as Joint
from carom.scene.materials import ContactLaw as ContactLaw
from carom.scene.materials import Material as Material
from carom.scene.scene import Scene as Scene
from carom.scene.shapes import Box as Box
from carom.scene.shapes import Capsule as Capsule
from carom.scene.shapes import Compound as Compound
from carom.scene.shapes import Convex as Convex
from carom.scene.shapes import Cylinder as Cylinder
from carom.scene.shapes import Disc as Disc
from carom.scene.shapes import Ellipsoid as Ellipsoid
from carom.scene.shapes import Mesh as Mesh
from carom.scene.shapes import Shape as Shape
from carom.scene.shapes import Sphere as Sphere
