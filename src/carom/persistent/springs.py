"""Forces of the points of a group whose modes are known: springs that do not pull.

    (du/dt)_n = 0 for points that press, all three rows for those that stick, and for those that slip along d

        lam = N (1, -mu d),    and along the axis e of a rotation the torque -delta N e.

Forces need not be unique (four corners of a face). They are those of springs of infinite stiffness,

    N_i = max(0, G_i xi)/s_i,    xi: a displacement of the bodies,  s_i: compliance (`carom.persistent.points`),

so that they are continuous in the positions. With R the rows, F the directions of forces and S the compliances
of the points that press, (R P F^T + eps S) lam = -c for eps -> 0: corrections with one factor remove what eps
leaves (`settle`). With eps a point that does not press must not be deeper than its neighbours let it be: its
spring would press, too.

Stick is softer, and among points as 1/(mu N), like micro-slip: what others hold needs no friction, and points
that slip together reach their cones together.

Rows that depend on each other (two wheels of an axle) fit each other in a position of the system, and in a
stage to the error of the stage: what no force removes is left to the return at the end of the step.
"""

from __future__ import annotations

from carom._compiled.decorators import inlined, kernel
from carom._compiled.units import unit
from carom.friction import lu
from carom.friction.layout import SLIDING
from carom.geometry.thresholds import LAST_DIGIT, REMAINDER, ROUND_OFF
from carom.impact.thresholds import GROUP_ERROR, LOADED_PART
from carom.law.turning import arm_of_torque
from carom.model.allowance import COUNT_FACTORS
from carom.model.workspace import CONSTANT, MOTION_POINT, MOTION_ROLL
from carom.persistent import thresholds as limits
from carom.persistent.by_bodies import (
    FACTORED,
    factor_by_bodies,
    knows_arms,
    push_by_forces,
    push_by_unknowns,
    rate_of_row,
    set_alone,
)
from carom.persistent.joint_load import LOAD_ROUNDS, renew_loads
from carom.persistent.joint_rows import greatest_load, is_driven
from carom.persistent.settle import add_product, dot, greatest, settle, solve_regular

SHARES = 6  # rounds until the compliances of stick are found


@kernel
def bound_per_force(system, point, closed_point):
    """Return the greatest impulse in the rows of rolling or pivoting for a unit normal one: d over a length."""
    contact = system.contacts[closed_point.contact]
    return arm_of_torque(system.laws, contact, closed_point.motion) / point.length


@unit
def solve_springs(k, group) -> bool:
    """Write the forces of given modes, and accelerations of all points; return whether they exist.

    `c` has the accelerations without forces. `kind` is SLIDING for points that slide along `heading`, and
    `presses` is 1 for those that press at first.
    """
    for turn in range(LOAD_ROUNDS):
        if not forces_of_springs(k, group):
            return False
        if not renew_loads(k, 1.0, True, turn, group):
            return True
    return False


@kernel
def forces_of_springs(k, group):
    """Write the forces of given modes under given loads of joints, as `solve_springs` does."""
    push, rounds = greatest_load(k, group), 0
    if push == 0.0 and moves_freely(k, group):
        for row in range(3 * k):
            group.p[row], group.a[row] = 0.0, 0.0
        return True
    soften(k, group)
    for turn in range(3 * k + 4):
        for i in range(k):
            group.closed[i].rows = rows_of(k, i, group)
        n = factor_rows(k, group)
        changed = first_forces(k, n, turn, push, group)
        if changed < 0:
            return False
        if changed == 0:
            rounds += 1
            if rounds > SHARES or not grip(k, group):
                return True
    return False


@kernel
def moves_freely(k, group):
    """Return whether nothing presses the points together: they have no acceleration without forces.

    Sixty balls that fall as they touch have 133 points, and a factor of their rows takes 10 ms.
    """
    for i in range(k):
        if group.closed[i].motion != MOTION_POINT:
            return False
    return greatest(3 * k, group.problem.c) == 0.0


@kernel
def rows_of(k, i, group):
    """Return the number of given rows of a point.

    A torque that keeps a body from turning on another is not needed where points of these two alone do so:
    three that press from rolling, two that stick from pivoting.
    """
    closed_point = group.closed[i]
    if closed_point.parent == CONSTANT:
        return 0 if group.problem.kind[i] == SLIDING else 1
    if closed_point.motion == MOTION_POINT:
        return 0 if closed_point.presses == 0 else 1 if group.problem.kind[i] == SLIDING else 3
    if group.problem.kind[i] == SLIDING or group.closed[closed_point.parent].presses == 0:
        return 0
    press, stick = 0, 0
    for j in range(k):
        other = group.closed[j]
        if other.motion == MOTION_POINT and other.presses == 1 and of_same_bodies(i, j, group):
            press, stick = press + 1, stick + (0 if group.problem.kind[j] == SLIDING else 1)
    if closed_point.motion == MOTION_ROLL:
        return 0 if press > 2 else 2
    return 0 if stick > 1 else 1


