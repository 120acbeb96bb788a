"""Thresholds of the model: masses that need more digits than a double has, and directions of curves."""

MASS_RATIO = 1e5  #: 1: ratio of masses from which on A M^-1 A^T loses too many digits (`light_bodies`)
LARGEST_MASS_RATIO = 1e24  #: 1: ratio of masses from which on even 31 digits are lost
DIRECTION = 1e-11  #: speed: error of the direction of a curve: slower approaches to a rail are round-off
#: greatest value of a law: jump of a derivative, times powers of the width of a piece, that is a kink
LAW_KINK = 1e-8
EQUAL_MOMENTS = 1e-13  #: greatest moment: a difference that is round-off: the moments are equal
LEAST_SPEED = 1e-60  #: m/s: nothing that is slower moves in any run; without gravity and motion no other scale
STILL_SPEED = 1e-14  #: speed of a fall by the size of the body, or of the start: that counts as zero
LAYER_WIDTH = 1e-5  #: size of the body: b of the boundary layer (`Options.layer_width`)
MOST_DEFLECTION = 0.1  #: size of the body: deflection for which bounds of its distance leave room
