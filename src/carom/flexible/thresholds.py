"""Thresholds of modal data."""

RIGID = 1e-9  #: square of the highest frequency: below 0 by this, the shift that finds the lowest ones
APART = 100.0  #: squares of the frequencies of rigid motions by round-off: those of modes are above
FLAT = 1e-9  #: greatest extent of places: what lies in a plane, between which is no space to interpolate in
SYMMETRIC = 1e-8  #: largest entry of a matrix: difference from its transpose, or force of a rigid motion
TAIL = 1e-10  #: square of the size of a shape of a plate: part of the highest degrees of its polynomials
LIGHTEST = 1e-6  #: kg/m^3: least density, far below all that there are
SOFTEST = 1e-3  #: Pa: least modulus, far below all that there are
SHAPE_ERROR = 1e-6  #: greatest displacement by a mode: error of its splines
