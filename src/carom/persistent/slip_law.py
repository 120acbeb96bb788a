"""Friction that depends on the slip: its bound in stick, and mu(|u|) in slip.

What sticks is held up to the bound, and slips by mu(|u|) once it has broken away, until its slip ends. So the
same state may stick or slip, and the mode decides (`next` of an active point, or of a joint). In a stage of the
implicit member, whose disc has one radius, mode and mu(|u|) are those of the iterate before.
"""

from __future__ import annotations

import math

from carom._compiled.decorators import kernel
from carom.geometry.thresholds import REMAINDER
from carom.law.friction import bound_of_stick, depends_on_slip, in_slip, margin_of_slip
from carom.law.piecewise import any_depends_on_speed
from carom.model.actions import MODE_SLIP, MODE_STICK
from carom.persistent.joint_rows import radius_of, set_bound
from carom.persistent.memory import is_torque, law_of, memory_of
from carom.persistent.springs import own, place_forces, rate_by_forces
from carom.persistent.thresholds import BREAK_AWAY, FRICTION_LIMIT, LEAST_GRIP

TURNS_BACK = 8  # iterations of a stage in which slip that turns back may still be found to stick


@kernel
def has_law(system, closed_point):
    """Return whether the friction of a point or a joint depends on its slip."""
    return not is_torque(closed_point) and depends_on_slip(
        system.laws, law_of(system, closed_point)
    )


@kernel
def set_friction(system, i, slips, group):
    """Write the friction of entry i, if it has a law: in slip that at its velocity `u`, in stick its bound."""
    closed_point, u = group.closed[i], group.u
    if not has_law(system, closed_point):
        return
    laws, law = system.laws, law_of(system, closed_point)
    if not slips:
        set_bound(i, bound_of_stick(laws, law), group)
    else:
        set_bound(i, in_slip(laws, law, math.hypot(u[3 * i + 1], u[3 * i + 2])), group)


@kernel
def follow_laws(system, active, k, group):
    """Write the friction of entries that have a law, by modes; that of a corner without one, by velocity."""
    if not any_depends_on_speed(system.laws):
        return
    u, fastest = group.u, 0.0
    for row in range(3 * k):
        fastest = max(fastest, abs(u[row]))
    for i in range(k):
        closed_point = group.closed[i]
        if not has_law(system, closed_point):
            continue
        if closed_point.listed == 1:
            set_friction(system, i, slips_by_mode(system, active, closed_point), group)
        else:
            slip = math.hypot(u[3 * i + 1], u[3 * i + 2])
            set_friction(system, i, slip > REMAINDER * fastest, group)


@kernel
def slips_by_mode(system, active, closed_point):
    """Return whether a point, or a joint, slips by its mode."""
    return memory_of(system, active, closed_point).next == MODE_SLIP


@kernel
def breaks_away(i, push, group):
    """Return whether an entry accelerates in slip: its break-away is located on a continuous margin."""
    a = group.a
    return math.hypot(a[3 * i + 1], a[3 * i + 2]) > BREAK_AWAY * push


@kernel
def grip_by_law(i, push, group):
    """Return the margin of an entry that sticks: of its force, or its gain, as accelerations by `push`."""
    a, p, q = group.a, group.p, 3 * i
    if not push > 0.0:
        return 1.0
    if breaks_away(i, push, group):
        return -math.hypot(a[q + 1], a[q + 2]) / push
    left = radius_of(group, i) - math.hypot(p[q + 1], p[q + 2])
    return max(left * max(own(group, q + 1), own(group, q + 2)) / push, LEAST_GRIP * BREAK_AWAY)


@kernel
def note_kink(system, active, closed_point, slip):
    """Write the margins before the next kink of a law, of a point or a joint, at start and end of a step."""
    memory = memory_of(system, active, closed_point)
    before, kink = memory.began, memory.kink
    kink[0], kink[1] = 1.0, 1.0
    if memory.mode == MODE_SLIP:
        law = law_of(system, closed_point)
        kink[0] = margin_of_slip(system.laws, law, before, slip, before)
        kink[1] = margin_of_slip(system.laws, law, before, slip, slip)


@kernel
def share_before_kink(model, active):
    """Return the share of a trial step before the first kink of a law that it passes, by the secant."""
    share = 1.0
    for i in range(active.count[0] if any_depends_on_speed(model.system.laws) else 0):
        kink = active.points[i].kink
        share = min(share, kink[0] / (kink[0] - kink[1]) if kink[1] < 0.0 else 1.0)
    frictions = model.system.relations.memory.frictions
    for i in range(frictions.shape[0]):
        kink = frictions[i].kink
        share = min(share, kink[0] / (kink[0] - kink[1]) if kink[1] < 0.0 else 1.0)
    return share


@kernel
def renew_modes(model, active, k, hg, turn, group):
    """Let what breaks away in a stage slip, and what its disc holds, or what turns back, stick.

    `u` has the slip of the stage without its forces. Return whether a mode changes.
    """
    system, p, changed = model.system, group.p, False
    place_forces(k, p, group)
    for i in range(k):
        closed_point, q = group.closed[i], 3 * i
        if closed_point.listed == 0 or not has_law(system, closed_point):
            continue
        u1 = group.u[q + 1] + hg * rate_by_forces(k, q + 1, group)
        u2 = group.u[q + 2] + hg * rate_by_forces(k, q + 2, group)
        full = not math.hypot(p[q + 1], p[q + 2]) < FRICTION_LIMIT * radius_of(group, i)
        slips = slips_by_mode(system, active, closed_point)
        back = turn < TURNS_BACK and goes_back(system, active, closed_point, u1, u2)
        if slips == (full and not (slips and back)):
            continue
        changed = True
        memory_of(system, active, closed_point).next = MODE_STICK if slips else MODE_SLIP
    return changed


@kernel
def goes_back(system, active, closed_point, u1, u2):
    """Return whether the slip (u1, u2) is against that at the start of the step."""
    memory = memory_of(system, active, closed_point)
    d = memory.heading
    return memory.speed > 0.0 and u1 * d[0] + u2 * d[1] <= 0.0
