"""Thresholds of geometry, and those of round-off that all rooms share."""

EPSILON = 2.220446049250313e-16  #: the number: the distance of a double from the next one
LAST_DIGIT = 1e-15  #: the greater term: error of a few operations
#: the sum of the sizes of the terms: error of a sum of some tens of products
SUM_ERROR = 50.0 * EPSILON
#: the size of the terms: a smaller difference of computed numbers counts as zero: their errors are about
#: 1e-15, so a larger one is known to a part in a thousand. For cosines: so near to 1 a direction is that
#: of the plane
ROUND_OFF = 1e-12
#: the size of the body (the smaller one of a pair): shorter distances have no reliable direction, shorter
#: radii of curvature are corners, and smaller errors of position need no correction
RESOLUTION = 1e-9
SMALLEST = 1e-300  #: the number: a divisor that may be zero
#: 1: largest error of the length of a quaternion, or of a unit vector times a matrix, that counts as
#: rounding in the input
UNIT_ERROR = 1e-3
#: rad: rotation h |Wbar| above which the chart moves along: log is one-to-one below pi, and the true
#: rotation may differ from the predicted one
CHART_ANGLE = 2.0
