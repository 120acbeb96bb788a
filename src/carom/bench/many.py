"""Scenes where many bodies touch: each is stated once, for carom and for MuJoCo.

They have no exact answer, and show what time bodies cost that come together, lie on one another and move on.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

STEP = 1e-3  # of MuJoCo [s]
UPRIGHT = (1.0, 0.0, 0.0, 0.0)


class Part(NamedTuple):
    """A body, or a part of the ground: its shape, with its sizes as carom has them, and where it is."""

    shape: str  # "Sphere", "Capsule" or "Box"
    sizes: tuple[float, ...]
    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float] = UPRIGHT
    mass: float = 0.0
    force: tuple[float, float, float] = (0.0, 0.0, 0.0)  # on a body


class Many(NamedTuple):
    """Bodies above a floor that do not bounce."""

    title: str
    bodies: Sequence[Part]
    duration: float
    friction: float
    on_floor: float  # friction
    ground: Sequence[Part] = ()

    def scene(self) -> Any:
        """Return the scene."""
        import carom

        made = carom.Scene(gravity=(0, 0, -9.81))
        floor = made.add_half_space((0, 0, 0), (0, 0, 1))
        made.set_contact_default(restitution=0.0, friction=self.friction)
        for one in self.ground:
            shape = getattr(carom, one.shape)(*one.sizes)
            made.add_static(shape, position=one.position, orientation=one.orientation)
        for one in self.bodies:
            body = made.add_body(
                getattr(carom, one.shape)(*one.sizes), mass=one.mass, position=one.position,
                orientation=one.orientation,
            )  # fmt: skip
            if any(one.force):
                made.add_force(carom.forces.Force(one.force), body)
            if self.on_floor != self.friction:
                made.add_contact(body, floor, restitution=0.0, friction=self.on_floor)
        return made

    def mujoco(self, module: ModuleType, step: float = STEP) -> tuple[Any, Any]:
        """Return MuJoCo's model and data, with its own contacts, which are springs and dampers."""
        bodies = "".join(
            f'<body {_place(one)}><freejoint/><geom {_geom(one)} mass="{one.mass}"/></body>'
            for one in self.bodies
        )
        ground = "".join(f"<geom {_place(one)} {_geom(one)}/>" for one in self.ground)
        made = module.MjModel.from_xml_string(f"""
        <mujoco><option timestep="{step}" cone="elliptic" gravity="0 0 -9.81"/>
        <default><geom friction="{self.friction} 0 0"/></default><worldbody>
        <geom type="plane" size="99 99 1" friction="{self.on_floor} 0 0" priority="1"/>
        {ground}{bodies}</worldbody></mujoco>""")
        data = module.MjData(made)
        data.xfrc_applied[1:, :3] = [one.force for one in self.bodies]
        return made, data

    def run_mujoco(self, module: ModuleType, duration: float | None = None, step: float = STEP):
        """Run MuJoCo; return the final positions (N, 3)."""
        made, data = self.mujoco(module, step)
        module.mj_step(made, data, nstep=round((duration or self.duration) / step))
        return data.qpos.reshape(len(self.bodies), 7)[:, :3]


def _place(one: Part) -> str:
    return f'pos="{_words(one.position)}" quat="{_words(one.orientation)}"'


def _geom(one: Part) -> str:
    """Return shape and sizes in MuJoCo's form: half the length of a capsule, half the edges of a box."""
    sizes = one.sizes
    if one.shape == "Capsule":
        sizes = (sizes[0], 0.5 * sizes[1])
    elif one.shape == "Box":
        sizes = tuple(0.5 * edge for edge in sizes)
    return f'type="{one.shape.lower()}" size="{_words(sizes)}"'


def _words(values) -> str:
    return " ".join(f"{float(value)!r}" for value in values)


