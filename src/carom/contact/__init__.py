"""Unilateral constraints: gap, exclusion of contact between two states, return map."""
