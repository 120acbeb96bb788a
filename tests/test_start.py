"""The first simulate of a process that finds everything on disk: what it imports, makes and compiles."""

import json
import subprocess
import sys
from functools import cache

import pytest
from numba.core import config

pytestmark = pytest.mark.skipif(bool(config.DISABLE_JIT), reason="nothing is compiled")

COUNTED = """
import builtins, gc, json, sys
counts = dict.fromkeys(("compile", "exec"), 0)
def counted(name, real):
    def call(source, *rest, **more):
        counts[name] += isinstance(source, str)
        return real(source, *rest, **more)
    return call
for name in counts:
    setattr(builtins, name, counted(name, getattr(builtins, name)))
import carom
{scene}
assert carom.simulate(scene, 2.0).success
from carom._compiled.target import Dispatcher, Kernel
from carom._compiled.units import UNITS
everything = gc.get_objects()
counts["dispatchers"] = sum(type(one) is Dispatcher for one in everything)
counts["kernels"] = sum(isinstance(one, Kernel) for one in everything)
counts["loaded"] = sum(len(one.loaded) for one in UNITS.values())
counts["compiled"] = [name for name, one in UNITS.items() if "compiled" in vars(one)]
counts["modules"] = sorted(sys.modules)
print(json.dumps(counts))
"""
SCENES = {
    "die": """
scene = carom.Scene()
scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1))
scene.set_contact_default(restitution=0.5, friction=0.3)
scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.01, position=(0, 0, 0.3), angular_velocity=(3, 5, 7))
""",
    "pendulum": """
scene = carom.Scene()
rod = scene.add_body(carom.Box(1, 0.02, 0.02), mass=1, position=(0.5, 0, 0))
scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, rod)
""",
}
#: what no first run needs; numpy.ma and scipy.linalg come with parts of Numba that compile
NOT_NEEDED = (
    "IPython", "matplotlib", "mujoco", "multiprocessing.pool", "numpy.ma", "pandas", "scipy.integrate",
    "scipy.interpolate", "scipy.linalg", "scipy.optimize", "scipy.sparse", "scipy.spatial", "scipy.special",
    "sympy", "xarray",
)  # fmt: skip


@cache
def counts(scene):
    """What a process counts; one before it has compiled what it needs."""
    code = COUNTED.format(scene=SCENES[scene])
    for _ in range(2):
        told = subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True
        )
    return json.loads(told.stdout)


@pytest.mark.parametrize("scene", SCENES)
def test_nothing_is_made_for_the_compiler(scene):
    """Dispatchers are those of the entries that were called: of the loop, and of saving."""
    seen = counts(scene)
    assert seen["compiled"] == []
    assert 1 <= seen["dispatchers"] <= 6
    assert seen["kernels"] > 1000
    assert seen["loaded"] >= (10 if scene == "die" else 1)


@pytest.mark.parametrize("scene", SCENES)
def test_no_more_modules_than_needed(scene):
    """Now 990, of which 480 are carom's, 150 Numba's and 110 NumPy's; a tenth is left to grow."""
    modules = counts(scene)["modules"]
    assert sorted(set(modules) & set(NOT_NEEDED)) == []
    assert sum(name.partition(".")[0] == "carom" for name in modules) < 530
    assert len(modules) < 1100


@pytest.mark.parametrize("scene", SCENES)
def test_few_sources_are_compiled_by_python(scene):
    """Now 760, annotations of fields of named tuples; and 640, methods of dataclasses and choices by number."""
    seen = counts(scene)
    assert seen["compile"] < 900
    assert seen["exec"] < 750
