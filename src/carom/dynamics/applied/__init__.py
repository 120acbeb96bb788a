"""The kinds of forces on bodies, one file for each, of the name of its table (`carom.scene.forces`).

A kind defines, for a row of its table,

- `add(system, row, state, power, work)`: it adds its wrenches, and returns `power` with the power of its part
  without potential, then its value along a coordinate or a line, the length of the line and its rate, NaN for
  what it does not have;
- `acts_at(system, row, state)`: the arm, from the centre of its first body, to the point where it acts;
- `energy(system, row, state, t)`, if it has a potential;
- `unit_force(system, row, n, state, work)`, if it has a stiffness: it adds the wrenches of its unit force n,
  and returns the coordinate and its rate where it acts along one.

Each step adds all of them; reports (`carom.dynamics.reports`) add one at a time.
"""

from __future__ import annotations

import math
from importlib import import_module
from inspect import signature
from typing import Any

from carom._compiled.by_number import by_number
from carom._compiled.decorators import inlined
from carom.model.forces import Forces
from carom.scene.forces import TABLES

_FILES = {kind.name: import_module(f"{__name__}.{kind.name}") for kind in TABLES}
#: kinds of every scene, and those that are a unit of their own, which only scenes with relations load
BETWEEN_BODIES, OF_RELATIONS = (
    tuple(kind.name for kind in TABLES if kind.apart == apart) for apart in (False, True)
)


def _written(lines: list[str], known: dict[str, Any]) -> Any:
    """Return the kernel `made` of lines of Python with the names that they use."""
    exec("\n".join(lines), known)
    made = known["made"]
    made.__module__ = __name__
    return inlined(made)


def _each(kinds: tuple[str, ...], name: str, given: str, line: str, total: str) -> Any:
    """Return the kernel that does a `line` for each row of some kinds, with the function of this name."""
    own = {kind: getattr(_FILES[kind], name) for kind in kinds if hasattr(_FILES[kind], name)}
    lines = [f"def made({given}):"]
    for kind in own:
        lines += [
            f"    rows_{kind} = system.forces.{kind}",
            f"    for i in range(rows_{kind}.shape[0]):",
            f"        {line.format(of=f'of_{kind}', row=f'rows_{kind}[i]')}",
        ]
    named = {f"of_{kind}": function for kind, function in own.items()}
    return _written([*lines, f"    return {total}"], named)


def _parts():
    """Return the kernel that makes tables of parts of all tables, whose ranges are rows of `ends`."""
    tables = [f"forces.{kind}[ends[{k}, 0] : ends[{k}, 1]]" for k, kind in enumerate(_FILES)]
    return _written(
        ["def made(forces, ends):", f"    return Forces({', '.join(tables)})"], {"Forces": Forces}
    )


part_forces = _parts()


def added(kinds):
    """Return the kernel that adds all forces of some kinds, and their power to that which is given."""
    line = "power, _, _, _ = {of}(system, {row}, state, power, work)"
    return _each(kinds, "add", "system, state, power, work", line, "power")


def energies(kinds):
    """Return the kernel that adds the energies of all forces of some kinds to that which is given."""
    line = "total += {of}(system, {row}, state, t)"
    return _each(kinds, "energy", "system, state, t, total", line, "total")


def _of_number(kind: str, common) -> Any:
    """Return the kernel that takes the number of a force where that of its kind takes the row, or None."""
    own = getattr(_FILES[kind], common.__name__, None)
    if own is None:
        return None
    given = ", ".join(name for name in signature(common).parameters if name != "kind")
    taken = given.replace("system, i", f"system, system.forces.{kind}[i]")
    return _written([f"def made({given}):", f"    return own({taken})"], {"own": own})


def _by_kind(common):
    """Return the kernel that calls the function of this name of a force, by the number of its kind."""
    own = [_of_number(kind, common) for kind in _FILES]
    return by_number("kind", common, own)


@_by_kind
def add(kind, system, i, state, power, work):
    """Add the wrenches of force i of a kind; return as the kinds do."""
    return power, math.nan, math.nan, math.nan


@_by_kind
def acts_at(kind, system, i, state):
    """Return the arm to where force i of a kind acts."""
    return 0.0, 0.0, 0.0


@_by_kind
def unit_force(kind, system, i, n, state, work):
    """Add unit force n of force i of a kind; return the coordinate and its rate, if it is along one."""
    return 0.0, 0.0
