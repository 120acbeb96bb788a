"""Whether two solutions are the same, bit for bit."""

from dataclasses import fields, is_dataclass

import numpy as np

import carom

ARRAYS = (
    "t", "position", "orientation", "velocity", "angular_velocity", "kinetic_energy",
    "potential_energy", "total_energy", "held_residual",
)  # fmt: skip
TABLES = ("impacts", "events", "contacts", "forces", "ledger")


def same_bits(a, b):
    """Type, shape and every bit: nan is nan, and -0.0 is not 0.0."""
    a, b = np.ascontiguousarray(a), np.ascontiguousarray(b)
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def columns(table):
    """Names and arrays of a table."""
    names = [f.name for f in fields(table)] if is_dataclass(table) else table._record._fields
    return {name: getattr(table, name) for name in names}


def differences(a: carom.Solution, b: carom.Solution) -> list[str]:
    """What two solutions do not have in common, of all that is stored."""
    out = [name for name in ARRAYS if not same_bits(getattr(a, name), getattr(b, name))]
    for table in TABLES:
        one, two = columns(getattr(a, table)), columns(getattr(b, table))
        out += [f"{table}.{name}" for name in one if not same_bits(one[name], two[name])]
    for name in ("status", "success", "message", "stats", "settings"):
        out += [name] if getattr(a, name) != getattr(b, name) else []
    return out


def goes_on(scene: carom.Scene, duration: float, path, **how) -> carom.Solution:
    """Check that a run that goes on from its file has the bits of a whole one, which is returned."""

    def stop(done, total):
        if done >= 0.5 * total:
            raise KeyboardInterrupt

    whole = carom.simulate(scene, duration, **how)
    carom.simulate(scene, duration, save=path, progress=stop, throw=False, **how)
    assert differences(carom.resume(path), whole) == []
    return whole


def derived_differences(a: carom.Solution, b: carom.Solution) -> list[str]:
    """The same of what is worked out on demand."""
    middle = 0.5 * (a.t[1:] + a.t[:-1])
    pairs = {
        f"evaluate {side}": (a.evaluate(middle, side), b.evaluate(middle, side))
        for side in ("left", "right")
    }
    pairs["contact_mode"] = ([a.contact_mode], [b.contact_mode])
    pairs["contact_force"] = ([a.contact_force], [b.contact_force])
    if a.scene.joints or a.scene.constraints:
        pairs["reactions"] = ([a.joint_reactions], [b.joint_reactions])
        pairs["constraints"] = ([a.constraint_forces], [b.constraint_forces])
        pairs["errors"] = (a.constraint_errors, b.constraint_errors)
    for joint in a.scene.joints:
        coordinates = a.joint_coordinates(joint), b.joint_coordinates(joint.name)
        pairs[f"coordinates of {joint.name}"] = coordinates
    return [
        name for name, (x, y) in pairs.items() if not all(same_bits(p, q) for p, q in zip(x, y))
    ]
