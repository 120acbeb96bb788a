"""A body that slides on a face: it keeps its height and its tilt, and moves like a plane figure.

While all points of a face slip and its forces are not on one line, only the velocity v = (v_1, v_2) and the
spin w about the normal n change. In axes (1, 2, n) that turn with the body, with r_i = (X_i, Y_i, -H_i) from
its centre to its points, u_i = (v_1 - w Y_i, v_2 + w X_i) and f_i = -mu_i N_i u_i/|u_i|:

    m (dv/dt + w n x v) = sum f_i + m g_t,      sum N_i = -m g_n,
    (J_1n, J_2n, J_nn) dw/dt + w^2 (-J_2n, J_1n, 0) = sum r_i x (f_i + N_i n).

Forces are those of a face on equal springs (`carom.persistent.known_modes`),
N_i = max(0, y_0 + y_1 X_i + y_2 Y_i)/S_i: three unknowns. The method of the run integrates these equations in
steps of their own, to the tolerance of the run, and to the stop, where v and w vanish together. (Mathematics
page, §3.1.)
"""

from __future__ import annotations

import math
from typing import NamedTuple

from carom._compiled.decorators import kernel
from carom.dynamics.acceleration import SLIP
from carom.dynamics.adapt import LEAST, MOST, SAFETY, allowed_error
from carom.dynamics.explicit import stages_within
from carom.dynamics.several_points import velocities
from carom.friction.layout import SLIDING
from carom.geometry.rotation import cross, matrix, multiply, normalize, spin_tensor
from carom.impact.workspace import BACK, OLD, C, P, U
from carom.kinematics.contact_point import in_axes
from carom.kinematics.rows import inverse_inertia, symmetric_times
from carom.persistent.finish import finish
from carom.persistent.known_modes import rows_of, scale_of
from carom.persistent.return_to_surfaces import onto_surfaces, onto_tangents
from carom.persistent.smooth_step import begin, place_at
from carom.persistent.step_control import unnamed

#: greatest velocity out of the plane, of the speed; least area of the points, of the fourth power of the size
FLAT = 1e-9
#: of the error of a step: a slide that ends within so little keeps the direction of its friction to its end
REST = 0.1
#: of the time to the stop at the present deceleration: a longer step is stiff at the end of a straight slide
AHEAD = 2.0 / 3.0
#: least part (`note_rates`) with which a slide goes on; TWICE that with which it begins
PART, TWICE = 1e-3, 2.0
STIFF = 2.5  # least length of the real axis on which steps of our methods are stable, with a margin
TINY = 1e-6  # of the time to the stop, or of the whole step: a shorter one finds nothing new
SAME = 1.0 - 1e-12  # times that agree to this part are one
MANY, ROUNDS = 500, 20  # steps of one slide; sets of points that press
NOT, ENDS, GOES_ON = range(3)


class Figure(NamedTuple):
    """A body that slides: what its equations need besides its points."""

    body: int
    points: int
    mass: float
    size: float
    gravity: tuple[float, float, float]  # normal, and in the plane along the axes at the start
    inertia: tuple[float, float, float]  # J_nn, J_1n, J_2n
    area: float  # square of that which the points spread over


class Motion(NamedTuple):
    """Velocity in axes that turn with the body; displacement, turn and work of friction since the start."""

    v1: float
    v2: float
    w: float
    x: float
    y: float
    turn: float
    work: float


