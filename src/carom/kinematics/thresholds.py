"""Thresholds of kinematics: the ends of curves, and grains normal to their surface."""

END_MARGIN = 1e-6  #: length of an open curve: beyond an end by less a stop there has not failed
LEAST_GRAIN = 0.1  #: sine of the angle of grain and normal: below it anisotropy fades out
