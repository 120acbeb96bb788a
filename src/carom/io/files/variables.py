"""A solution as labelled arrays, for files and for xarray Datasets."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from carom.io.files.layout import (
    CITATION,
    CONVENTIONS,
    DOI,
    EVENT,
    FORMAT,
    HELD,
    IMPACT,
    INTERVAL,
    JOINT_IMPULSE,
    LABELS,
    LEDGER,
    MOTION,
    Variable,
    table_variables,
)
from carom.io.files.scene_parts import scene_to_text
from carom.io.files.user_events import user_events
from carom.results.exerted import rows_of, unit_of
from carom.results.joint_coordinates import units
from carom.results.names import contact_names

MOST_IMPACTS = (
    5000  # for more of them impulses of joints, a third of a millisecond each, must be asked for
)


def labelled(solution, reactions: bool = True, degrees: bool = False) -> list[Variable]:
    """Return the whole solution as variables.

    With `reactions`, also reactions, coordinates and impulses of joints, and forces, which are computed from
    the states; with `degrees`, angles of joints are in degrees.
    """
    scene = solution.scene
    out = [
        Variable(name, (name,), np.array(values), None, meaning)
        for name, (values, meaning) in LABELS.items()
    ]
    names = np.array([body.name for body in scene.bodies])
    out.append(Variable("time", ("time",), solution.t, "s", "saved times"))
    out.append(Variable("body", ("body",), names, None, "bodies by name"))
    out += _motion(solution) + _coordinates(solution)
    out += table_variables("impact", "impact", IMPACT, solution.impacts)
    out += table_variables("event", "event", EVENT, solution.events)
    out += table_variables("interval", "interval", INTERVAL, solution.contacts)
    out += table_variables("held", "held", HELD, solution.forces)
    out += user_events(solution)
    out += _contacts(solution)
    if reactions and has_reactions(solution):
        out += _joints(solution, degrees) + _constraints(solution) + _forces(solution)
    text = np.array(scene_to_text(scene), dtype=object)
    out.append(Variable("scene", (), text, None, "the scene that was simulated, as JSON"))
    return out


def has_reactions(solution) -> bool:
    """Return whether reactions can be computed."""
    return not missing(solution) or "joint_reactions" in vars(solution)


def missing(solution) -> list[str]:
    """Return the functions of the scene that a file could not contain."""
    return getattr(solution._run, "missing", [])


def attributes(solution) -> dict[str, Any]:
    """Return the attributes of a run as a whole."""
    import carom

    return {
        "Conventions": CONVENTIONS,
        "title": "Motion of a multibody system with frictional impacts",
        "source": f"carom {carom.__version__}",
        "references": f"https://doi.org/{DOI}",
        "citation": CITATION,
        "carom_version": carom.__version__,
        "carom_format": FORMAT,
        "status": solution.status.name,
        "message": solution.message,
        **({"reason": solution._reason} if solution._reason else {}),
        "warnings": json.dumps(solution.warnings),
        "stats": json.dumps(solution.stats),
        "settings": json.dumps(solution.settings),
        "options": json.dumps(solution._run.options.as_dict()),
    }


def _coordinates(solution) -> list[Variable]:
    """Return the coordinates of a system of the user's own, and their rates."""
    if solution.scene._chart is None:
        return []
    scale, dims = solution.scene.system.scale, ("time", "coordinate")
    return [
        Variable("q", dims, scale * solution.position[..., 0], None, "coordinates"),
        Variable("v", dims, scale * solution.velocity[..., 0], None, "rates of the coordinates"),
    ]


def _motion(solution) -> list[Variable]:
    ledger = [
        Variable(f"ledger_{name}", ("time",), getattr(solution.ledger, name), "J", meaning)
        for name, meaning in LEDGER.items()
    ]
    mass = np.array([body.mass for body in solution.scene.bodies])
    return [
        *table_variables("", "time", MOTION, solution),
        Variable("mass", ("body",), mass, "kg", "mass of the body"),
        *ledger,
    ]


