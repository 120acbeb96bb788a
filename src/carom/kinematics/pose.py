"""Poses that a back end stores: it uses its results again until a pose changes.

This saves time because the end of a step is the first stage of the next, and impulses at several contact points
act in the same position. Poses are compared bit by bit.
"""

from __future__ import annotations

from carom._compiled.decorators import kernel


@kernel
def keep_pose(body, row):
    """Write the pose of a body into the first seven numbers of a row."""
    x, Q = body.x, body.Q
    row[0], row[1], row[2] = x[0], x[1], x[2]
    row[3], row[4], row[5], row[6] = Q[0], Q[1], Q[2], Q[3]


@kernel
def keep_poses(state, rows):
    """Write the poses of all bodies into as many rows as there are."""
    for b in range(rows.shape[0]):
        keep_pose(state[b], rows[b])


@kernel
def same_pose(rows, state):
    """Return whether the poses in the rows are those of the state; False for no rows, or NaN."""
    for b in range(rows.shape[0]):
        row, x, Q = rows[b], state[b].x, state[b].Q
        if not (x[0] == row[0] and x[1] == row[1] and x[2] == row[2]):
            return False
        if not (Q[0] == row[3] and Q[1] == row[4] and Q[2] == row[5] and Q[3] == row[6]):
            return False
    return rows.shape[0] > 0
