"""The graph of an island: bodies are neighbours when they touch; eliminated by least degree.

Python, once for each graph: the numeric part only follows the lists that are made here.
"""

from __future__ import annotations

import heapq
from functools import lru_cache

import numpy as np

from carom._compiled.record_arrays import table
from carom.friction.layout import PLACE
from references.island_arrays import IslandGraph


def island_graph(bodies: int, body: np.ndarray) -> IslandGraph:
    """Return the graph of contacts between `body` (k, 2); kept for the next call with the same contacts."""
    return _graph(bodies, np.ascontiguousarray(body, dtype=np.int64).tobytes())


@lru_cache(maxsize=32)
def _graph(bodies: int, raw: bytes) -> IslandGraph:
    body = np.frombuffer(raw, dtype=np.int64).reshape(-1, 2)
    order, later = _elimination(bodies, body)
    rank = np.empty(bodies, dtype=np.int64)
    rank[order] = np.arange(bodies)
    pair = {(b, i): n for n, (b, i) in enumerate((b, i) for b in order for i in later[b])}
    pairs = len(pair)

    def block(row, column):
        if row == column:
            return row
        if rank[row] < rank[column]:
            return bodies + pair[row, column]
        return bodies + pairs + pair[column, row]

    place = table(PLACE, bodies)
    target = []
    for n, b in enumerate(order):
        done = int(place.pairs_end[n - 1]) if n else 0
        place[n] = (b, done, done + len(later[b]), len(target), len(target) + len(later[b]) ** 2)
        target += [(pair[b, i], pair[b, j], block(i, j)) for i in later[b] for j in later[b]]
    corner = np.full((len(body), 2, 2), -1, dtype=np.int64)
    for c, ends in enumerate(body.tolist()):
        for i in range(2):
            for j in range(2):
                if ends[i] >= 0 and ends[j] >= 0:
                    corner[c, i, j] = block(ends[i], ends[j])
    return IslandGraph(
        place=place,
        later=np.array([i for b in order for i in later[b]], dtype=np.int64),
        target=np.array(target, dtype=np.int64).reshape(-1, 3),
        corner=corner,
    )


def _elimination(bodies: int, body: np.ndarray) -> tuple[list[int], list[list[int]]]:
    """Return the bodies in order of least degree, and of each the neighbours that come later."""
    near = [set() for _ in range(bodies)]
    for a, b in np.unique(body, axis=0).tolist():
        if a >= 0 and b >= 0 and a != b:
            near[a].add(b)
            near[b].add(a)
    heap = [(len(near[b]), b) for b in range(bodies)]
    heapq.heapify(heap)
    done, order, later = [False] * bodies, [], [[] for _ in range(bodies)]
    while heap:
        degree, b = heapq.heappop(heap)
        if done[b] or degree != len(near[b]):
            continue
        done[b] = True
        order.append(b)
        later[b] = sorted(near[b])
        for i in near[b]:
            near[i] |= near[b]
            near[i] -= {i, b}
            heapq.heappush(heap, (len(near[i]), i))
    return order, later