@kernel
def slide_step(model, data, method, k, h):
    """Write the end of a step of the only body of a group, if it slides on a face; return NOT, ENDS or GOES_ON.

    If the slide ends within the step, `until` of the result is that time: the step is repeated up to there.
    """
    system, start, end, group, work = (
        model.system, data.state, data.work.trial, data.group, data.work,
    )  # fmt: skip
    b, result = group.member[0], work.result[0]
    if not (lies_flat(model, data, k) and begin(model, data, k) and all_slip(k, group)):
        return NOT
    figure = draw(system, start[b], k, group)
    if not figure.area > FLAT * figure.size**4:
        return NOT
    motion, time, part, stop = slide(model, data, method, figure, h)
    if time < h and work.search[0].active == 1:
        return NOT
    if time > 0.0:
        result.until = min(result.until, time if time < h else math.inf)
    elif h > AHEAD * stop > TINY * model.controls.step:  # too long a step for others, too
        result.until = min(result.until, AHEAD * stop)
    else:
        return NOT
    write_end(figure, motion, start[b], group.points[0][0].axes, end[b])
    back_to_plane(model, data, k, h)
    result.friction += motion.work
    over = unnamed(system, model.controls, start, end, motion.work, 1, group.member)
    result.unnamed = max(result.unnamed, over)
    return GOES_ON if part >= TWICE * PART else ENDS


@kernel
def lies_flat(model, data, k):
    """Return whether a body slips on three or more vertices on half-spaces of one normal, and does not tilt."""
    system, active, group = model.system, data.active, data.group
    if model.controls.order == 0 or k < 3:
        return False
    point, start = group.points[0][0], data.state[group.member[0]]
    n, size = point.axes[0], system.bodies[group.member[0]].extent
    for i in range(k):
        closed_point, m = group.closed[i], group.points[0][i].axes[0]
        if closed_point.turns > 0 or system.contacts[closed_point.contact].touches != 0:
            return False
        if active.points[closed_point.active].mode != SLIP:
            return False
        if not n[0] * m[0] + n[1] * m[1] + n[2] * m[2] > 1.0 - 1e-14:
            return False
    v = in_axes(point, start.v[0], start.v[1], start.v[2])
    w = in_axes(point, start.w[0], start.w[1], start.w[2])
    out, speed = (
        abs(v[0]) + size * math.hypot(w[1], w[2]),
        math.hypot(v[1], v[2]) + size * abs(w[0]),
    )
    return out <= FLAT * speed


@kernel
def all_slip(k, group):
    """Return whether all points slip."""
    for i in range(k):
        if group.kind[i] != SLIDING:
            return False
    return True


@kernel
def draw(system, start, k, group):
    """Return the figure at the start of a step; write (X, Y, H) of each point to C, and (1/S, mu) to OLD."""
    b, points, q = group.member[0], group.points[0], start.Q
    body, n, g = system.bodies[b], points[0].axes[0], system.gravity
    inverse = inverse_inertia(body, q)
    for i in range(k):
        r = points[i].arm_a
        z, x, y = in_axes(points[0], r[0], r[1], r[2])
        group.v[C][3 * i], group.v[C][3 * i + 1], group.v[C][3 * i + 2] = x, y, -z
        group.v[OLD][3 * i] = 1.0 / scale_of(body.mass, inverse, points[i])
        group.v[OLD][3 * i + 1] = group.mu[i]
    J = spin_tensor(
        matrix(q[0], q[1], q[2], q[3]), (body.inertia[0], body.inertia[1], body.inertia[2])
    )
    about = symmetric_times(J, n[0], n[1], n[2])
    jn, j1, j2 = in_axes(points[0], about[0], about[1], about[2])
    gn, g1, g2 = in_axes(points[0], g[0], g[1], g[2])
    spread = area(k, group, False)
    return Figure(b, k, body.mass, body.extent, (gn, g1, g2), (jn, j1, j2), spread)


@kernel
def motion_at(start, point):
    """Return the motion at the start of a step."""
    _, v1, v2 = in_axes(point, start.v[0], start.v[1], start.v[2])
    w, _, _ = in_axes(point, start.w[0], start.w[1], start.w[2])
    return Motion(v1, v2, w, 0.0, 0.0, 0.0, 0.0)


