"""With a Numba whose inner parts are not those that we know, everything runs uncompiled, and says so."""

import subprocess
import sys
from functools import cache

import pytest

DIE = """
import sys, warnings
{hide}
warnings.simplefilter("always")
import carom
from carom._compiled.decorators import COMPILES
scene = carom.Scene()
ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
die = scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.03),
                     velocity=(0.5, 0, -0.5), angular_velocity=(10, 10, 0))
scene.add_contact(die, ground, restitution=0.5, friction=0.2)
run = carom.simulate(scene, 0.05, step=5e-3)
print(COMPILES, run.status.name, len(run.impacts), *[float(v).hex() for v in run.velocity[-1].ravel()])
"""
# a private name that has moved, and a module that has
MISSING = {
    "name": "from numba.core import dispatcher; del dispatcher._FunctionCompiler",
    "module": "import numba; sys.modules['numba.core.target_extension'] = None",
}


@cache  # as it is with what is known, for all
def told(hide: str) -> tuple[list[str], str]:
    """Throw a die in a process of its own; return what it printed, and what it was warned of."""
    done = subprocess.run(
        [sys.executable, "-c", DIE.format(hide=hide)], capture_output=True, text=True, check=True
    )
    return done.stdout.split(), done.stderr


@pytest.mark.parametrize("missing", MISSING)
def test_a_die_is_thrown_uncompiled_and_says_so(missing):
    (compiles, *result), warned = told(MISSING[missing])
    assert compiles == "False"
    assert "does not know Numba" in warned
    assert "install numba>=" in warned
    (_, *known), quiet = told("")
    assert "does not know" not in quiet
    assert result[:2] == known[:2]
    numbers = [[float.fromhex(v) for v in velocities[2:]] for velocities in (result, known)]
    # an optimiser may fuse a product and a sum: 1e-16 a step, and a handful of impacts
    assert numbers[0] == pytest.approx(numbers[1], rel=1e-9, abs=1e-12)
