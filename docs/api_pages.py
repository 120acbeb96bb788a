"""Pages of the public classes: every member, inherited ones too, grouped by topic."""

from __future__ import annotations

import inspect
import re
from enum import Enum
from importlib import import_module

HEADING = re.compile(r"^(\w[\w ]*)\n-{3,}$", re.MULTILINE)

#: classes that users call; of all others, which the library hands back, no signature is shown
CALLED = {
    "Scene", "Options", "Material", "Stiffness", "Hertz", "GeneralizedSystem", "UniformOrientation", "Grid",
    "Recording", "Parameter", "State", "Run",
    "Sphere", "Box", "Capsule", "Cylinder", "Disc", "Ellipsoid", "Convex", "Mesh", "Compound", "Part",
    "Revolute", "Spherical", "Prismatic", "Cylindrical", "Screw", "Universal", "Planar", "PointOnLine",
    "PointOnPlane", "Fixed", "Distance", "Tether", "Clearance", "Belt", "Pulley", "KnifeEdge",
    "RollingSphere", "RollingDisc",
    "InsideSphere", "InsideCylinder", "InsideCone", "InsideTorus", "HeightField", "Surface",
    "Gear", "Coupling", "Driver", "Rows",
    "Spring", "Force", "Torque", "Bushing", "JointSpring", "JointForce", "Actuator", "PositionServo",
    "VelocityServo", "JointFriction",
    "PointOnCurve", "CurveOnPoint", "Curve", "Spline", "Profile", "Friction", "Look",
    "Modes", "Circle", "Tube", "Rectangle",
    "Drive", "JointInertia", "BeltStrand", "CurveSpring", "UserForce", "Drag", "Wind", "Magnus", "Buoyancy",
}  # fmt: skip

#: of classes with many members: topics in the order of the page
TOPICS = {
    "Scene": {
        "Bodies, static bodies and half-spaces": (
            "add_body", "add_static", "add_surface", "add_half_space", "bodies", "statics", "half_spaces",
            "fixed", "gravity", "look",
        ),
        "Contacts": (
            "add_contact", "set_contact_default", "ignore_contact", "contacts", "contact_law",
            "contact_default", "pairs_by_default",
        ),
        "Joints and constraints": (
            "add_joint", "add_stop", "add_play", "add_rope", "add_belt", "add_constraint", "switch", "joints",
            "stops", "constraints", "switches",
        ),
        "Forces": ("add_force", "forces"),
        "Changes": ("replace", "remove", "copy"),
        "Model": ("robot",),
        "Checks": ("check", "validate"),
    },
    "Solution": {
        "Motion": ("t", "position", "orientation", "velocity", "angular_velocity", "evaluate"),
        "Parts by name": ("body", "joint", "force", "constraint", "contact"),
        "Impacts": ("impacts", "joint_impulses", "impact_forces", "impact_history", "events", "switches"),
        "Contact that stays": (
            "contacts", "contact_mode", "contact_force", "forces", "surface_power", "held_residual", "pairs",
        ),
        "Energy": ("kinetic_energy", "potential_energy", "total_energy", "ledger"),
        "Joints": (
            "joint_coordinates", "joint_reactions", "constraint_forces", "constraint_errors", "constraint_rows",
        ),
        "Events that it was asked to look for": ("t_events", "state_events"),
        "How the run ended, and going on": ("status", "success", "message", "warnings", "stats", "simulate"),
        "What was run": ("scene", "settings"),
        "Files, tables and plots": ("save", "load", "to_xarray", "to_pandas", "plot", "export"),
    },
}  # fmt: skip

#: tables whose columns are the fields of a record
ROWS = {
    "ImpactTable": "ImpactRecord", "JointImpulseTable": "JointImpulse",
    "CoordinateImpactTable": "CoordinateImpact",
}  # fmt: skip


def find(name: str) -> type:
    """Return what users type: ``"carom.joints.Revolute"``."""
    package, *rest = name.split(".")
    value = import_module(package)
    for part in rest:
        value = (
            getattr(value, part)
            if hasattr(value, part)
            else import_module(f"{value.__name__}.{part}")
        )
    return value


def shown(name: str) -> str:
    """Return the title of a page: the name that users type; of what they are handed that of its class."""
    cls = find(name)
    return name if name.count(".") == 1 or not handed_back(cls) else cls.__name__


def ours(cls: type) -> list[type]:
    """Return the class and its bases that are written here, the last base first."""
    return [base for base in reversed(cls.__mro__) if base.__module__.split(".")[0] == "carom"]


def members(cls: type) -> list[str]:
    """Return the public names of a class and of its bases, fields without a default among them."""
    names = {}
    for base in ours(cls):
        names |= dict.fromkeys([*inspect.get_annotations(base), *vars(base)])
        names |= dict.fromkeys(entries(base, "Attributes"))
    return [name for name in names if not name.startswith("_")]


