"""The scene of a system in coordinates of the user's own: a body for each coordinate, a stop for each contact.

A body of the size 1 stands for a coordinate along its first axis (`carom.model.chart`). So such a
system has the steps, impacts, persistent contacts, records and events of all scenes.
"""

from __future__ import annotations

import numpy as np

from carom._compiled.user_functions import Functions
from carom.fields import keep
from carom.generalized.stated import CoordinateContact
from carom.model.chart import Chart, new_chart
from carom.scene.bodies import GROUND, Body
from carom.scene.coordinates import Gap
from carom.scene.scene import Scene
from carom.scene.stops import Stop


class SystemFunctions:
    """The compiled functions of a system, which all its runs share."""

    def __init__(self, model, contacts: int, scale: np.ndarray):
        self.functions, self.scale = Functions(), scale
        self.addresses = model.addresses(self.functions)
        self.sizes = model.n, model.holonomic, model.rows, contacts

    def arrays(self, drop: float) -> Chart:
        """Return the arrays of the system, for one run."""
        self.functions.forget()
        return new_chart(self.sizes, np.array(self.scale), drop, *self.addresses)


class GapContact(Stop):
    """A contact of a system, as the stop of its gap."""

    contact: CoordinateContact

    def __init__(self, contact: CoordinateContact, body: Body, size: float):
        gap = Gap(GROUND, body, None, None, contact.index, size)
        keep(self, index=contact.index, name=contact.name, joint=gap, coordinate=0, contact=contact)
        keep(self, lower=0.0, upper=None, restitution=contact.restitution)
        keep(self, impact_law=contact.impact_law, stiffness=None)

    @property
    def friction(self):
        """Its friction, or its law."""
        return self.contact.friction

    @property
    def tangential_restitution(self) -> float:
        """Its e_t."""
        return self.contact.tangential_restitution


class CoordinateScene(Scene):
    """The scene of a system in coordinates of the user's own."""

    def __init__(self, system):
        made, sizes = system.evaluation(), system.scale
        here = made.look(np.append(system.position, system.velocity))
        super().__init__(gravity=(0.0, scale_of_loads(here, sizes), 0.0))
        self.system, self._chart = system._as_it_is(), made.model
        state = zip(here.M.diagonal(), sizes, system.position / sizes, system.velocity / sizes)
        for b, (m, size, x, v) in enumerate(state):
            mass = m * size**2
            self.add_body(
                mass=mass, inertia=np.full(3, mass / 1.5), position=(x, 0, 0), velocity=(v, 0, 0),
                name=f"q{b}",
            )  # fmt: skip
        self._contacts = []
        for contact, row in zip(system.contacts, np.abs(here.G[:, 0]) * sizes):
            b = int(np.argmax(row))
            size = float(row[b]) if 0.0 < row[b] < np.inf else 1.0
            self._contacts.append(GapContact(contact, self.bodies[b], size))

    @property
    def stops(self) -> tuple:
        """The contacts."""
        return tuple(self._contacts)


def scale_of_loads(here: Chart, sizes: np.ndarray) -> float:
    """Return the greatest acceleration by loads at the start, by the sizes of the coordinates.

    It stands in the place of gravity, across the axis along which the bodies move: so it moves nothing, and
    gives speeds and times that count as zero their scale.
    """
    pull = float(np.abs(np.linalg.solve(here.M, here.load) / sizes).max())
    return pull if np.isfinite(pull) else 0.0
