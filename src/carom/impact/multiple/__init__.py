"""Impacts at a corner of the manifold: several contacts closed while one or more of them strike."""
