"""A curved solid, or a profile, on a half-space: its lowest points, and how they move while it rotates.

With the normal u in axes of the solid, u' = -W x u, the lowest point p is the farthest one along -u, so that
p' = -H u' = H (W x u), with the Hessian H of the support function (`support.change_of_support`). A vertex and a
point fixed to a rim have p' = 0.

While v and w are constant, the velocity at the point, v + w x r, changes at the rate w x r', with
r' = w x r_core + R p'.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.collision.faces import LOWEST
from carom.collision.features import vertex_a
from carom.collision.layout import CYLINDER, PROFILE, Placed, Plane
from carom.collision.plane import plane_unit
from carom.collision.support import change_of_support
from carom.contact.kinds import half_space
from carom.contact.kinds.curvature import curvature, place_and_axes
from carom.contact.kinds.found_points import bend, further
from carom.contact.kinds.partner import pose_of
from carom.contact.kinds.profile_drift import drift_of_profile
from carom.contact.kinds.rim import in_solid
from carom.geometry.rotation import cross, rotate
from carom.kinematics.contact_point import field_along, in_axes

room, stays_far = half_space.room, half_space.stays_far


@kernel
def list_touches(system, contact, state, reach, work):
    """Write the lowest points of a solid into work.touches; return how many."""
    solid, pose = system.solids[contact.solid], work.solid_pose
    x, q = pose_of(solid, contact.body, state)
    pose[0, 0], pose[0, 1], pose[0, 2] = x
    pose[0, 3], pose[0, 4], pose[0, 5], pose[0, 6] = q
    plane, a = Plane(contact.axes[0], contact.offset), Placed(solid, pose[0, :3], pose[0, 3:])
    far = further(system, contact, state, reach)
    plane_unit(a, plane, system.hulls, far, work.pair, work.touches)
    bend(system, contact, state, work)
    return work.pair.state[0].total


@kernel
def way_past(contact, data):
    """Return 0: no body can pass through a half-space unseen."""
    return 0.0


@kernel
def curvatures(system, contact, point, state):
    """Return those of the solid: t t, t s, s s."""
    return curvature(system, contact.solid, contact.body, state, place_and_axes(point, state))


@kernel
def drift(system, contact, feature, point, state, work):
    """Return (d/dt G) v of the lowest point of a solid."""
    if system.solids[contact.solid].kind == PROFILE:
        return drift_of_profile(system, contact, -1, point, state)
    return roll_on_plane(system, contact, feature, point, state)


@kernel
def way_of_lowest(solid, feature, u, W):
    """Return p', in axes of the solid, for the normal u and the angular velocity W there."""
    if solid.kind == CYLINDER and vertex_a(feature) < LOWEST:
        return 0.0, 0.0, 0.0
    return change_of_support(solid, u, cross(W[0], W[1], W[2], u[0], u[1], u[2]))


@kernel
def roll_on_plane(system, contact, feature, point, state):
    """Return (d/dt G) v of a point of a curved solid on a half-space, contact axes."""
    solid, body, E = system.solids[contact.solid], state[contact.body], point.axes
    q, s, w, r = body.Q, solid.Q, body.w, point.arm_a
    u, W = in_solid(solid, contact, 0, state, E[0]), in_solid(solid, contact, 0, state, w)
    p = way_of_lowest(solid, feature, u, W)
    p = rotate(s, p)
    p = rotate(q, p)
    # the ball that enlarges a core does not turn
    c = cross(
        w[0], w[1], w[2],
        r[0] + solid.radius * E[0, 0], r[1] + solid.radius * E[0, 1], r[2] + solid.radius * E[0, 2],
    )  # fmt: skip
    c = (c[0] + p[0], c[1] + p[1], c[2] + p[2])
    a = cross(w[0], w[1], w[2], c[0], c[1], c[2])
    u = in_axes(point, a[0], a[1], a[2])
    if point.moves == 1:  # the place moves with v + c, `contact_acceleration` has v
        s = field_along(point, c)
        u = (u[0], u[1] - s[1], u[2] - s[2])
    return u
