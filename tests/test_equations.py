"""The equations of the paper are computed by what a run calls, and their numbers are cited there.

The calls are followed from the loop of a run, over kernels and units. Equations (2) and (3) are not among
them: the text that we have cites (1) and (4) to (10).
"""

import importlib
import types

import pytest
from numba.core import config

#: equation: functions by module
EQUATIONS = {
    "Eq. (1)": ["dynamics.solve.free_body"],
    "Eqs. (4)-(7)": [f"dynamics.three_field.{f}" for f in ("momenta", "velocity_block", "position_block")],
    "Eq. (8)": ["impact.spline.force"],
    "Eq. (9)": ["impact.spline.solve_slip"],
    "Eq. (10)": ["impact.return_map.return_map"],
}  # fmt: skip


def plain(value):
    """The Python function behind a kernel or a unit; None for anything else."""
    value = getattr(value, "compiled", value)
    value = getattr(value, "py_func", value)
    ours = isinstance(value, types.FunctionType) and value.__module__.startswith("carom")
    return value if ours else None


def called_by_a_run() -> set[str]:
    """Names of all functions that the loop of a run can reach."""
    from carom.stepping import time_loop

    seen, waiting = {}, [plain(time_loop.run)]
    while waiting:
        function = waiting.pop()
        seen[f"{function.__module__}.{function.__qualname__}"] = function
        names = function.__code__.co_names
        for name in names:
            value = function.__globals__.get(name)
            parts = (
                [vars(value)[n] for n in names if n in vars(value)]
                if isinstance(value, types.ModuleType)
                else [value]
            )
            for inner in map(plain, parts):
                if inner is not None and f"{inner.__module__}.{inner.__qualname__}" not in seen:
                    waiting.append(inner)
    return set(seen)


@pytest.mark.skipif(bool(config.DISABLE_JIT), reason="units are plain functions")
def test_a_run_reaches_the_equations_of_the_paper():
    reached = called_by_a_run()
    assert len(reached) > 500
    for names in EQUATIONS.values():
        assert {f"carom.{name}" for name in names} <= reached


@pytest.mark.parametrize("number", EQUATIONS)
def test_the_equation_is_cited_where_it_is_computed(number):
    for name in EQUATIONS[number]:
        module, function = name.rsplit(".", 1)
        computes = plain(getattr(importlib.import_module(f"carom.{module}"), function))
        assert number in computes.__doc__
