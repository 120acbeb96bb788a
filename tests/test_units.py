"""Units are compiled when compiled code first calls them, once for each type of arguments."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest
from numba.core import config

from carom._compiled.decorators import entry, inlined, kernel
from carom._compiled.units import UNITS, Entries, unit

compiled = pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")


@unit
def twice(x, out):
    out[0] = 2.0 * x


@unit
def norm(x, y) -> float:
    return math.sqrt(x * x + y * y)


@unit
def broken(x, out):
    out[0] = x.there_is_no_such_thing


@inlined
def is_long(out):
    return out.shape[0] > 2


@unit(where=is_long)
def add(out, x):
    """Add a number to the last element."""
    out[2] += x


@unit(where=is_long, otherwise=(-1, 0.5))
def last(out) -> tuple[int, float]:
    return out.shape[0] - 1, out[2]


@entry
def of_long(out, x):
    add(out, x)
    return last(out)


@kernel
def both(x, out):
    twice(x, out)
    twice(out[0], out)
    return norm(3.0 * x, out[0])


@entry
def of_units(x, out):
    return both(x, out)


@entry
def sometimes(x, out):
    if x > 0.0:
        broken(out, out)
    return x


@pytest.mark.plain
def test_a_unit_is_called_like_a_kernel():
    out = np.zeros(1)
    assert of_units(1.0, out) == 5.0
    assert out[0] == 4.0


@pytest.mark.plain
def test_a_unit_is_called_only_where_its_condition_holds():
    made = {name: UNITS[f"test_units:{name}"] for name in ("add", "last")} if UNITS else {}
    assert add.__doc__ == "Add a number to the last element."
    assert of_long(np.zeros(2), 4.0) == (-1, 0.5)
    assert not any(one.loaded for one in made.values())
    assert of_long(np.zeros(3), 4.0) == (2, 4.0)
    assert all(len(one.loaded) == 1 for one in made.values())


@compiled
def test_each_is_compiled_once():
    of_units(1.0, np.zeros(1))
    for made in (twice, norm):
        assert len(made.loaded) == 1
    assert UNITS["test_units:twice"] is twice


SHARED = """
import numba
from carom._compiled.decorators import entry, kernel

print(numba.njit(lambda x, y: max(x, y) + int(x))(1.5, 2.0))  # the first to ask for max
first, second = kernel(lambda x, y: max(x, y) + int(x)), kernel(lambda x, y: max(x, y) - int(x))
print(entry(lambda x, y: first(x, y))(1.5, 2.0))
print(numba.njit(lambda x, y: max(y, x) + int(y))(1.5, 2.0))
print(entry(lambda x, y: second(x, y))(1.5, 2.0))
"""


@compiled
def test_others_and_we_may_share_what_numba_writes_as_overloads():
    """Numba keeps one implementation of ``max`` for all targets: that of the last one that asked."""
    told = subprocess.run(
        [sys.executable, "-c", SHARED], capture_output=True, text=True, check=True
    )
    assert told.stdout.split() == ["3.0", "3.0", "4.0", "1.0"]


@compiled
def test_what_is_not_called_is_not_compiled():
    call, out = Entries(()), np.zeros(1)
    assert call(sometimes, -1.0, out) == -1.0
    assert not broken.loaded


@compiled
def test_what_stops_a_compile_is_raised():
    call, out = Entries(()), np.zeros(1)
    with pytest.raises(Exception, match="there_is_no_such_thing"):
        call(sometimes, 1.0, out)
    assert of_units(1.0, out) == 5.0  # others go on


@compiled
def test_an_interrupt_while_a_unit_is_compiled_is_raised(monkeypatch):
    def interrupted(*arguments):
        raise KeyboardInterrupt

    call, out = Entries(()), np.zeros(1)
    monkeypatch.setattr(broken, "address", interrupted)
    with pytest.raises(KeyboardInterrupt):
        call(sometimes, 2.0, out)


@compiled
def test_each_unit_has_one_type_for_all_scenes_and_methods():
    """Compiles are functions: nothing is compiled anew for another kind of scene, or another method."""
    import carom
    from carom.cli import warmup
    from carom.stepping import time_loop

    for scene in warmup.scenes().values():
        for method in ("rk4", "rk8", "rattle", "implicit", "paper", "paper-ode"):
            carom.simulate(scene, 0.01, step=5e-3, method=method, throw=False)
        carom.simulate(scene, 0.01, step="auto", throw=False)
    for scene, _ in warmup.contact_scenes().values():
        carom.simulate(scene, 0.02, step=5e-3, throw=False)
    scene = carom.Scene()
    rod = scene.add_body(carom.Box(1, 0.02, 0.02), mass=1, position=(0.5, 0, 0))
    scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, rod, name="hinge")
    scene.add_force(carom.forces.JointSpring("hinge", stiffness=1.0))
    run = carom.Run(scene)
    run.advance(0.05)
    for seen in (run.state, run.solution, carom.simulate(scene, 0.05)):
        assert np.shape(seen.joint_reactions)[-1] == 6
    seen.evaluate(0.02)
    assert len(time_loop.run.dispatcher.overloads) == 1
    ours = {name: made for name, made in UNITS.items() if name.startswith("carom.")}
    assert [name for name, made in ours.items() if len(made.loaded) > 1] == []


STOPPED = """
import carom, numpy as np
from carom.persistent.activation import activate_contact

scene = carom.Scene()
ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.15))
scene.add_contact(ball, ground, restitution=0.3, friction=0.2)

def stopped(digest, packed):
    del activate_contact.address
    raise KeyboardInterrupt
activate_contact.address = stopped

part = carom.simulate(scene, 0.3, step=1e-2, throw=False)
whole = carom.simulate(scene, 0.3, step=1e-2)
n = len(part.t)
print(part.status.name, 1 < n < len(whole.t), np.array_equal(part.position, whole.position[:n]))
"""


@compiled
def test_a_run_that_is_interrupted_while_a_unit_is_compiled_keeps_its_steps():
    """Ctrl-C while what holds a contact is compiled: the steps so far, and the next run goes to its end."""
    told = subprocess.run(
        [sys.executable, "-c", STOPPED], capture_output=True, text=True, check=True
    )
    assert told.stdout.split() == ["INTERRUPTED", "True", "True"]
