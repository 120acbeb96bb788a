"""Thresholds of collision: directions, faces and the search for the shortest way out of an overlap."""

LEAST_SINE = 1e-7  #: sine of the angle: edges with less have no common normal: it would be known to 1e-9
TILT = 4.5e-5  #: rad: angle of two faces of which each can be the reference: cosines that differ by 1e-9
CROSSING = 1e-6  #: product of the sizes of the solids: smaller products of two sides give no normal
CLEARANCE = 1e-3  #: size of the smaller solid: such a distance has a direction exact to round-off
LEAST_CLEARANCE = 1e-3  #: `CLEARANCE`: less gives no better direction; of less overlap no way out is shorter
DEPTH_CLEARANCE = 30.0  #: depth: clearance of the second phase of a climb
SAME_CLIMB = 0.95  #: cosine of the angle: starts nearer to an earlier climb are not tried
CURVED_ERROR = 1e-6  #: distance: accuracy of the search for curved cores, which Newton's method then refines
FACE_NORMAL = 1e-5  #: 1 - cosine of the angle: up to which a normal may be that of a face
MARGIN = 4.0  #: tolerance of a surface: within which a point counts as on a face or on a rim
#: cosine of the angle: 8 degrees: of normals of one feature; greatest turn by Newton's method
SAME_DIRECTION = 0.99
LINE_CONTACT = 1e-5  #: rad: of a normal to the cross-section of a cylinder that touches along a line
#: cosine of the angle: least between the contact normal and that of a reference face; the separation along
#: the latter must also be at least the least gap minus `reach`
FACING = 0.7
FOOT_ERROR = 1e-15  #: distance from the origin of a surface: of a point found on it
#: distance from the origin of a surface: last step to a nearest point; the error after it is its square
FOOT_STEP = 1e-9
SIDE_REACH = 0.25  #: size of the smaller solid: gap up to which points on both sides of a hollow have names
ENTERED = 0.8  #: radius of curvature of a hollow: greater circles do not reach its bottom
PARALLEL = 0.9998  #: cosine of the angle: about 1 degree: greatest of the axes of a profile and its partner
#: cosine of the angle: .45: of the tangents of two rows at their starts, which turn by .2 at most; those that
#: have no two places that face each other have less
OPPOSED = 0.9
#: turn of a row: by which a tangent in it leaves those between both its ends at most, where it bends both ways
BOW = 0.5
ROW_END = 1e-9  #: length of a row: by which a place may be beyond its end, in the next row
NEARER = 0.3  #: depth of a place in another profile: it is on a far side if the curve of this is nearer
SAME_PLACE = 1e-8  #: size of the smaller profile: nearer points of two profiles are one
#: size of the smaller profile: depth up to which places of two profiles are found, and gap above the least
OVERLAP = 0.02
NEARLY_FLAT = 0.05  #: sine of the angle: of a side of a corner to a face, which may rest on both its ends
CHORD = 1.000001  #: arc of a curve: bound of its chord, with the error of the table by arc length
EDGE_GAIN = 1e-13  #: sum of the sizes: a gap across an edge, not a face, is greater by more than round-off
POLISH_STEP = 1e-18  #: 1: square of the last step of Newton's method to a normal: the error after it
CELL_SLACK = 1e-9  #: width of a cell: by which it is wider than the balls in it
REFERENCE_GAIN = 1e-9  #: cosine of the angle: a face is the reference unless the other is nearer by more