def entries(cls: type, title: str) -> dict[str, tuple[str, str]]:
    """Return what a section of a numpydoc docstring says: (type, text) by name."""
    doc = inspect.cleandoc(vars(cls).get("__doc__") or "")
    parts = HEADING.split(doc)
    texts = dict(zip(parts[1::2], parts[2::2]))
    found, heads = {}, ()
    for line in texts.get(title, "").strip().splitlines():
        if line and not line[0].isspace():
            names, _, kind = line.partition(" : ")
            heads = [name.strip() for name in names.split(",")]
            found |= {name: (kind, "") for name in heads}
        else:
            found |= {name: (found[name][0], f"{found[name][1]}\n{line.strip()}") for name in heads}
    return found


def handed_back(cls: type) -> bool:
    """Whether users get objects of the class, and never make one."""
    return cls.__name__ not in CALLED


def described(cls: type) -> dict[str, tuple[str, str]]:
    """Return what the docstring of a class says about its members."""
    found = {}
    for base in ours(cls):
        found |= entries(base, "Attributes")
        found |= entries(base, "Parameters") if handed_back(cls) else {}
    return found


def by_topic(name: str) -> dict[str, list[str]]:
    """Return the members of a class under their headings; those that are its arguments stand above them.

    Raises
    ------
    ValueError
        If a class that has topics has a member in none of them.
    """
    cls = find(name)
    arguments = () if handed_back(cls) else arguments_of(cls)
    rest = [member for member in members(cls) if member not in arguments]
    topics = TOPICS.get(cls.__name__)
    if topics is None:
        methods = [m for m in rest if callable_part(cls, m)]
        return {"Attributes": [m for m in rest if m not in methods], "Methods": methods}
    missing = set(rest).symmetric_difference(m for group in topics.values() for m in group)
    if missing:
        raise ValueError(
            f"docs/api_pages.py: topics of {name} and its members differ by {sorted(missing)}"
        )
    return {title: list(group) for title, group in topics.items()}


def arguments_of(cls: type) -> list[str]:
    """Return the arguments of a class that users call, but for those with a docstring of their own."""
    names = inspect.signature(cls).parameters
    return [
        name for name in names if not isinstance(inspect.getattr_static(cls, name, None), property)
    ]


def callable_part(cls: type, member: str) -> bool:
    """Whether a member is a method."""
    part = inspect.getattr_static(cls, member, None)
    return inspect.isfunction(part) or isinstance(part, classmethod | staticmethod)


def directive(name: str, member: str) -> str:
    """Return the lines that document a member."""
    cls = find(name)
    if callable_part(cls, member):
        return f".. automethod:: {name}.{member}\n"
    known = described(cls)
    if issubclass(cls, Enum) and isinstance(getattr(cls, member), cls):
        known = {member: ("", getattr(cls, member).message)}
    if cls.__name__ in ROWS:
        row = ROWS[cls.__name__]
        known |= {m: ("", f"Column of `{row}.{m}`.") for m in inspect.get_annotations(cls)}
    if member in known:
        kind, text = known[member]
        lines = [f".. py:attribute:: {name}.{member}", *([f"   :type: {kind}"] if kind else []), ""]
        return "\n".join(
            [*lines, *(f"   {line}".rstrip() for line in text.strip().splitlines()), ""]
        )
    part = inspect.getattr_static(cls, member, None)
    if isinstance(part, property) or hasattr(part, "func"):
        return f".. autoproperty:: {name}.{member}\n"
    return f".. autoattribute:: {name}.{member}\n   :no-value:\n"


def class_page(name: str) -> str:
    """Return the page of a class in reStructuredText."""
    parts = [f"{shown(name)}\n{'=' * len(name)}\n", f".. autoclass:: {name}\n"]
    for title, group in by_topic(name).items():
        if group:
            parts += [
                f"{title}\n{'-' * len(title)}\n",
                *(directive(name, member) for member in group),
            ]
    return "\n".join(parts)


def without_signature(app, what, name, obj, options, signature, returned):
    """Hide the signature of classes that users never call (for autodoc)."""
    return ("", None) if what == "class" and handed_back(obj) else None


def without_members(app, what, name, obj, options, lines):
    """Take the members out of the docstring of a class: each has an entry of its own below (for autodoc)."""
    if what != "class":
        return
    doc = "\n".join(lines)
    parts = HEADING.split(doc)
    shown = parts[0]
    for title, text in zip(parts[1::2], parts[2::2]):
        if title != "Attributes" and not (title == "Parameters" and handed_back(obj)):
            shown += f"{title}\n{'-' * len(title)}{text}"
    lines[:] = shown.splitlines()


def setup(app):
    """Add a directive for the page of a class; connect to autodoc, before numpydoc reads docstrings."""
    from sphinx.util.docutils import SphinxDirective

    class PublicClass(SphinxDirective):
        """Stands for the page of a class."""

        required_arguments = 1

        def run(self):
            """Return its sections."""
            return self.parse_text_to_nodes(
                class_page(*self.arguments), allow_section_headings=True
            )

    app.add_directive("public-class", PublicClass)
    app.setup_extension("sphinx.ext.autodoc")
    app.connect("autodoc-process-docstring", without_members, priority=400)
    app.connect("autodoc-process-signature", without_signature)
