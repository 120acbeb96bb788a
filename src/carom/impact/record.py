"""Writing the records of impacts."""

from __future__ import annotations

import math
from typing import NamedTuple

from carom._compiled.decorators import kernel
from carom.impact import layout
from carom.impact.thresholds import NO_RESTITUTION
from carom.kinematics.anisotropy import lengths_of_tangents
from carom.kinematics.contact_point import power_of_surface
from carom.law import impact_laws
from carom.model.parts_of_system import has_relation_rows
from carom.model.workspace import MOTION_THREE

_NOT_LAW_A = layout.PHASE_JAM | layout.WEDGED


class Blow(NamedTuple):
    """What is written of the impact of one point. Vectors are in contact axes, normal first."""

    together: int  # points that strike together
    before: tuple  # velocities
    after: tuple
    impulse: tuple
    compression: float  # works
    restitution: float
    friction: float  # loss
    change: float  # of energy
    phases: int
    duration: float


@kernel
def three(values, i):
    """Return three numbers of an array, from the i-th on."""
    return values[i], values[i + 1], values[i + 2]


@kernel
def write_blow(contact, point, state, blow, clock, records):
    """Write the row of one impact, except its W: all impacts are written here."""
    row, x = records.impact[clock.struck], state[point.a].x
    row.time, row.contact, row.together = clock.now, contact.number, blow.together
    for r in range(3):
        row.point[r], row.normal[r] = x[r] + point.arm_a[r], point.axes[0, r]
    row.before[0], row.before[1], row.before[2] = blow.before
    row.after[0], row.after[1], row.after[2] = blow.after
    row.impulse[0], row.impulse[1], row.impulse[2] = blow.impulse
    row.compression_work, row.restitution_work = blow.compression, blow.restitution
    row.friction_loss, row.energy_change = blow.friction, blow.change
    row.phases, row.duration = blow.phases, blow.duration
    if contact.axis_of != 0:
        write_plain(row, lengths_of_tangents(point))
    if point.motion == MOTION_THREE and point.grip > 0.0:
        write_plain(row, (point.grip, 1.0))
    clock.struck += 1


@kernel
def write_plain(row, lengths):
    """Write the vectors of a row, and its W, in tangents of length 1."""
    for r in range(1, 3):
        s = lengths[r - 1]
        row.before[r], row.after[r], row.impulse[r] = (
            row.before[r] / s,
            row.after[r] / s,
            row.impulse[r] * s,
        )
        for j in range(3):
            row.W[r, j] /= s
            row.W[j, r] /= s


@kernel
def write_impact(contact, state, point, hit, clock, records):
    """Write the impact of a single point: the result of the impact solver or of the layer."""
    out = hit.out
    copy_block(hit.W, 0, records.impact[clock.struck].W)
    blow = Blow(
        together=1, before=three(hit.u, 0), after=three(out, layout.VELOCITY),
        impulse=three(out, layout.IMPULSE), compression=out[layout.WORK_C], restitution=out[layout.WORK_R],
        friction=out[layout.FRICTION_LOSS], change=out[layout.ENERGY_CHANGE],
        phases=int(out[layout.PHASES]), duration=layer_time(contact, hit, out),
    )  # fmt: skip
    write_blow(contact, point, state, blow, clock, records)
    clock.impacts += blow.change


@kernel
def write_share(data, contact, i, k):
    """Write the share of point i in an impact of k points.

    A loss that its law does not allow, at e = 1 without friction, is no entry of the ledger.
    """
    group, multiple, clock, records = data.group, data.multiple, data.clocks[0], data.records
    result, n = multiple.result, 3 * i
    taken, returned, loss = result.compression[i], result.restitution[i], result.friction[i]
    phases = layout.WEDGED if result.wedged[i] != 0 else 0
    given = multiple.contact[i]
    if given.restitution > 0.0:
        phases |= result.summary[0].marks & (layout.AT_ONCE | layout.PLASTIC)
    copy_block(group.problem.W, n, records.impact[clock.struck].W)
    blow = Blow(
        together=k, before=three(group.u, n), after=three(result.velocity, n),
        impulse=three(result.impulse, n), compression=taken, restitution=returned, friction=loss,
        change=taken + returned - loss, phases=phases, duration=0.0,
    )  # fmt: skip
    write_blow(contact, group.points[0][i], data.state, blow, clock, records)
    if not (phases & layout.PLASTIC != 0 and given.restitution == 1.0 and given.friction == 0.0):
        clock.impacts += blow.change


@kernel
def note_drive(system, point, state, impulse, clock):
    """Add the work of the drive of a moving surface; where there are motors, `driven_work` has it."""
    if point.moves == 1 and not has_relation_rows(system):
        clock.loads += power_of_surface(point, state, impulse)


@kernel
def copy_block(W, n, out):
    """Copy the block (3, 3) of W from row and column n on."""
    for r in range(3):
        for s in range(3):
            out[r, s] = W[n + r, n + s]


@kernel
def layer_time(contact, hit, out):
    """Return the time that the impact takes in the layer.

    With Newton's law law A gives T_c = 2 b l/v_0, T_r = T_c/e. With the other laws, and after a jam, N is
    constant in each phase, N_c = |A_c|/(b l) and N_r = A_r/(b l). A wedged pair has no restitution, and a law
    without a path takes no time.
    """
    if hit.impact_law in impact_laws.WITHOUT_PATH:
        return 0.0
    depth = -contact.width * math.log1p(-contact.penetration)
    if hit.impact_law == impact_laws.NEWTON and (int(out[layout.PHASES]) & _NOT_LAW_A) == 0:
        e = hit.restitution
        return 2.0 * depth / -hit.u[0] * (1.0 + (1.0 / e if e >= NO_RESTITUTION else 0.0))
    compression, p_c = out[layout.WORK_C], out[layout.P_C]
    restitution, p_r = out[layout.WORK_R], out[layout.IMPULSE] - out[layout.P_C]
    time = 0.0
    if compression < 0.0:
        time += p_c * depth / -compression
    if restitution > 0.0:
        time += p_r * depth / restitution
    return time
