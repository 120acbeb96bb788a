"""Compiled code: decorators, cache, records by reference, units. Knows Numba, and nothing of mechanics."""