@kernel
def of_same_bodies(i, j, group):
    """Return whether two entries are between the same two bodies."""
    p, q = group.points[0][i], group.points[0][j]
    return (p.a == q.a and p.b == q.b) or (p.a == q.b and p.b == q.a)


@kernel
def factor_rows(k, group):
    """List the given rows, write R P F^T and the factor of R P F^T + eps S; return their number."""
    equations, n, last = group.equations, list_given(k, group), last_torque(k, group)
    rows, A = equations.rows, equations.A
    if knows_arms(equations):
        for i in range(n):
            write_push(last, rows[i], softness_of(group, rows[i]), group)
        factor_by_bodies(n, rows, equations)
        return n
    for i in range(n):
        for j in range(n):
            A[i, j] = response(last, group, rows[i], rows[j])
    factor(n, rows, group)
    return n


@kernel
def factor(n, rows, group):
    """Write the factor of A + eps S, with the compliances S of the given rows."""
    A, L = group.equations.A, group.equations.factor
    for i in range(n):
        for j in range(n):
            L[i, j] = A[i, j]
        L[i, i] += softness_of(group, rows[i])
    _, products = lu.factor(L, n, group.equations.pivot, 0.0)
    group.equations.iterations[FACTORED] += products // 9 + n * n


@kernel
def count_factors(group, step):
    """Add the work of the factors of a step, or of an activation, to the work of the island."""
    step.counts[COUNT_FACTORS] += group.equations.iterations[FACTORED]


