"""Thresholds of contact: lists of points, the search for events, rims."""

ACTIVE_REACH = 0.2  #: size of the smaller body: for active points, which stay so in the iterations of a step
#: size of the smaller body: displacement in a step, or rotation [rad] of its ball, in which none passes
#: through another
SAFE_DISPLACEMENT = 0.25
SAFE_ROTATION = 0.5  #: rad: greatest in a step: points that are nearest at both ends are so in between
TOOTH_REACH = 2e-3  #: size of the smaller body: the same of two profiles, wider where a point is lost
REACH = 1e-3  #: size of the smaller body: points are listed up to this above the least gap, and are one patch
PLACE_ERROR = 1e-11  #: size of the body: nearer corners are one; depth that a return to the surface may leave
DEPTH = 8.0  #: tolerance of a place on a surface: distance at which a normal is looked along
BACK_SIDE = -0.5  #: cosine of the angle: to the normal of a surface: a contact with the back of a solid
FLAT_RIM = 0.2  #: sine of the tilt: below which a rim is nearly flat
RIM_TIME = 1.0 / 64.0  #: step: a rim that turns flat within it counts as flat
RIM_DISTANCE = 1.5  #: square of the radius: squared displacement of the lowest point to a different one
#: square of the radius: squared displacement up to which a step follows the point: 10 degrees
RIM_STEP = 0.03
#: distance from curved ground: part of it that a body certainly has where another foot may be nearer
CAUTION = 0.2
CUBIC_SHARE = 8.0 / 27.0  #: step times speed at the ends of a cubic: by which it leaves its chord at most
CHORD_ANGLE = 2.23  #: distance of two quaternions: bound of their angle, up to a half turn: pi/sqrt(2)
NORMAL_ERROR = 1e-6  #: 1, or size of the body: normals and heights of one plane differ by less, after turns
EDGE_JUMP = 1e-3  #: 1: normals of edges, or of two points of a pair, that differ by less are one (`TILT`)
STILL_PART = 1e-13  #: speeds of both bodies: relative velocity that counts as zero
