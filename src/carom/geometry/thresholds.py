"""Thresholds of geometry, and those of round-off that all rooms share."""

EPSILON = 2.220446049250313e-16  #: number: the distance of a double from the next one
LAST_DIGIT = 1e-15  #: greater term: error of a few operations
SUM_ERROR = 50.0 * EPSILON  #: sum of the sizes of the terms: error of a sum of some tens of products
#: size of the terms: smaller differences count as zero: errors are about 1e-15, so larger ones are known
#: to a part in a thousand. A cosine so near to 1 is that of equal directions
ROUND_OFF = 1e-12
#: size of the body, of a pair the smaller: shorter distances have no reliable direction, smaller radii of
#: curvature are corners, and smaller errors of position do not matter
RESOLUTION = 1e-9
REMAINDER = 1e-9  #: whole: a smaller part is none: of a speed of approach (`SEED`), of slip, of a change
SMALLEST = 1e-300  #: number: a divisor that may be zero
UNIT_ERROR = 1e-3  #: 1: error of the length of a given quaternion, or of a unit vector times a matrix
#: rad: rotation h |Wbar| above which the chart moves along: log is one-to-one below pi, and the true
#: rotation may differ from the predicted one
CHART_ANGLE = 2.0
LAST_UNITS = 4e-16  #: value: two units in its last place: an iteration that changes it by less has ended
NO_CHANGE = 1e-16  #: value, or whole: less than a unit in its last place: the same where rounding is known
HALF_DIGITS = 1e-8  #: greater of two numbers: a difference, or a sine, whose square is round-off
CARLSON_RANGE = 0.004  #: mean of three numbers: difference whose seventh power is round-off (DLMF 19.36.1)
MATRIX_ERROR = 1e-6  #: 1: error of a given matrix, by which it is no rotation
