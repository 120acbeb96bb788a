"""Friction by load: that of a joint whose bound is mu times what its own reactions press together.

The reaction of a joint is affine in the forces p of the entries of a group, as accelerations are, and so are
the vectors of its load (`carom.dynamics.bearing_load`): column 0 is that without these forces. Bounds follow
the forces in rounds (theory, X.4). Where friction adds to its own load by more than itself, no slip has a
solution, and the joint locks itself: a stage finds it as stick.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom._compiled.units import unit
from carom.dynamics.bearing_load import (
    NUMBERS,
    load_of,
    reaction_at_bearing,
    take_thread_out,
    write_vectors,
)
from carom.dynamics.contact_impulse import acts, alone, spread
from carom.dynamics.delassus import unit_vector
from carom.dynamics.tree import joint_wrenches
from carom.friction.layout import SLIDING
from carom.model.arrays import FOREST
from carom.model.parts_of_system import has_relations
from carom.persistent import thresholds as limits
from carom.persistent.joint_rows import is_by_load

LOAD_ROUNDS = 40  # in which bounds follow the forces
ROW_ERROR, ROW_BEFORE, ROW_STEP, ROW_MAPPED, ROW_LEFT, ROW_INVERSE = range(6)  # of `Group.secant`


@unit(where=has_relations)
def note_reactions(system, state, m, work, group):
    """Write the vectors of all loads by the reactions of the last solve as column m."""
    if system.solver.kind == FOREST:
        joint_wrenches(system, work)
    frictions = system.relations.frictions
    for i in range(frictions.shape[0]):
        if frictions[i].load >= 0:
            force, moment = reaction_at_bearing(system, frictions[i], state, work)
            out = group.loads[frictions[i].load, m]
            write_vectors(system, frictions[i], force, moment, state, out)


@kernel
def has_loads(group):
    """Return whether a system has friction by load."""
    return group.loads.shape[0] > 0


@unit(where=has_relations)
def note_responses(system, k, state, work, group):
    """Write how the loads of joints follow from unit forces of the k entries of a group."""
    points, loads = group.points[0], group.loads
    for m in range(3 * k):
        point = points[m // 3]
        if acts(point.motion, m % 3) and not alone(system, point):
            spread(system, point, state, unit_vector(m % 3), work)
            note_reactions(system, state, 1 + m, work, group)
        else:
            for n in range(loads.shape[0]):
                for r in range(NUMBERS):
                    loads[n, 1 + m, r] = 0.0
    for i in range(k):
        if is_by_load(i, group):
            n = group.closed[i].load
            one = system.relations.frictions[group.closed[i].active]
            take_thread_out(system, one, 1.0, state, loads[n, 3 * i + 2])


@kernel
def load_under(k, share, n, group):
    """Return load n under the forces of k entries: `share` times those of the group."""
    loads, total, p = group.loads[n], group.vectors, group.p
    for r in range(NUMBERS):
        total[r] = loads[0, r]
        for m in range(3 * k):
            pull = group.closed[m // 3].pull if m % 3 == 0 else 0.0
            total[r] += loads[1 + m, r] * (share * p[m] - pull)
    return load_of(total)


@kernel
def renew_loads(k, share, slides, turn, group):
    """Write the bounds of friction by load under the forces `share` p of round `turn`.

    Return whether they differ from those that were used. With `slides` only those of joints that slide count,
    since others do not depend on their bounds.
    """
    return has_loads(group) and not follow_loads(k, share, slides, turn, group)


@unit
def follow_loads(k, share, slides, turn, group) -> bool:
    """Write the loads of the next round by Broyden's method; return whether those of this round fit.

    The first step is that of a fixed point, and each in whose direction its error does not fall: where friction
    adds to its own load by more than itself, loads grow until the joint holds.
    """
    secant, most, left = group.secant, 0.0, 0.0
    for i in range(k):
        if is_by_load(i, group):
            one = group.closed[i]
            found = load_under(k, share, one.load, group)
            secant[ROW_ERROR, one.load] = found - one.bears
            if not slides or group.problem.kind[i] == SLIDING:
                most, left = max(most, found), max(left, abs(found - one.bears))
    late = turn > LOAD_ROUNDS // 2 and left <= limits.LOAD_LEFT * most
    fits = left <= limits.LOAD_ERROR * most or late
    if not fits:
        improve(turn, secant)
    for i in range(k):
        if is_by_load(i, group):
            one = group.closed[i]
            step, error = secant[ROW_STEP, one.load], secant[ROW_ERROR, one.load]
            if fits or not (step * error >= 0.0 and one.bears + step >= 0.0):
                secant[ROW_STEP, one.load] = error
            one.bears += secant[ROW_STEP, one.load]
            group.problem.mu[i] = one.coefficient * one.bears
    return fits


@kernel
def improve(turn, secant):
    """Write the step H F for the errors F of loads, H the inverse of minus their derivative.

    After a step s that has changed the errors by -y:  H += (s - H y) s^T H/(s^T H y)  (Broyden).
    """
    n = secant.shape[1]
    H = secant[ROW_INVERSE:]
    for i in range(n if turn == 0 else 0):
        for j in range(n):
            H[i, j] = 1.0 if i == j else 0.0
    total = 0.0
    for i in range(n if turn > 0 else 0):
        secant[ROW_MAPPED, i], secant[ROW_LEFT, i] = 0.0, 0.0
        for j in range(n):
            secant[ROW_MAPPED, i] += H[i, j] * (secant[ROW_BEFORE, j] - secant[ROW_ERROR, j])
            secant[ROW_LEFT, i] += secant[ROW_STEP, j] * H[j, i]
        total += secant[ROW_STEP, i] * secant[ROW_MAPPED, i]
    for i in range(n if total != 0.0 else 0):
        part = (secant[ROW_STEP, i] - secant[ROW_MAPPED, i]) / total
        for j in range(n):
            H[i, j] += part * secant[ROW_LEFT, j]
    for i in range(n):
        secant[ROW_BEFORE, i] = secant[ROW_ERROR, i]
        secant[ROW_STEP, i] = 0.0
        for j in range(n):
            secant[ROW_STEP, i] += H[i, j] * secant[ROW_ERROR, j]


@kernel
def hold(k, hg, group):
    """Let friction by load hold its joints: with bounds ten times the forces that this takes."""
    for i in range(k if has_loads(group) else 0):
        W, q = group.problem.W, 3 * i + 1
        if is_by_load(i, group) and W[q, q] > group.closed[i].spring:
            need = abs(group.problem.c[q]) + (abs(group.u[q]) / hg if hg > 0.0 else 0.0)
            group.problem.mu[i] = 10.0 * need / W[q, q]
            if group.closed[i].coefficient > 0.0:
                group.closed[i].bears = group.problem.mu[i] / group.closed[i].coefficient


@kernel
def begin_loads(k, group):
    """Write the loads of joints without forces of the entries, from which their rounds begin."""
    for i in range(k if has_loads(group) else 0):
        if is_by_load(i, group):
            group.closed[i].bears = load_under(0, 0.0, group.closed[i].load, group)
            group.problem.mu[i] = group.closed[i].coefficient * group.closed[i].bears


@kernel
def any_locks(k, hg, group):
    """Return whether a joint that slides is held by a load of its own friction: its slip ends in an impulse.

    Its friction adds to its own load by more than itself, and the slip is more than forces give in hg. (Then a
    slip without any force is a solution, too, where nothing else loads the joint: an unstable one.)
    """
    for i in range(k if has_loads(group) else 0):
        q, one = 3 * i + 1, group.closed[i]
        if not is_by_load(i, group) or not group.problem.W[q, q] > one.spring:
            continue
        if limits.SLIDE_OF_FORCES * hg * abs(group.problem.c[q]) < abs(group.u[q]):
            p, held = group.p[q], -group.u[q] / (hg * group.problem.W[q, q])
            before = load_under(k, 1.0, one.load, group)
            group.p[q] += limits.LOAD_PROBE * held
            more = one.coefficient * (load_under(k, 1.0, one.load, group) - before)
            group.p[q] = p
            if more >= abs(limits.LOAD_PROBE * held):
                return True
    return False
