"""Rates of the rows of a point of two solids: the closed form, and a central difference of the points found."""

from typing import NamedTuple

import numpy as np

from carom import Options, Scene
from carom._compiled.decorators import entry
from carom._compiled.record_arrays import table
from carom.contact.kinds.found_points import write_touch
from carom.contact.operations import drift, find_touches
from carom.geometry import quaternion
from carom.model.compile import compile_scene
from carom.model.records import new_work
from carom.model.workspace import POINT
from carom.scene.surfaces import SURFACES


@entry
def points_and_rates(system, state, reach, work, points, rates):
    """Write the points of contact 0, and the rates of their rows (8, 3); return how many."""
    contact = system.contacts[0]
    count = find_touches(system, contact, state, reach, work)
    for i in range(count):
        touch = work.touches[i]
        write_touch(contact, touch, state, points[i])
        d = drift(system, contact, touch.feature, points[i], state, work)
        rates[i, 0], rates[i, 1], rates[i, 2] = d[0], d[1], d[2]
    return count


FAR = np.array([0.0, 0.0, 64.0])


class Motion(NamedTuple):
    """Pose and velocities of a solid; one that is static has no velocities."""

    x: np.ndarray
    q: np.ndarray
    v: np.ndarray | None = None
    w: np.ndarray | None = None


class Rate(NamedTuple):
    """The rates of the rows of a point: the closed form, and a difference that may be off by `doubt`."""

    feature: int
    owner: int
    parts: tuple
    exact: np.ndarray
    difference: np.ndarray
    doubt: float
    scale: float


class Touching:
    """Two solids in contact."""

    def __init__(self, a, b, motion_a, motion_b, reach=0.0):
        scene, other = Scene(gravity=(0, 0, 0)), None
        for shape, motion in ((a, motion_a), (b, motion_b)):
            # two that overlap may not be in one contact of a scene: the first is moved to its place afterwards
            pose = {"position": motion.x + (FAR if other is None else 0), "orientation": motion.q}
            if isinstance(b, SURFACES):  # without end: nothing is far from it
                pose["position"] = motion.x
            if isinstance(shape, SURFACES):
                part = scene.add_surface(shape, **pose)
            elif motion.v is None:
                part = scene.add_static(shape, **pose)
            else:
                speeds = {"velocity": motion.v, "angular_velocity": motion.w}
                part = scene.add_body(shape, mass=1.0, **pose, **speeds)
            if other is not None:
                scene.add_contact(other, part, restitution=0.0, friction=0.0)
            other = part
        compiled = compile_scene(scene, Options())
        self.system, self.start, self.reach = compiled.system, compiled.start, reach
        self.start[0].x[:] -= 0 if isinstance(b, SURFACES) else FAR
        self.work = new_work(self.system, 1)
        self.size = min(a_shape.extent for a_shape in self.system.solids)

    def points(self, time=0.0):
        """Return the points after a time with constant velocities, and the rates of their rows."""
        state = self.start.copy()
        for row in state:
            row.x[:] += time * row.v
            row.Q[:] = quaternion.multiply(quaternion.exp(time * row.w), row.Q)
        points, rates = table(POINT, 8), np.zeros((8, 3))
        arguments = (self.system, state, self.reach, self.work, points, rates)
        count = points_and_rates(*arguments)
        touches = self.work.touches[:count].copy()
        return touches, points[:count], rates[:count]

    def velocity(self, touch):
        """Return the velocity of the first solid relative to the second at a point."""
        contact, total = self.system.contacts[0], np.zeros(3)
        for body, sign, place in ((contact.body, 1, touch.on_a), (contact.other, -1, touch.on_b)):
            if body >= 0:
                row = self.at[body]
                total += sign * (row.v + np.cross(row.w, place - row.x))
        return total

    def rows(self, time, like, axes):
        """Return n.u, t1.u, t2.u of the point like a found one, with fixed tangents; None if there is none."""
        self.at = self.start.copy()
        for row in self.at:
            row.x[:] += time * row.v
        touches, _, _ = self.points(time)
        same = [touch for touch in touches if touch.feature == like.feature]
        if not same:
            return None
        touch = min(same, key=lambda k: np.linalg.norm(k.on_a - like.on_a))
        u = self.velocity(touch)
        return np.array([touch.normal @ u, axes[1] @ u, axes[2] @ u])

    def extrapolated(self, time, like, axes):
        """Return a central difference with the terms of orders 2 and 4 removed, and how far it may be off."""
        table = []
        for k in range(3):
            t = time / 2**k
            rows = [self.rows(s, like, axes) for s in (-t, t)]
            if any(row is None for row in rows):
                return None, np.inf
            table.append((rows[1] - rows[0]) / (2 * t))
        first = [(4 * table[k + 1] - table[k]) / 3 for k in range(2)]
        return (16 * first[1] - first[0]) / 15, np.linalg.norm(first[1] - first[0])

    def rates(self):
        """Return the rates of all points; those without a difference have an infinite `doubt`."""
        touches, points, exact = self.points()
        touches, found = touches.copy(), []
        speeds = [np.linalg.norm(row.v) + self.size * np.linalg.norm(row.w) for row in self.start]
        spins = [np.linalg.norm(row.w) for row in self.start]
        terms = max(sum(speeds) * sum(spins), 1e-300)
        for touch, point, rate in zip(touches, points, exact):
            best, doubt = None, np.inf
            for part in (3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4):
                value, error = self.extrapolated(
                    part * self.size / max(sum(speeds), 1e-300), touch, point.axes
                )
                if error < doubt:
                    best, doubt = value, error
            scale = max(terms, np.linalg.norm(rate))
            found.append(
                Rate(touch.feature, touch.owner, tuple(touch.parts), rate, best, doubt, scale)
            )
        return found
