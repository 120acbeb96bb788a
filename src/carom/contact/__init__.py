"""Unilateral constraints: gap, exclusion and location of contact, return map, strike."""
