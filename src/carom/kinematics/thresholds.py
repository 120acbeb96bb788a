"""Thresholds of kinematics: the ends of curves, rails that can be left, and grains normal to their surface."""

END_MARGIN = 1e-6  #: length of an open curve: beyond an end by less a stop there has not failed
LEAST_GRAIN = 0.1  #: sine of the angle of grain and normal: below it anisotropy fades out
NEAR_RAIL = 1e-3  #: least radius of curvature: up to this distance a rail has the foot next to the last one
