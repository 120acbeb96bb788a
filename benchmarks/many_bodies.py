"""Walls, a break, dice and a robot: processor time, what has no name, and how well contacts are solved.

`python benchmarks/many_bodies.py`; MuJoCo pours the same dice in the same run, with its default solver.
"""

from __future__ import annotations

import time
import warnings
from pathlib import Path

import numpy as np

import carom
from common import report

G, STEP = 9.81, 1e-3
ROBOTS = Path(__file__).parents[1] / "tests" / "data" / "models"


def wall(bricks: int, wide: int) -> carom.Scene:
    """Return a ball of 20 kg on a rod of 2 m that swings into bricks without mortar."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for i in range(bricks):
        row, place = divmod(i, wide)
        y = (place + 0.5 * (row % 2) - wide / 2 + 0.5) * 0.2001
        scene.add_body(carom.Box(0.1, 0.2, 0.1), mass=3.0, position=(0, y, (row + 0.5) * 0.1))
    ball = scene.add_body(
        carom.Sphere(0.1), mass=20.0, position=(-0.5, 0, 0.25),
        velocity=(3, 0, 0), angular_velocity=(0, -1.5, 0),
    )  # fmt: skip
    scene.add_joint(carom.joints.Spherical(anchor=(-0.5, 0, 2.25)), carom.GROUND, ball)
    scene.set_contact_default(restitution=0.1, friction=0.6)
    return scene


def rack(e: float, mu: float) -> carom.Scene:
    """Return fifteen balls on a table, 10 micrometres apart, and a cue ball at 8 m/s."""
    scene, r = carom.Scene(gravity=(0, 0, -G)), 0.0286
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    for i in range(5):
        for j in range(i + 1):
            place = (i * np.sqrt(3) * (r + 5e-6), (2 * j - i) * (r + 5e-6), r)
            scene.add_body(carom.Sphere(r), mass=0.17, position=place)
    scene.add_body(carom.Sphere(r), mass=0.17, position=(-0.3, 0.005, r), velocity=(8, 0, 0))
    scene.set_contact_default(restitution=e, friction=mu)
    return scene


def dice_places(count: int):
    """Yield position, orientation and velocity of dice over a box, and first the width of that."""
    rng = np.random.default_rng(0)
    row = max(2, round((0.7 * count) ** (1 / 3)))
    yield 0.036 * row
    for i in range(count):
        cell = np.array([i % row + 0.5, i // row % row + 0.5, i // row**2 + 0.9])
        q = rng.normal(size=4)
        place = 0.036 * cell + rng.uniform(-1, 1, 3) * 8e-4
        yield place, q / np.linalg.norm(q), rng.normal(size=3) * 0.05


def dice(count: int) -> carom.Scene:
    """Return dice that are poured into a box."""
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    side, *places = dice_places(count)
    for k in range(2):
        for x, sign in ((0.0, 1.0), (side, -1.0)):
            scene.add_half_space(x * np.eye(3)[k], sign * np.eye(3)[k])
    for x, q, v in places:
        scene.add_body(
            carom.Box(0.02, 0.02, 0.02), mass=0.016, position=x, orientation=q, velocity=v
        )
    scene.set_contact_default(restitution=0.3, friction=0.5)
    return scene


def dice_by_mujoco(count: int, duration: float) -> list[str]:
    """Pour the same dice with MuJoCo; return a row."""
    import mujoco

    side, *places = dice_places(count)
    planes = ["0 0 1", "1 0 0", "-1 0 0", "0 1 0", "0 -1 0"]
    points = ["0 0 0", "0 0 0", f"{side} 0 0", "0 0 0", f"0 {side} 0"]
    geoms = "".join(
        f'<geom type="plane" size="1 1 1" pos="{p}" zaxis="{n}" friction=".5"/>'
        for p, n in zip(points, planes)
    )
    bodies = "".join(
        f'<body pos="{x[0]} {x[1]} {x[2]}" quat="{q[0]} {q[1]} {q[2]} {q[3]}"><freejoint/>'
        '<geom type="box" size=".01 .01 .01" mass=".016" friction=".5"/></body>'
        for x, q, _ in places
    )
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="{STEP}" cone="elliptic"/><size memory="200M"/>'
        f"<worldbody>{geoms}{bodies}</worldbody></mujoco>"
    )
    data = mujoco.MjData(model)
    for i, (_, _, v) in enumerate(places):
        data.qvel[6 * i : 6 * i + 3] = v
    begin = time.process_time()
    while data.time < duration - 0.5 * STEP:
        mujoco.mj_step(model, data)
    spent = time.process_time() - begin
    left = np.max(np.abs(data.qvel))
    return [f"{count} dice, MuJoCo", f"{duration:g}", f"{spent:.1f}", "", "", "", f"{left:.0e}"]


def row(name: str, scene: carom.Scene, duration: float) -> list[str]:
    """Run a scene; return what is to be told."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        carom.simulate(scene, 20 * STEP, step=STEP)  # compiled, if nothing else
        begin = time.process_time()
        s = carom.simulate(scene, duration, step=STEP, save_every=10, throw=False)
    spent = time.process_time() - begin
    lost = s.total_energy[0] - s.total_energy[-1]
    return [
        name, f"{duration:g}", f"{spent:.1f}", str(s.stats["whole_steps"]),
        f"{np.max(s.held_residual):.0e}", f"{np.max(np.abs(s.ledger.residual)) / abs(lost):.0e}",
        f"{np.max(np.abs(s.velocity[-1])):.0e}" if s.success else s.status.name,
    ]  # fmt: skip


def main() -> None:
    """Measure and report."""
    humanoid, quadruped = (
        carom.load_model(ROBOTS / "dm_control" / f"{name}.xml", restitution=0.3).scene
        for name in ("humanoid", "quadruped")
    )
    rows = [
        row("wall of 6 bricks, ball on a rod", wall(6, 2), 1.5),
        row("12 bricks", wall(12, 3), 1.5),
        row("24 bricks", wall(24, 6), 1.5),
        row("96 bricks", wall(96, 12), 1.5),
        row("break, e = .95, mu = .1", rack(0.95, 0.1), 0.2),
        row("humanoid of dm_control", humanoid, 1.0),
        row("quadruped of dm_control", quadruped, 1.0),
        row("100 dice poured", dice(100), 1.5),
        dice_by_mujoco(100, 1.5),
    ]
    report(
        "many_bodies", "Many bodies, steps of 1 ms",
        ["scene", "s", "processor time / s", "time-stepping steps", "greatest residual / m/s",
         "unexplained part of the lost energy", "greatest speed at the end / m/s"],
        rows,
    )  # fmt: skip


if __name__ == "__main__":
    main()
