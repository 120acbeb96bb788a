"""The graph of joints: a forest, or closed loops, and an order of elimination for each."""

from __future__ import annotations

import heapq
from collections import deque

import numpy as np

from carom.model.arrays import LOOSE, ONE_WAY


class Sets:
    """Disjoint sets of numbers below `count`, each a set of its own at first."""

    def __init__(self, count: int):
        self.root = list(range(count))

    def find(self, i: int) -> int:
        """Return the number that stands for the set of i."""
        while self.root[i] != i:
            self.root[i] = self.root[self.root[i]]
            i = self.root[i]
        return i

    def join(self, i: int, j: int) -> bool:
        """Join the sets of i and j; return whether they were two. That of i stands for both."""
        a, b = self.find(i), self.find(j)
        self.root[b] = a
        return a != b


def is_forest(count: int, kind, parent, child) -> bool:
    """Return whether no joint closes a loop (the ground is one node) and each can carry its child."""
    if any(k in LOOSE for k in kind):
        return False
    trees = Sets(count + 1)
    return all(trees.join(c, p if p >= 0 else count) for p, c in zip(parent, child))


def cannot_flip(kind) -> np.ndarray:
    """Return (J,) True for joints that carry a tree from parent to child only: a line or plane of one body."""
    return np.isin(kind, ONE_WAY)


def forest_order(count: int, parent, child) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Walk the forest from the ground, then from the first body of each floating tree.

    Returns
    -------
    order : (N,)
        Bodies, parents before children.
    joint : (N,)
        The joint that carries each body, -1 for a floating body.
    flipped : (J,)
        True if a joint is walked from its child to its parent.
    """
    touching = [[] for _ in range(count + 1)]
    for j, (p, c) in enumerate(zip(parent, child)):
        touching[p if p >= 0 else count].append(j)
        touching[c].append(j)
    order, joint, flipped = [], np.full(count, -1), np.zeros(len(parent), dtype=bool)
    seen = np.zeros(count + 1, dtype=bool)
    for start in (count, *range(count)):
        if seen[start]:
            continue
        seen[start] = True
        queue = deque([start])
        while queue:
            b = queue.popleft()
            if b < count:
                order.append(b)
            for j in touching[b]:
                p = parent[j] if parent[j] >= 0 else count
                other = child[j] if p == b else p
                if not seen[other]:
                    seen[other] = True
                    joint[other], flipped[j] = j, p != b
                    queue.append(other)
    return np.array(order, dtype=np.int64), joint, flipped


def elimination(touching: list[list[int]]) -> tuple[list[int], list[list[int]]]:
    """Order the elements by least degree and return the fill: neighbours of each that come later.

    Two elements are neighbours if they share a movable body, as in A M^-1 A^T; `touching` lists the bodies of
    each.
    """
    count = len(touching)
    by_body: dict[int, list[int]] = {}
    for j, bodies in enumerate(touching):
        for b in bodies:
            by_body.setdefault(b, []).append(j)
    near = [set() for _ in range(count)]
    for joints in by_body.values():
        for j in joints:
            near[j].update(joints)
    for j in range(count):
        near[j].discard(j)
    heap = [(len(near[j]), j) for j in range(count)]
    heapq.heapify(heap)
    done, order, later = [False] * count, [], [[] for _ in range(count)]
    while heap:
        degree, j = heapq.heappop(heap)
        if done[j] or degree != len(near[j]):
            continue
        done[j] = True
        order.append(j)
        later[j] = sorted(near[j])
        for i in near[j]:
            near[i] |= near[j]
            near[i] -= {i, j}
            heapq.heappush(heap, (len(near[i]), i))
    return order, later
