"""Thresholds of kinematics: the ends of curves."""

END_MARGIN = 1e-6  #: length of an open curve: beyond an end by less a stop there has not failed
