"""Thresholds of kinematics: the ends of curves."""

END_MARGIN = 1e-6  #: length of an open curve: beyond an end by less a stop there has not failed
NEAR_RAIL = 1e-3  #: least radius of curvature: up to this distance a rail has the foot next to the last one
