"""The stamp of cached code changes with all that is linked into it, and with nothing else."""

import types

import pytest

from carom._compiled.cache_key import stamp

LEAF = """
def leaf(x):
    {doc}
    return {factor} * x + SHIFT

def caller(x):
    return leaf(x) + module.deep(x) + chosen(x) + reached(x)
"""


def made(factor="2.0", shift=1.0, doc="''", deep="x", option="x + 1.0", unit="x"):
    """Return a function that calls another, one of a module, and one chosen by a type."""
    module = types.ModuleType("carom.made")
    exec(f"def deep(x):\n    return {deep}", vars(module))
    space = {"SHIFT": shift, "module": module, "__name__": "made"}
    exec(LEAF.format(factor=factor, doc=doc), space)
    space["leaf"].__module__ = "made"
    exec(f"def option(x):\n    return {option}\ndef reached(x):\n    return {unit}", space)
    space["chosen"] = types.SimpleNamespace(parts=(space["option"],))
    space["reached"] = types.SimpleNamespace(is_unit=True, compiled=space["reached"])
    for name in ("leaf", "deep"):
        where = vars(module) if name == "deep" else space
        where[name] = types.SimpleNamespace(py_func=where[name])
    return space["caller"]


def test_same_code_same_stamp():
    assert stamp(made()) == stamp(made()) == stamp(made(doc="'Other words.'"))


@pytest.mark.parametrize(
    "change",
    [{"factor": "3.0"}, {"shift": 2.0}, {"deep": "x * x"}, {"option": "x - 1.0"}],
    ids=["callee", "constant", "module", "choice"],
)
def test_change_of_a_part_changes_the_stamp(change):
    assert stamp(made(**change)) != stamp(made())


def test_what_is_known_of_functions_gives_the_same_stamp():
    """Also of a function that was reached before from another one."""
    caller, known = made(), {}
    leaf = caller.__globals__["leaf"].py_func
    assert stamp(caller, known) == stamp(caller, known) == stamp(caller)
    assert len(known) == 4
    assert stamp(leaf, known) == stamp(leaf) != stamp(caller)


def test_a_unit_is_left_out():
    assert stamp(made(unit="2.0 * x")) == stamp(made())


def test_the_whole_loop_is_reached():
    """A unit and what it calls, over several files."""
    from carom._compiled import cache_key
    from carom.persistent.contact_step import contact_step

    if not hasattr(contact_step, "compiled"):
        pytest.skip("not compiled: there is no cache")
    reached = cache_key.reached(contact_step.compiled.py_func, {})
    names = [f"{one.__module__}.{one.__qualname__}" for one in reached]
    for name in (
        "persistent.members.implicit_member",
        "dynamics.delassus.velocities",
        "friction.solve.solve_cones",
    ):
        assert f"carom.{name}" in names
