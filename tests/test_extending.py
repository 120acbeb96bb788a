"""What the page on extending says is true: its files and lines, added to a copy of the library, run."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import carom

LIBRARY = Path(carom.__file__).parent
PAGE = Path(__file__).parents[1] / "docs" / "development" / "extending.md"

#: without the JIT, so nothing is compiled: a method, a joint, a shape, a force, a ground, a limit, two laws
RUN = """
import numpy as np, carom

scene = carom.Scene(gravity=(1.0, 0.0, -9.81))
plate = scene.add_body(carom.Box(0.2, 0.2, 0.1), mass=2.0)
table = scene.add_joint(carom.joints.Table((0, 0, 1)), carom.GROUND, plate)
s = carom.simulate(scene, 0.1, step=0.05, method="three-eighths")
assert np.allclose(s.position[-1, 0], (0.005, 0, 0), rtol=0, atol=1e-14)  # g t^2/2 along the plane
assert s.joint_coordinates(table)[0].shape == (3, 2)

scene = carom.Scene()
body = scene.add_body(carom.Dumbbell(0.4, 0.1), mass=1.0, position=(0, 0, 0.31), velocity=(0, 0, -1.0))
ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
scene.add_contact(body, ground, restitution=0.25, impact_law="fraction")
s = carom.simulate(scene, 0.02, step=0.01)
before, after = s.impacts[0].relative_velocity_before[0], s.impacts[0].relative_velocity_after[0]
assert abs(after + 0.5 * before) < 1e-12  # a quarter of the energy
assert s.impacts[0].law == "fraction"

scene = carom.Scene(gravity=(0, 0, 0))
scene.add_half_space((0, 0, 0), (0, 0, 1))
scene.set_contact_default(restitution=1.0)
ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 1, 0.5), velocity=(0, 0, -1.0))
disc = scene.add_body(carom.Sphere(0.1), mass=2.0, position=(0, 0, 1), velocity=(3.0, 0, 0))
scene.add_force(carom.forces.Resistance(0.5, wind=(-1.0, 0, 0)), disc, name="drag")
s = carom.simulate(scene, 1.0, step=0.02, save_at=0.1, method="rk8")
v = 4.0 / (1.0 + 0.5 * 4.0 / 2.0 * s.t) - 1.0  # m u' = -k u^2, u = v + 1
assert np.allclose(s.velocity[:, 1, 0], v, rtol=0, atol=1e-12)
assert np.allclose(s.ledger.loads, v**2 - 9.0, rtol=0, atol=1e-12)  # all that it takes of m v^2/2
s.save("drag.nc")
again = carom.Solution.load("drag.nc")
assert np.allclose(again["drag"].force[:, 0], -0.5 * (v + 1.0) ** 2, rtol=0, atol=1e-12)
assert again.scene.forces[0].definition.factor == 0.5

scene = carom.Scene(gravity=(0, 0, 0))
tank = scene.add_surface(carom.surfaces.InsideTank(0.3, 1.0))
ball = scene.add_body(carom.Sphere(0.1), mass=1.0, velocity=(0, 0, 1.0))
scene.add_contact(ball, tank, restitution=0.5)
s = carom.simulate(scene, 1.0, step=0.1)
assert abs(s.impacts.time[0] - 0.7) < 1e-9  # at the end of the axis
assert abs(s.velocity[-1, 0, 2] + 0.5) < 1e-9

scene = carom.Scene()
ball = scene.add_body(carom.Sphere(0.05), mass=1.0, position=(0.3, 0, -0.4))
thread = scene.add_joint(carom.joints.Thread((0, 0, 0), (0.3, 0, -0.4)), carom.GROUND, ball)
scene.add_stop(thread, coordinate="distance", upper=1.0, restitution=0.5)
s = carom.simulate(scene, 1.0, step=0.02)
z = np.sqrt(1.0 - 0.3**2)  # its depth where the thread gets taut
assert abs(s.impacts.time[0] - np.sqrt(2 * (z - 0.4) / 9.81)) < 1e-9
u = z * np.sqrt(2 * 9.81 * (z - 0.4))  # speed along the thread
assert abs(s.impacts.impulse[0, 0] - 1.5 * u) < 1e-9
assert np.linalg.norm(s.position[:, 0], axis=1).max() < 1.0 + 1e-9
s.save("thread.nc")
assert np.abs(carom.Solution.load("thread.nc").joint_impulses.impulse).max() < 1e-12  # a joint without rows

from carom.scene.viscous import ViscousFriction
law = ViscousFriction(static=0.1, speed=5.0, most=0.5)
scene = carom.Scene()
block = scene.add_body(carom.Box(0.2, 0.2, 0.02), mass=1.0, position=(0, 0, 0.01), velocity=(1.0, 0, 0))
ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
scene.add_contact(block, ground, restitution=0, friction=law)
s = carom.simulate(scene, 0.1, step=0.05, method="rk8")
v = (1.0 + 0.5) * np.exp(-9.81 / 5.0 * 0.1) - 0.5  # v' = -g (static + v / speed)
assert abs(s.velocity[-1, 0, 0] - v) < 1e-9
s.save("slide.nc")
assert carom.Solution.load("slide.nc").scene.contacts[0].friction == law
"""


def add(text: str, root: Path) -> int:
    """Write the files of a page, and change the lines of its registries; return how many of both."""
    files = re.findall(r"```python\n# (src/\S+)\n(.*?)```", text, re.DOTALL)
    changes = re.findall(r"```diff\n\+\+\+ (src/\S+)\n(.*?)```", text, re.DOTALL)
    for name, code in files:
        assert not (root / name).exists()
        (root / name).write_text(code)
    for name, lines in changes:
        rows = lines.splitlines()
        old, new = ("".join(r[1:] + "\n" for r in rows if r[0] in f" {c}") for c in "-+")
        source = (root / name).read_text()
        assert source.count(old) == 1, f"{name} has not the line {old!r}"
        assert sum(r[0] == "+" for r in rows) == 1  # of one line
        (root / name).write_text(source.replace(old, new))
    return len(files) + len(changes)


def test_what_the_page_adds_runs(tmp_path):
    ours = shutil.ignore_patterns("*.nbc", "*.asked", "functions")  # all but bytecode
    shutil.copytree(LIBRARY, tmp_path / "src" / "carom", ignore=ours)
    assert add(PAGE.read_text(), tmp_path) == 21
    ours = {"PYTHONPATH": str(tmp_path / "src"), "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(
        [sys.executable, "-c", RUN],
        env={**os.environ, **ours},
        cwd=tmp_path,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr


def test_what_is_added_touches_few_rooms():
    text, rooms = PAGE.read_text(), {}
    for section in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        names = re.findall(r"^(?:# |\+\+\+ )src/carom/(\w+)/", section, re.MULTILINE)
        rooms[section.splitlines()[0]] = set(names)
    assert rooms == {
        "A method": {"dynamics"},
        "A joint": {"scene"},
        "A shape": {"scene"},
        "A force": {"dynamics", "scene"},
        "A ground": {"collision", "scene"},
        "A coordinate that stops limit": {"kinematics", "model", "scene"},
        "A law of impact": {"law", "scene"},
        "A law of friction": {"scene"},
    }
