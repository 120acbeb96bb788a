"""The methods of smooth motion: their coefficients, in the files named in `FILES`. NumPy only.

Each file has a dictionary `METHODS` from names, as in `carom.simulate`, to a `Definition`.
"""

from __future__ import annotations

from importlib import import_module

from carom.model.method import IMPLICIT, RUNGE_KUTTA, Definition, Method
from carom.options import Options

#: the registry: files of this folder. A new one comes last
FILES = ("kutta", "dormand_prince", "rattle", "implicit", "three_field")

METHODS: dict[str, Definition] = {}
for _file in FILES:
    METHODS |= import_module(f"{__name__}.{_file}").METHODS
EXPLICIT = tuple(name for name, one in METHODS.items() if one.kind == RUNGE_KUTTA)
#: methods with accelerations; the others use momenta of bodies, and do not allow inertia along joints
CARRIES = tuple(name for name, one in METHODS.items() if one.kind in (RUNGE_KUTTA, IMPLICIT))
ADAPTIVE = tuple(name for name, one in METHODS.items() if one.with_error is not None)


def make_method(name: str, options: Options, adapts: bool = False, kinks: bool = False) -> Method:
    """Return the coefficients of a method by its name; with error weights if it `adapts` its steps.

    `kinks` means that forces may have them.
    """
    one = METHODS[name]
    if adapts and kinks and one.with_kinks:
        return one.with_kinks()
    return one.with_error() if adapts and one.with_error else one.coefficients(options)
