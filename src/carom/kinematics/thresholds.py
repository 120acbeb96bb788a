"""Thresholds of kinematics: the ends of curves, rails that can be left, axes normal to their surface."""

END_MARGIN = 1e-6  #: length of an open curve: beyond an end by less a stop there has not failed
HEIGHT = 1e-3  #: distance from the foot: weight of the height above a rail, where several branches are below
LEAST_ANGLE = 0.1  #: sine of the angle of axis and normal: below it anisotropy fades out
NEAR_RAIL = 1e-3  #: least radius of curvature: up to this distance a rail has the foot next to the last one
RAIL_TRAVEL = 0.3  #: least radius of curvature: way of a point near a rail in a trial step: it finds the rail
TURN_OF_STEP = 1.5  #: rad: of a joint in a trial step, by the rates at its ends: safely below half a turn
