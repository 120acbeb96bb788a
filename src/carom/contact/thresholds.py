"""Thresholds of contact: lists of points, the search for events, rims."""

REACH = 1e-3  #: the size of the smaller body: points are listed up to this above the least gap
#: the size of the smaller body: the same for active points, which stay active in the iterations of a step
ACTIVE_REACH = 0.2
#: the size of the smaller body: displacement in a step, or rotation [rad] of its ball, in which none
#: passes through another
SAFE_DISPLACEMENT = 0.25
#: rad: rotation in a step up to which points that are nearest at both ends are so in between
SAFE_ROTATION = 0.5
#: the tolerance of a place on a surface: distance at which a normal is looked along
LOOK_DEPTH = 8.0
#: cosine of the angle: to the normal of a surface, below which a contact is with the back of a solid
BACK_SIDE = -0.5
FLAT_RIM = 0.2  #: sine of the tilt: below which a rim is nearly flat
RIM_TIME = 1.0 / 64.0  #: the step: a rim that turns flat within it counts as flat
#: the square of the radius: squared displacement from which on the lowest point of a rim is a different
#: one
RIM_DISTANCE = 1.5
#: the square of the radius: squared displacement up to which a step may follow the point: 10 degrees
RIM_STEP = 0.03
