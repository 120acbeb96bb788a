"""Values of every wrong kind, made anew for each call."""

import datetime
import math
from decimal import Decimal
from fractions import Fraction

import numpy as np

import carom


def nested():
    """A list that is its own last entry."""
    inside = [0.0, 0.0]
    inside.append(inside)
    return inside


def stranger():
    """Parts of another scene."""
    scene = carom.Scene()
    plane = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    body = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5), name="ball")
    joint = scene.add_joint(
        carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, body, name="hinge"
    )
    contact = scene.add_contact(body, plane, name="ball-floor")
    alone = carom.Scene()
    alone.add_body(carom.Sphere(0.1), mass=1.0, name="ball")
    return {"alone": alone, "plane": plane, "body": body, "joint": joint, "contact": contact}


#: look like numbers, and are none
NO_NUMBERS = {
    "true": lambda: True,
    "numpy false": lambda: np.False_,
    "digits": lambda: "1",
    "decimal digits": lambda: "0.5",
    "bytes": lambda: b"1",
    "digits in an array": lambda: np.array("1"),
    "three digits": lambda: ["1", "0", "0"],
    "three truths": lambda: [True, False, False],
    "a truth among numbers": lambda: [1, 0, False],
    "array of truths": lambda: np.array([True, False, False]),
    "array of texts": lambda: np.array(["1", "0", "0"]),
    "masked": lambda: np.ma.masked,
    "masked array": lambda: np.ma.array([1.0, 0.0, 0.0], mask=[False, True, False]),
    "masked among numbers": lambda: [np.ma.masked, 0.0, 0.0],
    "date": lambda: np.datetime64("2020-01-01"),
    "span of time": lambda: np.timedelta64(1, "s"),
    "dates": lambda: np.arange(3).astype("datetime64[s]"),
    "complex": lambda: 1 + 0j,
    "complex array": lambda: np.array([1 + 0j, 0, 0]),
    "set": lambda: {1.0},
    "mapping": lambda: {0: 1.0},
    "generator": lambda: (x for x in (1.0, 0.0, 0.0)),
    "object": object,
    "objects": lambda: np.array([object(), 1.0, 2.0]),
    "function": lambda: lambda *given: None,
    "class": lambda: float,
}

WRONG = {
    **NO_NUMBERS,
    "none": lambda: None,
    "word": lambda: "word",
    "empty text": lambda: "",
    "null character": lambda: "a\0b",
    "long text": lambda: "x" * 5000,
    "huge": lambda: 10**400,
    "minus huge": lambda: -(10**400),
    "more digits than Python writes": lambda: 10**5000,
    "beyond 64 bits": lambda: 2**63,
    "nan": lambda: math.nan,
    "numpy nan": lambda: np.float64("nan"),
    "inf": lambda: math.inf,
    "minus inf": lambda: -math.inf,
    "decimal nan": lambda: Decimal("nan"),
    "signalling nan": lambda: Decimal("sNaN"),
    "zero": lambda: 0,
    "minus zero": lambda: -0.0,
    "minus one": lambda: -1,
    "two and a half": lambda: 2.5,
    "third": lambda: Fraction(1, 3),
    "decimal": lambda: Decimal("0.5"),
    "no dimensions": lambda: np.array(0.5),
    "largest": lambda: 1.7e308,
    "1e200": lambda: 1e200,
    "1e-200": lambda: 1e-200,
    "smallest": lambda: 5e-324,
    "million": lambda: 10**6,
    "ten to the twelve": lambda: 10**12,
    "empty list": list,
    "empty tuple": tuple,
    "empty mapping": dict,
    "list of none": lambda: [None],
    "ragged": lambda: [[1.0, 2.0], [3.0]],
    "nested in itself": nested,
    "one in a list": lambda: [1.0],
    "three zeros": lambda: np.zeros(3),
    "three nan": lambda: np.full(3, np.nan),
    "three inf": lambda: [math.inf, 0.0, 0.0],
    "three huge": lambda: [10**400, 0, 0],
    "three 1e200": lambda: [1e200, 1e200, 1e200],
    "three 1e-200": lambda: [1e-200, 0.0, 0.0],
    "four zeros": lambda: np.zeros(4),
    "four": lambda: [2.0, 0.0, 0.0, 0.0],
    "square of zeros": lambda: np.zeros((3, 3)),
    "square of nan": lambda: np.full((3, 3), np.nan),
    "not symmetric": lambda: np.arange(9.0).reshape(3, 3),
    "indefinite": lambda: np.diag([1.0, -1.0, 1.0]),
    "two by two": lambda: np.eye(2),
    "no rows": lambda: np.zeros((0, 3)),
    "five dimensions": lambda: np.zeros((1, 1, 1, 1, 1)),
    "many": lambda: np.zeros(1000),
    "wrong function": lambda: lambda: 0.0,
    "function that fails": lambda: lambda *given: 1 / 0,
    "function of nan": lambda: lambda *given: math.nan,
    "function of a text": lambda: lambda *given: "word",
    "function of too many": lambda: lambda *given: np.zeros((7, 7)),
    "module": lambda: math,
    "day": lambda: datetime.date(2020, 1, 1),
    "shape": lambda: carom.Sphere(1.0),
    "class of shape": lambda: carom.Sphere,
    "material": lambda: carom.Material(0.5, 0.1),
    "options": carom.Options,
    "ground": lambda: carom.GROUND,
    "empty scene": carom.Scene,
    "body of another scene": lambda: stranger()["body"],
    "plane of another scene": lambda: stranger()["plane"],
    "joint of another scene": lambda: stranger()["joint"],
    "contact of another scene": lambda: stranger()["contact"],
    "other scene": lambda: stranger()["alone"],
    "spring of another scene": lambda: carom.forces.JointSpring(stranger()["joint"]),
    "definition": lambda: carom.joints.Spherical((0, 0, 0)),
    "weight": lambda: carom.forces.Force((0, 0, 1)),
}