@kernel
def slide(model, data, method, figure, h):
    """Slide for a time h, or until the body stops, begins to tip, or a point stops before the others.

    Return the motion, the time, the least part (`note_rates`) and the time to the stop there. The bounds of the
    accelerations and of the spin of the body are written.
    """
    controls, stages, order = model.controls, data.work.stages, model.controls.order
    b, first = figure.body, stages[0, figure.body]
    motion = motion_at(data.state[b], data.group.points[0][0])
    t, spin = 0.0, abs(motion.w)
    part, longest = note_rates(figure, motion, first, data.group)
    part /= TWICE
    stop = time_to_stop(figure, motion, first)
    dt = min(h, AHEAD * stop)
    for _ in range(MANY):
        if not (t < h and part >= PART):
            break
        left = h - t
        if lasting(figure, motion, first, data.group) * speed_of(
            figure, motion
        ) <= REST * allowed_error(controls.rtol, controls.atol, figure.size, 0.0):
            motion = slow_down(figure, motion, left, stop)
            t = h if stop >= SAME * left else t + stop
            break
        dt = min(dt, longest)
        if not dt > TINY * min(stop, h):
            break
        dt = left if dt >= left else min(dt, 0.5 * left)
        after, error, then, limit = one_step(model, data, method, figure, motion, dt)
        factor = min(MOST, SAFETY * error ** (-1.0 / order)) if error > 0.0 else MOST
        if not (error <= 1.0 and then >= PART and dt <= limit):
            dt *= min(0.5, max(LEAST, factor)) if error < math.inf else LEAST
            continue
        t, motion, part, longest = h if dt == left else t + dt, after, then, limit
        copy_rates(stages[end_of(method), b], first)
        stop = time_to_stop(figure, motion, first)
        dt, spin = min(factor * dt, AHEAD * stop), max(spin, abs(motion.w))
    write_bounds(figure, spin, data.group, data.work.body[b].bound)
    return motion, t, part, stop


@kernel
def end_of(method):
    """Return the number of the stage that has the accelerations at the end of a step."""
    within = stages_within(method)
    return within if within < method.b.size else method.b.size


@kernel
def one_step(model, data, method, figure, motion, dt):
    """Return the motion after a step, its error, and what `note_rates` returns there."""
    b, stages, last = figure.body, data.work.stages, end_of(method)
    for s in range(1, stages_within(method)):
        stage = combine(method.A[s], s, dt, motion, stages, b)
        note_rates(figure, stage, stages[s, b], data.group)
    after = combine(method.b, stages_within(method), dt, motion, stages, b)
    part, longest = note_rates(figure, after, stages[last, b], data.group)
    return after, relative_error(model, data, method, figure, motion, dt), part, longest


@kernel
def combine(weight, count, h, motion, stages, b):
    """Return motion + h sum of weight[r] * rates of stage r, r < count."""
    v1, v2, w, x, y, turn, work = motion
    for r in range(count):
        f, a, u = h * weight[r], stages[r, b].rate, stages[r, b].speed
        v1, v2, w = v1 + f * a[0], v2 + f * a[1], w + f * a[2]
        x, y, turn, work = x + f * u[0], y + f * u[1], turn + f * u[2], work + f * u[3]
    return Motion(v1, v2, w, x, y, turn, work)


@kernel
def copy_rates(source, target):
    """Copy the rates of a motion."""
    for r in range(4):
        target.rate[r], target.speed[r] = source.rate[r], source.speed[r]


