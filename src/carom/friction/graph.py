"""The order in which the bodies of a crowd or of a large group are eliminated; new when other bodies touch.

Bodies are neighbours if they may touch, or if joints transfer an impulse from one to the other. The body with
the fewest neighbours is eliminated first; its neighbours become neighbours of each other (minimum degree, with
rows of bits). The tests have a simple form in Python for comparison (`references.island_graph`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from carom._compiled.decorators import entry, kernel
from carom.friction.layout import ContactWork

WORD = 63  # bits of a row in one int64


class Graph(NamedTuple):
    """Workspace to find an order of elimination for up to K points of N bodies."""

    count: np.ndarray  # (4,) bodies, points, updates (-1: no room), pairs
    body: np.ndarray  # (K, 3) bodies of each point, and the last of its others
    other: np.ndarray  # (R,) bodies that impulses move through joints
    near: np.ndarray  # (N, words) neighbours, one bit each
    degree: np.ndarray  # (N,) number of neighbours, -1 after elimination
    rank: np.ndarray  # (N,) place in the order


def new_graph(bodies: int, points: int, others: int) -> Graph:
    """Return the workspace for `bodies` and `points`, of which `others` bodies are moved through joints."""
    count, other, degree, rank = (np.zeros(n, dtype=np.int64) for n in (4, others, bodies, bodies))
    body = np.zeros((points, 3), dtype=np.int64)
    near = np.zeros((bodies, bodies // WORD + 1), dtype=np.int64)
    return Graph(count=count, body=body, other=other, near=near, degree=degree, rank=rank)


@entry
def find_order(n, k, graph, problem):
    """Write the lists for the present bodies and points, unless they are known; return False without room."""
    link = problem.link
    known = graph.count[0] == n and graph.count[1] == k
    for i in range(k):
        for side in range(2):
            if graph.body[i, side] != link[i].body[side]:
                known, graph.body[i, side] = False, link[i].body[side]
        if graph.body[i, 2] != link[i].others_end:
            known, graph.body[i, 2] = False, link[i].others_end
        for e in range(link[i].others, link[i].others_end):
            if graph.other[e] != problem.other[e].body:
                known, graph.other[e] = False, problem.other[e].body
    for i in range(k):
        if link[i].spans == 1:  # blocks have the rows of two bodies: there are only sweeps
            return False
    if known:
        return graph.count[2] >= 0
    graph.count[0], graph.count[1], graph.count[2] = n, k, -1
    begin(n, k, graph, problem)
    if not eliminate(n, graph, problem) or not write_updates(n, graph, problem):
        return False
    write_corners(k, graph, problem)
    return True


@kernel
def of_present_size(n, graph, work):
    """Return a problem with arrays cut to the present numbers of bodies and blocks."""
    pairs, updates = graph.count[3], graph.count[2]
    return ContactWork(
        kind=work.kind, contact=work.contact, vector=work.vector, count=work.count, mismatch=work.mismatch,
        W=work.W, matrix=work.matrix, pivot=work.pivot, active=work.active, link=work.link, path=work.path,
        other=work.other, body=work.body[:n], place=work.place[:n], later=work.later[:pairs],
        target=work.target[:updates], block=work.block[: n + 2 * pairs],
    )  # fmt: skip


@kernel
def begin(n, k, graph, problem):
    """Write the rows of bits of all bodies."""
    near, degree, link, other = graph.near, graph.degree, problem.link, problem.other
    words = n // WORD + 1
    for b in range(n):
        degree[b] = 0
        for w in range(words):
            near[b, w] = 0
    for i in range(k):
        a, b = link[i].body[0], link[i].body[1]
        meet(graph, a, b)
        for e in range(link[i].others, link[i].others_end):
            meet(graph, a, other[e].body)
            meet(graph, b, other[e].body)


@kernel
def meet(graph, a, b):
    """Mark two bodies as neighbours; either may be -1, the ground."""
    near, degree = graph.near, graph.degree
    if a >= 0 and b >= 0 and a != b and near[a, b // WORD] >> (b % WORD) & 1 == 0:
        near[a, b // WORD] |= 1 << (b % WORD)
        near[b, a // WORD] |= 1 << (a % WORD)
        degree[a] += 1
        degree[b] += 1


@kernel
def eliminate(n, graph, problem):
    """Write the order, and for each body its later neighbours; return False if there is no room."""
    place, later = problem.place, problem.later
    near, degree, rank, words, pairs = graph.near, graph.degree, graph.rank, n // WORD + 1, 0
    for t in range(n):
        b = -1
        for i in range(n):
            if degree[i] >= 0 and (b < 0 or degree[i] < degree[b]):
                b = i
        if pairs + degree[b] > later.shape[0]:
            return False
        place[t].body, place[t].pair, rank[b] = b, pairs, t
        for w in range(words):
            bits, i = near[b, w], w * WORD
            while bits != 0:
                if bits & 1 == 1:
                    later[pairs] = i
                    pairs += 1
                bits >>= 1
                i += 1
        place[t].pairs_end, degree[b] = pairs, -1
        for s in range(place[t].pair, pairs):
            merge(graph, later[s], b, words)
    graph.count[3] = pairs
    return True


@kernel
def merge(graph, i, b, words):
    """Give body i the neighbours of b, which is eliminated."""
    near, count = graph.near, 0
    for w in range(words):
        near[i, w] |= near[b, w]
    near[i, i // WORD] &= ~(1 << (i % WORD))
    near[i, b // WORD] &= ~(1 << (b % WORD))
    for w in range(words):
        bits = near[i, w]
        while bits != 0:
            bits &= bits - 1
            count += 1
    graph.degree[i] = count


@kernel
def block_of(i, j, graph, problem):
    """Return the block of bodies i and j: right of the diagonal if i comes first, otherwise below it."""
    if i == j:
        return i
    n, later = graph.count[0], problem.later
    first, second = (i, j) if graph.rank[i] < graph.rank[j] else (j, i)
    place = problem.place[graph.rank[first]]
    low, high = place.pair, place.pairs_end
    while low < high:
        middle = (low + high) // 2
        if later[middle] < second:
            low = middle + 1
        else:
            high = middle
    return n + low + (0 if first == i else graph.count[3])


@kernel
def write_updates(n, graph, problem):
    """Write which blocks each elimination changes; return False if there is no room."""
    at = 0
    for t in range(n):
        place = problem.place[t]
        d = place.pairs_end - place.pair
        if at + d * d > problem.target.shape[0]:
            return False
        place.update = at
        for s in range(place.pair, place.pairs_end):
            for r in range(place.pair, place.pairs_end):
                row = problem.target[at]
                row[0], row[1] = s, r
                row[2] = block_of(problem.later[s], problem.later[r], graph, problem)
                at += 1
        place.updates_end = at
    graph.count[2] = at
    return True


@kernel
def write_corners(k, graph, problem):
    """Write the blocks of the bodies of each point."""
    for i in range(k):
        link = problem.link[i]
        for r in range(2):
            for s in range(2):
                a, b = link.body[r], link.body[s]
                link.corner[r, s] = block_of(a, b, graph, problem) if a >= 0 and b >= 0 else -1
        for e in range(link.others, link.others_end):
            other = problem.other[e]
            for s in range(2):
                b = link.body[s]
                other.corner[s] = block_of(other.body, b, graph, problem) if b >= 0 else -1