@kernel
def given(group, row):
    """Return whether a row is given and moves its point; that of a torque or joint follows its bound."""
    closed_point = group.closed[row // 3]
    first = 1 if closed_point.motion != MOTION_POINT else 0
    return first <= row % 3 < first + closed_point.rows and moves(group, row)


@kernel
def list_given(k, group):
    """List the given rows; return their number."""
    n = 0
    for row in range(3 * k):
        if given(group, row):
            group.equations.rows[n], n = row, n + 1
    return n


@inlined
def own(group, row):
    """Return the acceleration in a row by a unit force along it."""
    return group.own[row, row % 3]


@kernel
def note_own(k, group):
    """Copy the blocks of W of each point."""
    for row in range(3 * k):
        for a in range(3):
            group.own[row, a] = group.problem.W[row, row - row % 3 + a]


@kernel
def rate_by_forces(k, row, group):
    """Return the acceleration in a row by the forces in `p`, whose motion the bodies have (`place_forces`)."""
    if knows_arms(group.equations):
        return rate_of_row(group.equations.arms[row], group.equations)
    return dot(3 * k, group.problem.W[row], group.p)


@kernel
def place_forces(k, p, group):
    """Write the motion of the bodies by the forces p, if the group is solved by bodies."""
    if knows_arms(group.equations):
        push_by_forces(k, group.equations, p)


@kernel
def compliance_of(group, row):
    """Return the compliance of a row: that of its point, or of its torque, which is as soft as stick."""
    closed_point = group.closed[row // 3]
    if closed_point.motion != MOTION_POINT:
        return closed_point.stick * own(group, row)
    return closed_point.hold if row % 3 > 0 else closed_point.spring


@kernel
def softness_of(group, row):
    """Return eps S of a row: what the factor adds to its response."""
    return limits.PROXIMAL_SPRING * compliance_of(group, row)


@kernel
def soften(k, group):
    """Let all stick hold alike."""
    for i in range(k):
        group.closed[i].hold = group.closed[i].stick


@kernel
def grip(k, group):
    """Let the compliances of stick be as 1/(mu N), as those of micro-slip are; return whether one changes."""
    closed, most, base, count, changed = group.closed, 0.0, 0.0, 0, False
    for i in range(k):
        if closed[i].motion == MOTION_POINT and closed[i].rows == 3 and closed[i].presses == 1:
            count += 1
            bound = group.problem.mu[i] * group.p[3 * i]
            if bound > most:
                most, base = bound, closed[i].stick
    if count < 2 or not LOADED_PART * most > 0.0:
        return False
    for i in range(k):
        if closed[i].motion == MOTION_POINT and closed[i].rows == 3 and closed[i].presses == 1:
            bound = group.problem.mu[i] * group.p[3 * i]
            hold = base * most / max(bound, LOADED_PART * most)
            changed = changed or abs(hold - closed[i].hold) > REMAINDER * hold
            closed[i].hold = hold
    return changed


@kernel
def moves(group, row):
    """Return whether a force along a row moves its point; if not, its W is round-off (planar motion)."""
    n = row - row % 3
    if group.closed[row // 3].parent == CONSTANT:
        return row % 3 == 1 and not is_driven(group, row // 3)
    return own(group, row) > ROUND_OFF * (own(group, n) + own(group, n + 1) + own(group, n + 2))


@kernel
def last_torque(k, group):
    """Return the number of entries up to the last that is a torque of a point, 0 if none is."""
    while k > 0 and group.closed[k - 1].motion == MOTION_POINT:
        k -= 1
    return k


@kernel
def response(last, group, a, row):
    """Return the acceleration in row a by a unit force along a given row, with its friction.

    `last` is the number of entries up to the last torque.
    """
    W, i = group.problem.W, row // 3
    total = W[a, row]
    if row % 3 > 0:
        return total
    if group.problem.kind[i] == SLIDING:
        d = group.problem.heading[i]
        total -= group.problem.mu[i] * (d[0] * W[a, row + 1] + d[1] * W[a, row + 2])
    for j in range(i + 1, last):
        if turns_with(group, j, i):
            d = group.problem.heading[j]
            total -= group.problem.mu[j] * (d[0] * W[a, 3 * j + 1] + d[1] * W[a, 3 * j + 2])
    return total


@kernel
def write_push(last, row, compliance, group):
    """Write the motion by a unit force along a given row, with its friction, and its compliance."""
    arm, i = group.equations.arms[row], row // 3
    set_alone(group.equations, row, compliance)
    if row % 3 == 0 and group.problem.kind[i] == SLIDING:
        add_friction(arm, i, group)
    for j in range(i + 1, last if row % 3 == 0 else i):
        if turns_with(group, j, i):
            add_friction(arm, j, group)


@kernel
def add_friction(arm, i, group):
    """Add the motion by the friction of entry i to the push of a unit normal force."""
    d, mu, arms = group.problem.heading[i], group.problem.mu[i], group.equations.arms
    for side in range(2):
        first, second = arms[3 * i + 1].motion[side], arms[3 * i + 2].motion[side]
        for j in range(6 if arm.body[side] >= 0 else 0):
            arm.push[side, j] -= mu * (d[0] * first[j] + d[1] * second[j])


@kernel
def turns_with(group, j, i):
    """Return whether entry j is a torque of rotation that the normal force of point i bounds."""
    closed_point = group.closed[j]
    torque = closed_point.motion != MOTION_POINT
    return torque and closed_point.parent == i and group.problem.kind[j] == SLIDING


@kernel
def first_forces(k, n, turn, push, group):
    """Solve for the forces; return how many points begin or cease to press, -1 if the rows cannot be met."""
    p, equations, closed = group.p, group.equations, group.closed
    rows, x, r = equations.rows, equations.x, equations.r
    for row in range(3 * k):
        p[row] = 0.0
    for i in range(k):
        if closed[i].parent == CONSTANT and group.problem.kind[i] == SLIDING:
            p[3 * i + 1] = -group.problem.mu[i] * group.problem.heading[i, 0]
    write_wanted(k, n, group, x)
    solve_regular(n, equations, x)
    for i in range(n):
        add_force(k, group, rows[i], x[i])
    write_wanted(k, n, group, r)
    enough, small = limits.EQUATION_ERROR * push, limits.FORCE_ERROR * push
    left = settle(n, 1.0, enough, small, greatest(3 * k, p), equations)
    if not left <= limits.DEPENDENT_ERROR * push:
        return -1
    for i in range(n):
        add_force(k, group, rows[i], x[i])
    # one that in turn would press alone and be pulled with its stick stays free if it does not move
    changed = load(k, n, push, group) if turn < 2 * k else 0
    if changed == 0:
        changed = unload(k, turn < k, group)
    if changed == 0:
        note_accelerations(k, group)
        if turn >= 2 * k and sinks(k, push, group):
            return -1
    return changed


@kernel
def write_wanted(k, n, group, out):
    """Write the accelerations that the given rows lack under the forces in `p`."""
    rows, by_bodies = group.equations.rows, knows_arms(group.equations)
    place_forces(k, group.p, group)
    for i in range(n):
        out[i] = -acceleration_in(k, rows[i], by_bodies, group)


@kernel
def acceleration_in(k, row, by_bodies, group):
    """Return the acceleration in a row under the forces in `p`, or `by_bodies` in the motion of these."""
    if by_bodies:
        rate = rate_of_row(group.equations.arms[row], group.equations)
        return group.problem.c[row] + rate
    return acceleration_of(k, row, group)


@kernel
def sinks(k, push, group):
    """Return whether a point whose spring is free accelerates into its surface."""
    for i in range(k):
        one = group.closed[i]
        if one.motion == MOTION_POINT and one.presses == 0 and one.weight > 0.0:
            if group.a[3 * i] < -limits.NO_MARGIN * push:
                return True
    return False


@kernel
def load(k, n, push, group):
    """Load the free springs of points that are deeper than the others let them be; return how many.

    With eps all give way: the accelerations are less by eps R P F^T mu, R P F^T mu = S lam in the given rows.
    """
    closed, equations, p, free = group.closed, group.equations, group.p, False
    rows, r = equations.rows, equations.r
    for i in range(k):
        free = free or (
            closed[i].motion == MOTION_POINT and closed[i].presses == 0 and closed[i].weight > 0.0
        )
    if not free:
        return 0
    most, force, count, last = 0.0, 0.0, 0, last_torque(k, group)
    for i in range(n):
        r[i] = compliance_of(group, rows[i]) * p[rows[i]]
        if rows[i] % 3 == 0:  # stick is far softer
            most, force = max(most, abs(r[i])), max(force, abs(p[rows[i]]))
    settle(n, 0.0, limits.SPRING_ERROR * most, 0.0, 0.0, equations)
    by_bodies = knows_arms(equations)
    if by_bodies:
        push_by_forces(k, equations, p)
        push_by_unknowns(n, rows, equations, -limits.PROXIMAL_SPRING, equations.x)
    for i in range(k):
        row = 3 * i
        if closed[i].motion == MOTION_POINT and closed[i].presses == 0 and closed[i].weight > 0.0:
            a = acceleration_in(k, row, by_bodies, group)
            for j in range(0 if by_bodies else n):
                soft = limits.PROXIMAL_SPRING * response(last, group, row, rows[j])
                a -= soft * equations.x[j]
            if a < -max(ROUND_OFF * push, LAST_DIGIT * force * own(group, row)):
                closed[i].presses, count = 1, count + 1
                # its force is small at first: with the stick of others it would be torn open again
                closed[i].hold = closed[i].stick / LOADED_PART
    return count


@kernel
def unload(k, together, group):
    """Unload the springs that pull, all `together` or those that pull most; return how many."""
    p, closed, most, worst, count = group.p, group.closed, 0.0, 0.0, 0
    for i in range(k):
        if closed[i].motion == MOTION_POINT:
            most, worst = max(most, p[3 * i]), min(worst, p[3 * i])
    limit = -GROUP_ERROR * most if together else min(worst, -GROUP_ERROR * most)
    for i in range(k):
        if closed[i].motion != MOTION_POINT or closed[i].presses == 0:
            continue
        if p[3 * i] < 0.0 and p[3 * i] <= limit:
            closed[i].presses, count = 0, count + 1
            for row in range(3 * i, 3 * i + 3):
                p[row] = 0.0
    return count


@kernel
def acceleration_of(k, row, group):
    """Return the acceleration in a row under the forces in `p`."""
    return add_product(group.problem.c[row], 3 * k, group.problem.W[row], group.p)


@kernel
def note_accelerations(k, group):
    """Write the accelerations of all points under the forces in `p`."""
    by_bodies = knows_arms(group.equations)
    place_forces(k, group.p, group)
    for row in range(3 * k):
        group.a[row] = acceleration_in(k, row, by_bodies, group)


@kernel
def add_force(k, group, row, x):
    """Add a force along a given row; with a normal force, its friction of slip, rolling and pivoting."""
    p, i = group.p, row // 3
    p[row] += x
    if row % 3 > 0:
        return
    if group.problem.kind[i] == SLIDING:
        for r in range(2):
            p[row + 1 + r] -= group.problem.mu[i] * group.problem.heading[i, r] * x
    for j in range(i + 1, k):
        if turns_with(group, j, i):
            for r in range(2):
                p[3 * j + 1 + r] -= group.problem.mu[j] * group.problem.heading[j, r] * x