@kernel
def note_rates(figure, motion, stage, group):
    """Write the rates of a motion to a stage, and N to P; return the least part, and the longest step.

    The part is that of the slowest slip, of the speed of the body, or of the area that the forces spread over
    (0: on a line, about which the body tips). A longer step would be stiff: friction turns slips with rates
    that are at most the sum of mu N W_i/|u_i|, with W_i across the slip of a point. `rate` has dv/dt in turning
    axes and dw/dt, `speed` the velocity in fixed axes, w and the power of friction.
    """
    v1, v2, w = motion.v1, motion.v2, motion.w
    cos, sin = math.cos(motion.turn), math.sin(motion.turn)
    c, slip, N = group.v[C], group.v[U], group.v[P]
    slowest = note_slips(figure, motion, group)
    find_forces(figure, w, group)
    f1, f2, torque, power, stiff = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(figure.points):
        q, mu = 3 * i, group.v[OLD][3 * i + 1]
        if mu > 0.0 and slip[q] > 0.0:
            arm = (c[q] * slip[q + 1] + c[q + 1] * slip[q + 2]) / mu
            stiff += mu * N[q] / slip[q] * (1.0 / figure.mass + arm * arm / figure.inertia[0])
        a1, a2 = -N[q] * slip[q + 1], -N[q] * slip[q + 2]
        f1, f2, torque = f1 + a1, f2 + a2, torque + c[q] * a2 - c[q + 1] * a1
        power -= N[q] * slip[q] * math.hypot(slip[q + 1], slip[q + 2])
    _, g1, g2 = figure.gravity
    g1, g2 = cos * g1 + sin * g2, cos * g2 - sin * g1
    stage.rate[0], stage.rate[1] = f1 / figure.mass + g1 + w * v2, f2 / figure.mass + g2 - w * v1
    stage.rate[2] = torque / figure.inertia[0]
    stage.rate[3] = power / figure.mass + v1 * g1 + v2 * g2
    stage.speed[0], stage.speed[1] = cos * v1 - sin * v2, sin * v1 + cos * v2
    stage.speed[2], stage.speed[3] = w, power
    speed = speed_of(figure, motion)
    part = min(
        area(figure.points, group, True) / figure.area, slowest / speed if speed > 0.0 else 0.0
    )
    return part, STIFF / stiff if stiff > 0.0 else math.inf


@kernel
def note_slips(figure, motion, group):
    """Write |u| and mu u/|u| of the slip of each point to U; return the least |u|/mu."""
    c, slip, slowest = group.v[C], group.v[U], math.inf
    for i in range(figure.points):
        q, mu = 3 * i, group.v[OLD][3 * i + 1]
        u1, u2 = motion.v1 - motion.w * c[q + 1], motion.v2 + motion.w * c[q]
        speed = math.sqrt(u1 * u1 + u2 * u2)
        part = mu / speed if speed > 0.0 else 0.0
        slip[q], slip[q + 1], slip[q + 2] = speed, part * u1, part * u2
        slowest = min(slowest, speed / mu if mu > 0.0 else math.inf)
    return slowest


@kernel
def find_forces(figure, w, group):
    """Write N_i = max(0, y_0 + y_1 X_i + y_2 Y_i)/S_i of each point to P: springs that do not pull."""
    c, N = group.v[C], group.v[P]
    for i in range(figure.points):
        N[3 * i] = 1.0
    for _ in range(ROUNDS):
        y, same = springs(figure, w, group), True
        for i in range(figure.points):
            q = 3 * i
            force = max(0.0, (y[0] + y[1] * c[q] + y[2] * c[q + 1]) * group.v[OLD][q])
            same = same and (N[q] > 0.0) == (force > 0.0)
            N[q] = force
        if same:
            return


@kernel
def springs(figure, w, group):
    """Return y, with which the points that press (N > 0) keep the height and the tilt of the body.

    Its rows are the sum of the forces, and the torques about 1 and 2 less those parts that the spin takes:
    (t_1 - J_1n/J_nn t_n, t_2 - J_2n/J_nn t_n) = w^2 (-J_2n, J_1n).
    """
    jn, j1, j2 = figure.inertia
    arms, slip, N = group.v[C], group.v[U], group.v[P]
    a, b, c = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for i in range(figure.points):
        q = 3 * i
        if not N[q] > 0.0:
            continue
        X, Y, H, d1, d2 = arms[q], arms[q + 1], arms[q + 2], slip[q + 1], slip[q + 2]
        turning = (Y * d1 - X * d2) / jn
        t1, t2 = Y - H * d2 - j1 * turning, H * d1 - X - j2 * turning
        s = group.v[OLD][q]
        a = (a[0] + s, a[1] + s * X, a[2] + s * Y)
        b = (b[0] + s * t1, b[1] + s * t1 * X, b[2] + s * t1 * Y)
        c = (c[0] + s * t2, c[1] + s * t2 * X, c[2] + s * t2 * Y)
    bc, ca, ab = cross(*b, *c), cross(*c, *a), cross(*a, *b)
    weight, det = -figure.mass * figure.gravity[0], a[0] * bc[0] + a[1] * bc[1] + a[2] * bc[2]
    if det == 0.0:  # they press on a line
        return 0.0, 0.0, 0.0
    p, q, r = weight / det, -w * w * j2 / det, w * w * j1 / det
    return (
        p * bc[0] + q * ca[0] + r * ab[0],
        p * bc[1] + q * ca[1] + r * ab[1],
        p * bc[2] + q * ca[2] + r * ab[2],
    )


