"""Values of a scene as JSON and back, bit for bit.

Frozen records are written field by field, including derived fields, and are made again without their
constructors, because normalising a unit vector again, or taking the hull of a hull, would change last digits.
Plain JSON values represent themselves, and a list is an array of floats; all other values are objects with one
of the keys below.

=============== ==================================================================
``type``        a record: its class and its fields
``part``        a body, joint, ... of the scene, by its name
``ground``      `carom.GROUND`
``shape``       a shape, by its place in the list of shapes (several bodies may share it)
``dtype``       an array of another type, or one without elements (with its shape)
``tuple``       a tuple
``number``      nan, inf or -inf
``polynomial``  a `scipy.interpolate.PPoly`
``function``    a user-defined function: only its name
=============== ==================================================================
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from carom import checks
from carom.fields import keep
from carom.flexible.grid import GridModes, on_grid
from carom.flexible.modes import Modes
from carom.io.files.scene_check import check_record
from carom.results.robot import Ball, Coordinate, FreeBody, Keyframe, Motor, Robot
from carom.results.sensors import Frame, Sensor
from carom.scene.belts import BeltRelation, BeltStretch
from carom.scene.bodies import FIXED, GROUND, Body, Ground
from carom.scene.constraints import CONSTRAINTS, Constraint, Gear
from carom.scene.contacts import Contact
from carom.scene.coordinates import Axial, BodyTurn, Bush, Combination, Length, Strand, Wrap
from carom.scene.curves import CURVES
from carom.scene.forces import FORCES, AppliedForce
from carom.scene.joints import JOINTS, Joint
from carom.scene.laws import LAWS
from carom.scene.look import Look
from carom.scene.materials import ContactLaw, Material
from carom.scene.pieces import Piece
from carom.scene.shapes import SHAPES
from carom.scene.stiffness import ABSOLUTE
from carom.scene.stops import Stop
from carom.scene.surfaces import SURFACES
from carom.scene.switch import Switch
from carom.scene.user_surface import Surface

#: parts that have a name in the scene
PARTS = (*FIXED, Body, Joint, AppliedForce, Constraint, Stop, Contact, Switch)
ROBOT = (Robot, Coordinate, Ball, FreeBody, Keyframe, Motor, Frame, Sensor)
TYPES: dict[str, type[Any]] = {
    kind.__name__: kind
    for kind in (
        *PARTS,
        *SHAPES,
        *SURFACES,
        *JOINTS,
        *FORCES,
        *CONSTRAINTS,
        *CURVES,
        *LAWS,
        *ABSOLUTE,
        Combination,
        Length,
        Strand,
        Bush,
        Axial,
        BodyTurn,
        Wrap,
        BeltStretch,
        BeltRelation,
        Gear,
        ContactLaw,
        Material,
        Piece,
        Look,
        GridModes,
        *ROBOT,
    )
}
#: fields that files of earlier versions do not have
LATER: dict[str, Any] = {
    "color": None, "material": None, "of_materials": {"tuple": []}, "tangential_restitution": 0.0,
    "surface_velocity": None, "surface_spin": None, "axis": None, "along": None, "across": None, "of": "body",
    "look": None, "adhesion": 0.0, "modes": None,
}  # fmt: skip
#: the same of fields whose names mean something else in other classes
LATER_OF: dict[str, dict[str, Any]] = {
    "Motor": {"start": 0.0},
    "JointFriction": {"mu": None, "radius": None, "length": None},
    "Material": {"young": None, "poisson": 0.3},
    "Stop": {"stiffness": None},
    "Wrap": {"others": {"tuple": []}},
}
ARRAYS = ("<f8", "<i8", ">f8", ">i8", "|b1")


class MissingFunction:
    """Placeholder of a user-defined function, which a file cannot contain; calling it is an error."""

    def __init__(self, name: str, was: str):
        self.name, self.was = name, was

    def __call__(self, *arguments):
        """Raise an error with the name of the missing function."""
        raise RuntimeError(
            f"the function {self.name!r} ({self.was}) is not in the file, which has only data; give it: "
            f"functions={{{self.name!r}: ...}}"
        )

    def __repr__(self) -> str:
        return f"<function {self.name!r} ({self.was}), not in the file>"


class Encoder:
    """Values as JSON; collects the shapes that bodies share, and the functions that are left out, by name."""

    def __init__(self):
        self.shapes: list = []
        self.functions: dict[str, Callable] = {}
        self._place: dict[int, int] = {}

    def part(self, part) -> dict:
        """Return a named part of a scene, with all its fields."""
        return self._record(part, part.name)

    def value(self, value: Any, where: str = "") -> Any:
        """Return a value as JSON; `where` is the name of a function at this position."""
        if value is None or isinstance(value, (bool, str)):
            return value
        if isinstance(value, (int, float, np.generic)):
            return _number(value)
        if isinstance(value, np.ndarray):
            return _array(value)
        if isinstance(value, tuple):
            return {"tuple": [self.value(one, where) for one in value]}
        if isinstance(value, Ground):
            return {"ground": True}
        if isinstance(value, PARTS):
            return {"part": value.name}
        if isinstance(value, (*SHAPES, *SURFACES)) and not isinstance(value, Surface):
            return {"shape": self._shape(value)}
        if is_dataclass(value) and type(value).__name__ in TYPES:
            return self._record(value, where)
        if _is_polynomial(value):
            curve: Any = value
            return {"polynomial": _array(curve.c), "breaks": _array(curve.x)}
        if callable(value):
            self.functions[where] = value
            return self.function(value, where)
        raise TypeError(f"{where or 'a value'} cannot be written to a file, got {value!r}")

    def function(self, value: Any, where: str) -> dict:
        """Return the JSON of a user-defined function: its name."""
        if isinstance(value, MissingFunction):
            return {"function": where, "was": value.was}
        module, name = (getattr(value, k, "") for k in ("__module__", "__qualname__"))
        return {"function": where, "was": f"{module}.{name or type(value).__name__}"}

    def _record(self, record, where: str) -> dict:
        values = {}
        for field in fields(record):
            if field.name in LATER and _is_as_before(record, field.name):
                continue
            name = field.name if field.name == "definition" else f"{where}.{field.name}"
            below = where if field.name == "definition" else name
            value = getattr(record, field.name)
            if isinstance(value, Modes):  # a function of place is written as what a run uses
                value = on_grid(value, record.shape)
            values[field.name] = self.value(value, below)
        return {"type": type(record).__name__, **values}

    def _shape(self, shape) -> int:
        if id(shape) not in self._place:
            made = self._record(shape, "shape")  # its parts come before it
            self._place[id(shape)] = len(self.shapes)
            self.shapes.append(made)
        return self._place[id(shape)]


class Decoder:
    """Values from JSON: the reverse of `Encoder`."""

    def __init__(self, functions: Mapping[str, Callable] | None = None):
        self.parts: dict[str, Any] = {}  # those that later ones may refer to
        self.shapes: list = []
        self.given = dict(functions or {})
        self.missing: list[str] = []

    def value(self, data) -> Any:
        """Return the value of the JSON `data`."""
        if isinstance(data, list):
            return _frozen(np.array(data, dtype=np.float64))
        if not isinstance(data, dict):
            return data
        if "type" in data:
            kind = TYPES[data["type"]]
            record = object.__new__(kind)
            data = LATER | LATER_OF.get(data["type"], {}) | data
            keep(record, **{f.name: self.value(data[f.name]) for f in fields(kind)})
            if not isinstance(record, PARTS):
                check_record(record)
            return record
        if "dtype" in data:
            if data["dtype"] not in ARRAYS:
                raise ValueError(f"dtype must be one of {ARRAYS}, got {data['dtype']!r}")
            array = np.array(data["array"], dtype=np.dtype(data["dtype"]))
            return _frozen(array.reshape(data["of"]))
        return self._reference(data)

    def _reference(self, data: dict) -> Any:
        if "part" in data:
            return self.parts[data["part"]]
        if "shape" in data:
            return self.shapes[data["shape"]]
        if "tuple" in data:
            return tuple(self.value(one) for one in data["tuple"])
        if "number" in data:
            checks.choice("number", data["number"], ("nan", "inf", "-inf"))
            return float(data["number"])
        if "ground" in data:
            return GROUND
        if "polynomial" in data:
            from scipy.interpolate import PPoly

            c, x = self.value(data["polynomial"]), self.value(data["breaks"])
            if not (np.all(np.isfinite(c)) and np.all(np.isfinite(x))):
                raise ValueError("a polynomial must be finite")
            return PPoly(c.copy(), x.copy())
        name = str(data["function"])
        if name in self.given:
            return self.given[name]
        self.missing.append(name)
        return MissingFunction(name, data["was"])


def _is_as_before(record, name: str) -> bool:
    """Return whether a later field has the value that it has where it is left out."""
    if isinstance(record, FIXED):
        return name != "material" and getattr(record, name) is None
    if isinstance(record, Piece):
        return record.material is None
    if isinstance(record, Body):
        return name in ("look", "modes") and getattr(record, name) is None
    return isinstance(record, ContactLaw) and name == "of_materials" and not record.of_materials


def _number(value) -> Any:
    plain = value.item() if isinstance(value, np.generic) else value
    if isinstance(plain, float) and not math.isfinite(plain):
        return {"number": repr(plain)}
    return plain


def _array(array: np.ndarray) -> Any:
    """Return a list where that says all, else type, shape and elements."""
    if array.dtype == np.float64 and array.size and array.ndim and np.all(np.isfinite(array)):
        return array.tolist()
    elements = [repr(x) if x != x or abs(x) == math.inf else x for x in array.ravel().tolist()]
    return {"dtype": array.dtype.str, "of": list(array.shape), "array": elements}


def _frozen(array: np.ndarray) -> np.ndarray:
    array.setflags(write=False)
    return array


def _is_polynomial(value) -> bool:
    if not checks.is_polynomial(value):
        return False
    from scipy.interpolate import PPoly

    return isinstance(value, PPoly)
