"""Named tuples of the library are handed on by reference."""

import numba
import numpy as np
import pytest

from carom._compiled.by_reference import Reference, type_of
from carom._compiled.decorators import by_reference, entry, kernel
from carom._compiled.units import unit
from carom.collision.layout import Hulls, no_hulls


def hulls(n):
    """`n` vertices, numbered in their x and in `corners`."""
    vertices = np.zeros((n, 3))
    vertices[:, 0] = np.arange(n)
    return no_hulls()._replace(vertices=vertices, corners=np.arange(n))


@kernel
def total(h):
    s = 0.0
    for i in range(h.vertices.shape[0]):
        s += h.vertices[i, 0] + h.corners[i]
    return s


@unit
def total_unit(h, out):
    out[0] = total(h)


@entry
def of_parts(h, out, each):
    """Write twice the sum of each vertex alone, found directly and through a unit; return that of all."""
    for i in range(each.shape[0]):
        p, k = h.vertices[i : i + 1], h.corners[i : i + 1]
        part = by_reference(
            Hulls(p, h.faces, k, h.starts, h.candidates, h.surfaces, h.numbers, h.outlines)
        )
        each[i] = total(part)
        total_unit(
            Hulls(p, h.faces, k, h.starts, h.candidates, h.surfaces, h.numbers, h.outlines), out
        )
        each[i] += out[0]
    return total(h)


@pytest.mark.plain
def test_what_is_put_together_in_a_loop_is_what_is_read():
    """Loads are marked invariant: those of one turn must not be those of the turn before."""
    h, out, each = hulls(7), np.zeros(1), np.zeros(7)
    assert of_parts(h, out, each) == 42.0
    np.testing.assert_array_equal(each, 4.0 * np.arange(7))


@pytest.mark.plain
def test_a_change_of_arrays_is_seen():
    """What is invariant is where the arrays are, not what is in them."""
    h, out, each = hulls(3), np.zeros(1), np.zeros(3)
    assert of_parts(h, out, each) == 6.0
    h.vertices[:, 0] += 1.0
    assert of_parts(h, out, each) == 9.0
    other = h._replace(vertices=h.vertices[:2])
    assert of_parts(other, out, each[:2]) == 1.0 + 3.0


def test_types():
    """Ours by reference; tuples and the named tuples of others by value, as Numba has it."""
    made = type_of(hulls(2))
    assert isinstance(made, Reference)
    assert made.fields == Hulls._fields
    assert type_of(hulls(5)) == made
    assert isinstance(type_of((1, 2.0)), numba.types.Tuple)
    assert isinstance(type_of(np.linalg.slogdet(np.eye(2))), numba.types.BaseNamedTuple)


@pytest.mark.skipif(not hasattr(of_parts, "overloads"), reason="nothing is compiled")
def test_names_are_short():
    h, out = hulls(2), np.zeros(1)
    of_parts(h, out, np.zeros(2))
    (compiled,) = of_parts.dispatcher.overloads.values()
    assert len(compiled.fndesc.mangled_name) < 300
