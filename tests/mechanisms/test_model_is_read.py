"""Which columns of the compiled scene a run changes: all else that changes is in `Data`.

The list is to get shorter, not longer.
"""

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

#: columns of tables that change in a run, or whole arrays: state that steps go on from, and workspace
CHANGES = {
    "relations.coordinates.reference", "relations.coordinates.begun",  # whole turns, feet on curves
    *(f"relations.frictions.{name}" for name in (
        "next", "mode", "grip", "left", "began", "kink", "speed", "force", "stop", "first_stop",
    )),
    "relations.stiff.speed", "relations.stiff.gain", "relations.rotors.rate",
    *(f"relations.curves.{name}" for name in (
        "x", "slope", "second", "s", "along", "normal", "gap", "bend", "ahead",
    )),
    "relations.read", "relations.write", "moving.read", "moving.write",
}  # fmt: skip


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
def test_a_run_changes_these_columns_of_its_model_only(make, method):
    run = Run(make(), checked_settings(0.2, step=0.01, method=method))
    before = dict(columns(run.compiled.system))
    run.go_on(run.steps)
    changed = {name for name, data in columns(run.compiled.system) if data != before[name]}
    # the factor and the workspace of the constrained solve are its own
    assert {name for name in changed if not name.startswith("solver.")} <= CHANGES
    assert changed


def test_the_page_of_arrays_names_all_of_them():
    page = (Path(__file__).parents[2] / "docs" / "development" / "arrays.md").read_text()
    named = set(re.findall(r"\w+", " ".join(re.findall(r"`([^`]+)`", page))))
    run = Run(bead(), checked_settings(0.2, step=0.01))
    parts = (
        run.compiled.system,
        run.compiled.system.relations,
        run.data,
        run.data.active,
        run.data.work,
    )
    assert {field for part in parts for field in part._fields} - named == {"there", "counted"}
