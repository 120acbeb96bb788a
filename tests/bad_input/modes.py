"""Calls that state modes of flexible bodies, and bodies with them."""

import numpy as np

import carom
from bad_input.things import parts
from carom import flexible, forces


def shapes(points):
    """Return one shape: everything moves along z by its place along x."""
    out = np.zeros((len(points), 3, 1))
    out[:, 2, 0] = points[:, 0]
    return out


def one_mode(supported=False):
    """Return modes with one frequency."""
    return carom.Modes([100.0], 0.1, 1.0, shapes, inertia=(1.0, 1.0, 1.0), supported=supported)


def modal(folder):
    """Return functions of (callable, arguments) by name; files are in a folder."""
    nodes = np.array([(0.0, 0, 0), (1.0, 0, 0)])
    M, three = np.eye(9), np.array([(0.0, 0, 0), (1.0, 0, 0), (0, 1.0, 0)])
    line = np.array([(2.0, -1.0, 0.0), (-1.0, 2.0, -1.0), (0.0, -1.0, 2.0)])
    data = carom.Modes([100.0], 0.1, 1.0, (nodes, np.ones((2, 3, 1))))

    def saved():
        data.save(folder / "modes.npz")
        return carom.Modes.load, dict(path=folder / "modes.npz")

    material = dict(density=7800.0, young=210e9, poisson=0.3)
    round_one = flexible.Circle(0.01)
    return {
        "Modes": lambda: (
            carom.Modes,
            dict(frequencies=[100.0], damping=0.1, mass=1.0, shapes=shapes, inertia=(1.0, 1.0, 1.0),
                 supported=False, participation=None),
        ),
        "Modes.shapes": lambda: (one_mode().shapes, dict(points=nodes)),
        "Modes.compliance": lambda: (one_mode().compliance, dict(point=(1.0, 0, 0))),
        "Modes.first": lambda: (one_mode().first, dict(n=1)),
        "Modes.reduce": lambda: (
            carom.Modes.reduce,
            dict(M=M, K=np.kron(line, np.eye(3)), C=M, nodes=three, interface=[1], modes=2),
        ),
        "Modes.save": lambda: (data.save, dict(path=folder / "new.npz", points=nodes)),
        "Modes.load": saved,
        "flexible.Circle": lambda: (flexible.Circle, dict(radius=0.1)),
        "flexible.Tube": lambda: (flexible.Tube, dict(radius=0.1, thickness=0.01)),
        "flexible.Rectangle": lambda: (flexible.Rectangle, dict(width=0.1, height=0.1)),
        "flexible.beam": lambda: (
            flexible.beam,
            dict(length=1.0, section=round_one, **material, ends="free", modes=2, kinds=("bend",), damping=0.1),
        ),
        "flexible.plate": lambda: (
            flexible.plate, dict(length=1.0, width=1.0, thickness=0.01, **material, modes=2, damping=0.1),
        ),
        "flexible.solid": lambda: (
            flexible.solid,
            dict(shape=carom.Box(1.0, 1.0, 1.0), **material, modes=1, fixed=None, cells=2, damping=0.1),
        ),
        "forces.ModalSpring": lambda: (
            forces.ModalSpring,
            dict(stiffness=(1.0, 1.0, 1.0), damping=(0.1, 0.1, 0.1), weight=np.zeros((3, 3))),
        ),
        "Scene.add_body with modes": lambda: (
            parts().scene.add_body,
            dict(shape=carom.Box(1.0, 1.0, 1.0), mass=None, density=None, inertia=None, position=(0, 0, 0),
                 orientation=(1.0, 0, 0, 0), velocity=(0, 0, 0), angular_velocity=(0, 0, 0), material=None,
                 color=None, look=None, modes=one_mode(), name="new", replace=False),
        ),
        "Scene.add_static with modes": lambda: (
            parts().scene.add_static,
            dict(shape=carom.Box(1.0, 1.0, 1.0), position=(0, 0, 0), orientation=(1.0, 0, 0, 0), material=None,
                 color=None, surface_velocity=None, surface_spin=None, modes=one_mode(True), name="new",
                 replace=False),
        ),
    }  # fmt: skip
