"""Coordinates of joints in results: which a joint has, and their units."""

from __future__ import annotations

import math

import numpy as np

from carom import checks
from carom.scene.joints import Joint

DEGREES = 180.0 / math.pi


def in_degrees(joint: Joint, q: np.ndarray, rate: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates and rates with angles in degrees and degrees a second."""
    factors = np.array([DEGREES if unit == "rad" else 1.0 for unit in units(joint)])
    return q * factors, rate * factors


def units(joint: Joint, degrees: bool = False) -> list[str]:
    """Return the units of the coordinates of a joint; none for one without."""
    angle = "deg" if degrees else "rad"
    return [angle if kind == "turn" else "m" for kind in joint.definition.measured]


def of_scene(scene, joint) -> Joint:
    """Return a joint of the scene; the argument is the joint or its name."""
    if isinstance(joint, str):
        try:
            joint = scene[joint]
        except KeyError as error:
            raise KeyError(f"joint: {error.args[0]}") from None
    checks.instance("joint", joint, (Joint, str))
    if joint not in scene:
        raise ValueError(
            f"joint must belong to the scene of this solution, got {checks.shown(joint)}"
        )
    return scene[joint.name]
