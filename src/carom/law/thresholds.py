"""Thresholds of laws."""

KINK_ERROR = 1e-8  #: speed of slip: a kink of its law is located to this part: its effect is the square
