"""Compiled code: decorators, cache, records by reference, units. This folder has no mechanics."""
