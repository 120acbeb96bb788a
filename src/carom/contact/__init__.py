"""Unilateral constraints: gap functions, continuous collision detection, rims, stops in joints."""
