"""Vectors as three numbers each, in kernels."""

from __future__ import annotations

from carom._compiled.decorators import inlined


@inlined
def dot(a, b):
    """Return a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def cross(a, b):
    """Return a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inlined
def minus(a, b):
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@inlined
def plus(a, f, b):
    """Return a + f b."""
    return a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]