@kernel
def area(k, group, pressed):
    """Return the square of the area that the points spread over, or their forces: 0 if these are on a line."""
    c, m, x, y, xx, xy, yy = group.v[C], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(k):
        f = group.v[P][3 * i] if pressed else 1.0
        m, x, y = m + f, x + f * c[3 * i], y + f * c[3 * i + 1]
    if not m > 0.0:
        return 0.0
    for i in range(k):
        f, dx, dy = group.v[P][3 * i] if pressed else 1.0, c[3 * i] - x / m, c[3 * i + 1] - y / m
        xx, xy, yy = xx + f / m * dx * dx, xy + f / m * dx * dy, yy + f / m * dy * dy
    return xx * yy - xy * xy


@kernel
def speed_of(figure, motion):
    """Return a bound of the speeds of all points of the body."""
    return math.hypot(motion.v1, motion.v2) + figure.size * abs(motion.w)


@kernel
def time_to_stop(figure, motion, stage):
    """Return the time until the body stops if its deceleration stays, 2 T/-T' with the kinetic energy T."""
    moving = motion.v1**2 + motion.v2**2 + figure.inertia[0] / figure.mass * motion.w**2
    return moving / -stage.rate[3] if stage.rate[3] < 0.0 else math.inf


@kernel
def lasting(figure, motion, stage, group):
    """Return how long an error of velocity counts: while the body moves by its size, or until it stops.

    It stops for good only if friction holds it there; on a steeper slope it slides on.
    """
    size, rate, holds = figure.size, stage.rate, 0.0
    pull = math.hypot(rate[0], rate[1]) + size * abs(rate[2])
    pace = max(speed_of(figure, motion), math.sqrt(size * pull))
    lasts = size / pace if pace > 0.0 else 0.0
    for i in range(figure.points):
        holds += group.v[OLD][3 * i + 1] * group.v[P][3 * i]
    if holds > figure.mass * math.hypot(figure.gravity[1], figure.gravity[2]):
        lasts = min(lasts, time_to_stop(figure, motion, stage))
    return lasts


@kernel
def slow_down(figure, motion, left, stop):
    """Return the motion after the time `left`, or at its end if it stops before, with constant deceleration."""
    time = min(left, stop)
    lasts = 1.0 - time / stop if SAME * stop > left else 0.0
    v1, v2, w, x, y, turn, work = motion
    cos, sin, mean = math.cos(turn), math.sin(turn), 0.5 * time * (1.0 + lasts)
    dx, dy = mean * (cos * v1 - sin * v2), mean * (sin * v1 + cos * v2)
    # what friction does is what is lost
    _, g1, g2 = figure.gravity
    moving = 0.5 * (figure.mass * (v1 * v1 + v2 * v2) + figure.inertia[0] * w * w)
    work -= moving * (1.0 - lasts * lasts) + figure.mass * (g1 * dx + g2 * dy)
    return Motion(lasts * v1, lasts * v2, lasts * w, x + dx, y + dy, turn + mean * w, work)


