"""Thresholds of collision: directions, faces and the search for the shortest way out of an overlap."""

#: sine of the angle: edges with less have no common normal: it would be known to 1e-9
PARALLEL = 1e-7
#: rad: angle of two faces of which each can be the reference: cosines that differ by 1e-9
LEVEL_FACES = 4.5e-5
#: the product of the sizes of the solids: smaller products of two sides give no normal
CROSSING = 1e-6
#: the size of the smaller solid: such a distance has a direction exact to round-off
CLEARANCE = 1e-3
#: `CLEARANCE`: a smaller one gives no better direction, and to a smaller overlap no other way out is
#: shorter
LEAST_CLEARANCE = 1e-3
DEPTH_CLEARANCE = 30.0  #: the depth: clearance of the second phase of a climb
SAME_CLIMB = 0.95  #: cosine of the angle: starts nearer to an earlier climb are not tried
#: the distance: accuracy of the search for curved cores, which Newton's method then refines
CURVED_ACCURACY = 1e-6
FACE_NORMAL = 1e-5  #: 1 - cosine of the angle: up to which a normal may be that of a face
#: the tolerance of a surface: within which a point counts as on a face or on a rim
PLACE_TOLERANCE = 4.0
#: cosine of the angle: 8 degrees: two normals are of one feature, and Newton's method may turn a normal so
#: far
SAME_DIRECTION = 0.99
#: rad: greatest angle of a normal to the cross-section of a cylinder for which it touches along a line
LINE_CONTACT = 1e-5
#: cosine of the angle: least between the contact normal and that of a reference face; the separation along
#: the latter must also be at least the least gap minus `reach`
FACING = 0.7
