"""A kernel that calls one of several functions, by a number that its arguments have."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from carom._compiled.decorators import kernel


def by_number(
    number: str,
    default: Callable,
    functions: Sequence[Callable | None],
    mark: Callable = kernel,
) -> Any:
    """Return the kernel with the parameters of `default` that calls ``functions[number]`` with its arguments.

    Parameters
    ----------
    number : str
        Python expression of the parameters. If it is one of them, the functions do not have it.
    default : callable
        Called for numbers without a function, for which `functions` has None. It is compiled as a kernel.
    functions : sequence
        Kernels or units.
    mark : callable
        Decorator of the result: `inlined` for small ones that each step calls often.
    """
    code = default.__code__
    parameters = code.co_varnames[: code.co_argcount]
    names, given = ", ".join(parameters), ", ".join(one for one in parameters if one != number)
    known: dict[str, Any] = {"otherwise": kernel(default)}
    lines = [f"def {default.__name__}({names}):"]
    first = next((k for k, function in enumerate(functions) if function is not None), 0)
    if first > 0:  # most are of the common form, and one comparison tells
        lines += [f"    if {number} < {first}:", f"        return otherwise({names})"]
    for k, function in enumerate(functions):
        if function is not None:
            known[f"of_{k}"] = function
            lines += [f"    if {number} == {k}:", f"        return of_{k}({given})"]
    lines.append(f"    return otherwise({names})")
    exec("\n".join(lines), known)
    made = known[default.__name__]
    made.__module__, made.__doc__ = default.__module__, default.__doc__
    return mark(made)
