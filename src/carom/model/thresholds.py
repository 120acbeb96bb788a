"""Thresholds of the model: masses that need more digits than a double has, and directions of curves."""

MASS_RATIO = 1e5  #: 1: ratio of masses from which on A M^-1 A^T loses too many digits (`light_bodies`)
LARGEST_MASS_RATIO = 1e24  #: 1: ratio of masses from which on even 31 digits are lost
DIRECTION = 1e-11  #: speed: error of the direction of a curve: slower approaches to a rail are round-off
#: greatest value of a law: jump of a derivative, times powers of the width of a piece, that is a kink
LAW_KINK = 1e-8
