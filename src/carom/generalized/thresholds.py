"""Thresholds of systems in coordinates of the user's own."""

ARC_ERROR = 1e-13  #: size of a coordinate: error of the steps along an autoparallel
RETURN_ERROR = 1e-11  #: greatest coordinate: residual of a return map, beyond the round-off of its arc
RETURN_GOAL = 1e-14  #: greatest coordinate: residual at which its iteration ends
SYMMETRY = 1e-12  #: greatest entry of the metric: its asymmetry by round-off
INSIDE = 1e-9  #: sizes of the terms: depth of a contact at the start that is round-off
ZERO_EXPRESSION = 1e-9  #: 1: value of an expression at some points, which is then zero