@kernel
def relative_error(model, data, method, figure, motion, dt):
    """Return the error of a step, relative to the tolerance (`carom.dynamics.adapt`)."""
    controls, stages, b, size = model.controls, data.work.stages, figure.body, figure.size
    speed, lasts = speed_of(figure, motion), lasting(figure, motion, stages[0, b], data.group)
    found = (0.0, 0.0)
    for e in range(method.E.shape[0]):
        miss = combine(
            method.E[e], method.E.shape[1], dt, Motion(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), stages, b
        )
        moved = max(math.hypot(miss.x, miss.y), size * abs(miss.turn))
        found = (moved + lasts * max(math.hypot(miss.v1, miss.v2), size * abs(miss.w)), found[0])
    allowed = allowed_error(controls.rtol, controls.atol, size, dt * speed)
    if method.E.shape[0] == 1 or not found[0] > 0.0:
        return found[0] / allowed
    high, low = found[1] / allowed, found[0] / allowed
    return high * high / math.sqrt(high * high + 0.01 * low * low)


@kernel
def write_bounds(figure, spin, group, bound):
    """Write the greatest accelerations, as friction is at most mu times the weight, and the greatest spin."""
    most, farthest, c = 0.0, 0.0, group.v[C]
    for i in range(figure.points):
        most = max(most, group.v[OLD][3 * i + 1])
        farthest = max(farthest, math.hypot(c[3 * i], c[3 * i + 1]))
    push = -most * figure.gravity[0]
    bound[0] = push + math.hypot(figure.gravity[1], figure.gravity[2])
    bound[1], bound[2] = push * farthest * figure.mass / figure.inertia[0], spin


@kernel
def write_end(figure, motion, start, E, end):
    """Write the state of the body after a motion in the plane of the axes E."""
    cos, sin = math.cos(motion.turn), math.sin(motion.turn)
    v1, v2 = cos * motion.v1 - sin * motion.v2, sin * motion.v1 + cos * motion.v2
    for r in range(3):
        end.x[r] = start.x[r] + motion.x * E[1, r] + motion.y * E[2, r]
        end.v[r], end.w[r] = v1 * E[1, r] + v2 * E[2, r], motion.w * E[0, r]
    c, s, q = math.cos(0.5 * motion.turn), math.sin(0.5 * motion.turn), start.Q
    p = multiply(c, s * E[0, 0], s * E[0, 1], s * E[0, 2], q[0], q[1], q[2], q[3])
    q = normalize(p[0], p[1], p[2], p[3])
    end.Q[0], end.Q[1], end.Q[2], end.Q[3] = q


@kernel
def back_to_plane(model, data, k, h):
    """Remove what round-off has moved the body off the surfaces; write the modes and its rest."""
    system, active = model.system, data.active
    end, group, work = data.work.trial, data.group, data.work
    for row in range(3 * k):
        group.v[BACK][row] = 0.0
    for i in range(k):
        group.v[P][3 * i + 1], group.v[P][3 * i + 2] = 0.0, 0.0
    place_at(system, k, 1, end, group, work)
    onto_surfaces(system, active, k, 1, end, group, work)
    place_at(system, k, 1, end, group, work)
    for i in range(k):
        group.closed[i].rows = 1
    onto_tangents(system, k, 1, end, group, work)
    for i in range(k):
        group.closed[i].rows = rows_of(group.v[P][3 * i], True)
    velocities(k, group.points[0], end, group.v[U])
    bound = work.body[group.member[0]].bound
    linear, angular, spin = bound[0], bound[1], bound[2]
    finish(model, data, k, h, 1)
    bound[0], bound[1], bound[2] = linear, angular, spin
    work.body[group.member[0]].miss[:3] = 0.0
    clock = data.clocks[0]
    clock.contact_steps, clock.since = clock.contact_steps + 1, clock.since + 20.0 * k
    worst = work.result[0].residual
    for i in range(k):
        worst = max(worst, abs(group.v[U][3 * i]))
    work.result[0].residual = worst


@kernel
def forget_stops(active, k, group):
    """Let the next step be longer than the time to the stop of a point: a slide finds the stop of the body."""
    for i in range(k):
        active.points[group.closed[i].active].stop = math.inf
