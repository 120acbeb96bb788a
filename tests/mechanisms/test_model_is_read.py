"""A run only reads the tables of its model: what changes is in `Data` and in the memory of the relations."""

import re
from pathlib import Path

import numpy as np
import pytest
from mechanism_scenes import chain, four_bar
from test_on_curve import knot, on_wire, ring

import carom
from carom import forces
from carom.run import Run
from carom.stepping.settings import checked_settings

#: what a run writes: what it remembers, the factor and workspace of the constrained solve, and arguments and
#: results of functions of time
WRITTEN = "relations.memory.", "solver.", "moving.read", "moving.write"


def with_friction():
    scene = chain(4, axis=(0, 1, 0))
    law = carom.Friction(static=0.3, kinetic=0.2, speed=0.5)
    for joint in scene.joints:
        scene.add_force(forces.JointFriction(joint, law))
        scene.add_force(forces.JointSpring(joint, stiffness=3.0, damping=0.1))
    scene.add_force(forces.JointInertia(scene.joints[0], 0.02))
    scene.add_stop(scene.joints[0], upper=0.2, restitution=0.3)
    return scene


def loops_with_springs():
    scene = four_bar(2, 0.3)
    first, last = scene.bodies[0], scene.bodies[-1]
    scene.add_force(forces.Spring(40.0, first.position, last.position, damping=0.3), first, last)
    scene.add_force(forces.UserForce([first], lambda t, states: np.full((1, 6), 0.01 * t)))
    return scene


def bead():
    return on_wire(ring(knot), speed=1.0)[0]


def columns(part, name=""):
    """Yield the name and the bytes of each column of the arrays in nested named tuples."""
    if isinstance(part, tuple):
        for field in part._fields:
            yield from columns(getattr(part, field), f"{name}.{field}" if name else field)
    elif isinstance(part, np.ndarray) and part.dtype.names:
        for column in part.dtype.names:
            yield f"{name}.{column}", np.ascontiguousarray(part[column]).tobytes()
    elif isinstance(part, np.ndarray):
        yield name, part.tobytes()


@pytest.mark.parametrize("make", [with_friction, loops_with_springs, bead])
@pytest.mark.parametrize("method", ["rk4", "implicit"])
def test_a_run_reads_the_tables_of_its_model(make, method):
    run = Run(make(), checked_settings(0.2, step=0.01, method=method))
    before = dict(columns(run.compiled.system))
    run.go_on(run.steps)
    changed = {name for name, data in columns(run.compiled.system) if data != before[name]}
    assert changed
    assert not {name for name in changed if not name.startswith(WRITTEN)}


def test_the_page_of_arrays_names_all_of_them():
    page = (Path(__file__).parents[2] / "docs" / "development" / "arrays.md").read_text()
    named = set(re.findall(r"\w+", " ".join(re.findall(r"`([^`]+)`", page))))
    run = Run(bead(), checked_settings(0.2, step=0.01))
    parts = (
        run.compiled.system,
        run.compiled.system.relations,
        run.compiled.system.relations.memory,
        run.data,
        run.data.active,
        run.data.work,
    )
    assert {field for part in parts for field in part._fields} - named == {"there", "counted"}