def capsules() -> Many:
    """Return 27 capsules of any direction on a grid, which fall onto the floor and onto each other."""
    random = np.random.default_rng(3)
    radius, length, far = 0.05, 0.2, 0.32
    mass = 1000.0 * np.pi * radius**2 * (length + 4.0 / 3.0 * radius)
    bodies = []
    for i, j, k in itertools.product(range(3), repeat=3):
        turn = random.normal(size=4)
        bodies.append(
            Part(
                "Capsule", (radius, length), (far * (i - 1), far * (j - 1), 0.3 + far * k),
                tuple(turn / np.linalg.norm(turn)), mass,
            )
        )  # fmt: skip
    return Many("27 capsules that fall together, 1 s", bodies, 1.0, 0.5, 0.5)


def lattice() -> Many:
    """Return 60 balls that touch: a cubic lattice without one column, above the floor."""
    radius = 0.006
    mass = 1000.0 * 4.0 / 3.0 * np.pi * radius**3
    places = [one for one in itertools.product(range(4), repeat=3) if one < (3, 3, 0)]
    bodies = [
        Part("Sphere", (radius,), (0.012 * (i - 1.5), 0.012 * (j - 1.5), 0.02 + 0.012 * k), UPRIGHT, mass)
        for i, j, k in places
    ]  # fmt: skip
    return Many("60 balls laid as a lattice, 0.15 s", bodies, 0.15, 0.5, 0.5)


def block() -> Many:
    """Return 216 balls in a cube, off their places by up to a millimetre, without friction (SimBenchmark's)."""
    off = np.random.default_rng(42).random((216, 3)) * 1e-3 + (0.0, 0.0, 0.101)
    bodies = [
        Part("Sphere", (0.1,), tuple(0.21 * np.array(place) + off[k]), UPRIGHT, 10.0)
        for k, place in enumerate(itertools.product(range(6), repeat=3))
    ]
    return Many("216 balls without friction, 1 s", bodies, 1.0, 0.0, 0.0)


def plate() -> Many:
    """Return a plate that is drawn over the floor, with 25 balls that roll on it (SimBenchmark's)."""
    force = 150.0 * np.array([0.5, 0.75**0.5, 0.0])
    bodies = [Part("Box", (20.0, 20.0, 1.0), (0.0, 0.0, 0.5), UPRIGHT, 10.0, tuple(force))]
    bodies += [
        Part("Sphere", (0.5,), (2.0 * i - 4.0, 2.0 * j - 4.0, 1.5), UPRIGHT, 1.0)
        for i, j in itertools.product(range(5), repeat=2)
    ]
    return Many("a plate with 25 balls that roll on it, 1 s", bodies, 1.0, 0.8, 0.4)


def hopper() -> Many:
    """Return 48 grains that fall into a hopper of four slabs at 45 degrees, with a hole of 3 cm."""
    radius, length, width, thick, hole = 0.005, 0.1, 0.2, 0.01, 0.015
    mass = 2500.0 * 4.0 / 3.0 * np.pi * radius**3
    off = np.random.default_rng(7).uniform(-1e-3, 1e-3, size=(48, 3))
    slabs = []
    for k in range(4):
        half, side = 0.25 * np.pi * k, np.exp(0.5j * np.pi * k)
        out, up = hole + 0.5**0.5 * 0.5 * (length + thick), 0.05 + 0.5**0.5 * 0.5 * (length - thick)
        tilt = -np.pi / 8.0  # half the angle, about the axis along the slab
        turn = (
            np.cos(half) * np.cos(tilt), -np.sin(half) * np.sin(tilt),
            np.cos(half) * np.sin(tilt), np.sin(half) * np.cos(tilt),
        )  # fmt: skip
        place = (out * side.real, out * side.imag, up)
        slabs.append(Part("Box", (length, width, thick), place, turn))
    off += (-0.0195, -0.0195, 0.11)
    bodies = [
        Part("Sphere", (radius,), tuple(0.013 * np.array(place) + off[n]), UPRIGHT, mass)
        for n, place in enumerate(itertools.product(range(4), range(4), range(3)))
    ]
    return Many("48 grains into a hopper, 0.3 s", bodies, 0.3, 0.4, 0.4, slabs)


ALL = (capsules, lattice, block, plate, hopper)