def _contacts(solution) -> list[Variable]:
    scene = solution.scene
    pairs = solution.pairs
    names = contact_names(scene, pairs).name
    if not len(names):
        return []
    none = np.full(len(scene.stops), -1)
    out = [
        Variable("contact", ("contact",), names, None, "contacts and stops by name"),
        Variable(
            "contact_body", ("contact",), np.append(pairs.body, none), "1",
            "place of its body among all bodies, from 0; -1 of a stop",
        ),
        Variable(
            "contact_other", ("contact",), np.append(pairs.other, none), "1",
            "place of the other body, -1 for a half-space or a stop",
        ),
    ]  # fmt: skip
    if scene.contact_default is not None:
        return out  # too many for a place at each time: the rows of `held_*` say the same
    return [
        *out,
        Variable(
            "contact_mode", ("time", "contact"), solution.contact_mode, "1",
            "0 open, 1 slipping, 2 sticking (or rolling, or at rest)",
        ),
        Variable(
            "contact_force", ("time", "contact", "contact_axis"), solution.contact_force, "N",
            "force of persistent contacts on the body",
        ),
    ]  # fmt: skip


def _joints(solution, degrees: bool) -> list[Variable]:
    joints = solution.scene.joints
    if not joints:
        return []
    names, reactions = np.array([j.name for j in joints]), solution.joint_reactions
    spatial = ("time", "joint", "axis")
    out = [
        Variable("joint", ("joint",), names, None, "joints by name"),
        Variable(
            "joint_force", spatial, reactions[..., :3], "N", "on the child at its anchor, world axes",
        ),
        Variable(
            "joint_torque", spatial, reactions[..., 3:], "N m",
            "on the child about its anchor, world axes",
        ),
    ]  # fmt: skip
    few = len(solution.impacts) <= MOST_IMPACTS and not missing(solution)
    if few or "joint_impulses" in vars(solution):
        of = "joint_impulse"
        out += table_variables(of, of, JOINT_IMPULSE, solution.joint_impulses)
    labels, known, q, rates = [], [], [], []
    for joint in joints:
        value, rate = solution.joint_coordinates(joint, degrees=degrees)
        number = value.shape[1]
        labels += [joint.name if number == 1 else f"{joint.name}[{k}]" for k in range(number)]
        known += units(joint, degrees)
        q.append(value)
        rates.append(rate)
    if not labels:
        return out
    series = ("time", "coordinate")
    return [
        *out,
        Variable("coordinate", ("coordinate",), np.array(labels), None, "coordinates of joints"),
        Variable(
            "coordinate_units", ("coordinate",), np.array(known), None, "units of joint_coordinate"
        ),
        Variable("joint_coordinate", series, np.hstack(q), None, "in coordinate_units"),
        Variable("joint_rate", series, np.hstack(rates), None, "in coordinate_units a second"),
    ]


def _constraints(solution) -> list[Variable]:
    scene, out = solution.scene, []
    if scene.constraints:
        names = [
            c.name if c.rows == 1 else f"{c.name}[{k}]"
            for c in scene.constraints
            for k in range(c.rows)
        ]
        forces = solution.constraint_forces
        out += [
            Variable("row", ("row",), np.array(names), None, "rows of constraints by name"),
            Variable("constraint_force", ("time", "row"), forces, None, "multipliers, N or N m"),
        ]
    if scene.joints or scene.constraints:
        position, velocity = solution.constraint_errors
        rows, of = solution.constraint_rows, ("time", "constraint_row")
        out += [
            Variable("constraint_row", of[1:], rows.name, None, "rows of joints and constraints"),
            Variable("constraint_unit", of[1:], rows.unit, None, "unit of position_error"),
            Variable("position_error", of, position, None, "error, in constraint_unit"),
            Variable("velocity_error", of, velocity, None, "error, in constraint_unit a second"),
        ]
    return out


def _forces(solution) -> list[Variable]:
    rows, data = rows_of(solution.scene), solution._exerted
    if not rows:
        return []
    names, bodies = (np.array(part) for part in zip(*((f.name, b.name) for f, b in rows)))
    units = [unit_of(force) for force, _ in rows]
    of, vector = ("time", "applied"), ("time", "applied", "axis")
    return [
        Variable("applied", of[1:], names, None, "applied forces by name, a place for each body"),
        Variable("applied_body", of[1:], bodies, None, "body on which it acts"),
        Variable("applied_force", vector, data[..., :3], "N", "on the body, world axes"),
        Variable("applied_torque", vector, data[..., 3:6], "N m", "on the body, world axes"),
        Variable("applied_units", of[1:], np.array(units), None, "units of applied_value"),
        Variable(
            "applied_value", of, data[..., 6], None,
            "along a coordinate of a joint, or the tension of a spring, in applied_units; NaN of others",
        ),
        Variable("applied_power", of, data[..., 7], "W", "power that it gives to the body"),
    ]  # fmt: skip
