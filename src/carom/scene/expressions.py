"""Expressions of SymPy: checked, and written as code for Numba. SymPy is imported here and in `symbolic.py`."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Any

import numpy as np

from carom import checks


def of(name: str, given) -> Any:
    """Return an expression; raise an error for texts, which SymPy would evaluate, and other objects."""
    import sympy as sp

    result: Any = None
    with suppress(Exception):  # of any kind, in the conversion of a foreign object
        result = sp.sympify(given, strict=True)
    infinite = (sp.nan, sp.zoo, sp.oo, -sp.oo)
    good = isinstance(result, sp.Expr) and not result.has(*infinite)
    if isinstance(given, np.ndarray) or not good:
        raise ValueError(f"{name} must be a SymPy expression, got {checks.shown(given)}")
    return result


def written(name: str, terms: list, x: list, t: Any) -> Any:
    """Return ``name(t, x, out)``, which writes terms in symbols x and t; common parts are computed once."""
    import sympy as sp
    from sympy.printing.codeprinter import PrintMethodNotImplementedError
    from sympy.printing.pycode import PythonCodePrinter

    printer = PythonCodePrinter({"fully_qualified_modules": False})
    *own, time = sp.symbols(f"x:{len(x)} t", real=True)
    exchange = dict(zip([*x, t], [*own, time]))
    terms = [sp.sympify(term).xreplace(exchange) for term in terms]
    shared, short = sp.cse(terms, symbols=sp.numbered_symbols("s"), order="none")
    used = set().union(*(e.free_symbols for e in [*short, *(e for _, e in shared)]))
    lines = [f"def {name}(t, x, out):"]
    lines += [f"    x{i} = x[{i}]" for i in range(len(x)) if own[i] in used]
    try:
        lines += [f"    {symbol} = {printer.doprint(e)}" for symbol, e in shared]
        lines += [f"    out[{i}] = {printer.doprint(e)}" for i, e in enumerate(short)]
    except PrintMethodNotImplementedError as error:
        raise ValueError(
            f"an expression has a function that cannot be compiled, or whose derivative cannot: {error}"
        ) from None
    space: dict[str, Any] = {"math": math, **vars(math)}
    exec("\n".join(lines), space)
    return space[name]
