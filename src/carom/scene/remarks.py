"""Input of a scene that is refused for an `impact_location`, or is nearly always a mistake."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.geometry.frames import length
from carom.scene.all_pairs import that_touch
from carom.scene.bodies import HalfSpace
from carom.scene.forces import Force, Torque

if TYPE_CHECKING:
    from carom.scene.scene import Scene

MOST_NAMES = 6  # names in a sentence


def remarks(scene: Scene) -> tuple[str, ...]:
    """Return sentences about parts of a scene that are nearly always a mistake."""
    found = (_of_untouched, _of_unsaid, _of_gravity, _of_stops, _of_doubled)
    return tuple(sentence for about in found for sentence in about(scene))


def _of_untouched(scene: Scene) -> list[str]:
    """Return a sentence about free bodies that cannot touch anything, if others could touch them."""
    if not (scene.fixed or scene.contacts):
        return []
    kept = _touched(scene)
    kept.update(part for joint in scene.joints for part in (joint.parent, joint.child))
    kept.update(part for constraint in scene.constraints for part in constraint.parts)
    for force in scene.forces:
        # springs and what the user writes may hold it
        if not isinstance(force.definition, (Force, Torque)):
            kept.update((force.parent, force.child, *getattr(force.definition, "bodies", ())))
    free = [b for b in scene.bodies if b not in kept]
    if not free:
        return []
    bare = [b for b in free if b.shape is None]
    why = f" ({_names(bare)} without a shape)" if bare and scene.contact_default else ""
    return [
        f"Nothing can touch {_names(free)}{why}: no contacts are computed for them. Add contacts with "
        "add_contact, or let all pairs touch with set_contact_default."
    ]


def _touched(scene: Scene) -> set:
    """Return the parts that have a contact of their own or by default."""
    touched: set = {part for one in scene.contacts for part in (one.body, one.other)}
    found = scene._pairs.defaults(scene.bodies, scene.fixed)
    if found is not None:
        touched.update(scene.bodies[b] for b in that_touch(found))
    return touched


def _of_unsaid(scene: Scene) -> list[str]:
    """Return a sentence about contacts without a stated restitution and friction."""
    pairs = scene._pairs
    found = [contact for contact in scene.contacts if pairs.is_unsaid(contact.body, contact.other)]
    what = [_names(found)] if found else []
    if pairs.default is not None and pairs.unsaid_default and not _all_of_materials(scene):
        what.append("set_contact_default")
    if not what:
        return []
    return [
        f"Restitution and friction are not given for {' and '.join(what)}: the defaults 0.5 and 0 are used. "
        "Give them, for example restitution=0.5, friction=0.3."
    ]


def _of_gravity(scene: Scene) -> list[str]:
    """Return a sentence about gravity that points away from all half-spaces, if nothing else moves bodies."""
    planes, gravity = scene.half_spaces, scene.gravity
    if not planes or scene.statics or scene.joints or scene.constraints or scene.forces:
        return []
    if any(contact.adhesion > 0.0 for contact in scene.contacts):
        return []  # it hangs
    much, normals = 0.5 * length(gravity), [plane.normal for plane in planes]
    if not all(normal @ gravity > much for normal in normals):
        return []
    if any(body.velocity @ normal < 0.0 for body in scene.bodies for normal in normals):
        return []  # thrown at a ceiling
    down = tuple((0.0 - gravity).tolist())
    return [
        f"Gravity {tuple(gravity.tolist())} points away from {_names(planes)}: bodies do not fall onto it. "
        f"Give gravity={down}, or turn the normal."
    ]


def _of_stops(scene: Scene) -> list[str]:
    """Return a sentence about stops whose angles are probably in degrees: whole numbers beyond one turn."""
    found = [
        stop
        for stop in scene.stops
        if getattr(stop.joint, "kind", "") != "Screw"  # which is made for many turns
        and stop.turns
        and abs(stop.end) > 2.0 * math.pi
        and stop.end == round(stop.end)
        and stop.name not in scene._in_radians
    ]
    if not found:
        return []
    first = found[0]
    side = "lower" if first.upper is None else "upper"
    return [
        f"The angle of {_names(found)} is beyond a whole turn ({side}={first.end:g} rad): it is in radians. If "
        f"you mean degrees, give {side}=math.radians({first.end:g})."
    ]


def _of_doubled(scene: Scene) -> list[str]:
    """Return a sentence about equal forces of which one has no name of its own: a cell that ran twice."""
    seen, again = set(), []
    for force in scene.forces:
        values = vars(force.definition).values()
        value = (one.tobytes() if isinstance(one, np.ndarray) else str(one) for one in values)
        key = (force.kind, force.parent, force.child, *value)
        if key in seen and re.fullmatch(r"force\d+", force.name):
            again.append(force)
        seen.add(key)
    if not again:
        return []
    return [
        f"{_names(again)} acts a second time, as another force that is the same: a cell that runs twice adds "
        "its parts twice. Give each a name, and replace=True where a cell may run again."
    ]


def _all_of_materials(scene: Scene) -> bool:
    return all(part.material is not None for part in (*scene.bodies, *scene.fixed))


def _names(parts: Sequence) -> str:
    shown = ", ".join(repr(part.name) for part in parts[:MOST_NAMES])
    return shown + (f" and {len(parts) - MOST_NAMES} more" if len(parts) > MOST_NAMES else "")


def check_location(scene, impact_location: str) -> None:
    """Refuse stops, contacts between bodies and curved shapes if impacts are not located."""
    if impact_location == "locate":
        return
    if scene.stops:
        raise ValueError(
            f'impact_location must be "locate" if joints have stops, got {impact_location!r}'
        )
    between = any(not isinstance(c.other, HalfSpace) for c in scene.contacts)
    touching = [c.body for c in scene.contacts]
    if scene.contact_default is not None:
        between = between or len(scene.bodies) > 1 or bool(scene.statics)
        touching += [body for body in scene.bodies if body.shape is not None]
    curved = [body for body in touching if any(p.corners is None for p in body.shape.pieces)]
    if between or curved:
        why = (
            f"shapes are curved, as that of {curved[0].name!r}"
            if curved
            else "bodies may touch each other"
        )
        raise ValueError(f'impact_location must be "locate" if {why}, got {impact_location!r}')
