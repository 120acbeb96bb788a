"""The order of elimination that the loop finds is that of `references.island_graph`."""

import numpy as np
import pytest

from carom.friction.graph import find_order
from carom.stepping.crowd.layout import new_crowd
from references.island_graph import island_graph


@pytest.mark.plain
@pytest.mark.parametrize("bodies", [2, 9, 63, 64, 150])
def test_same_lists(bodies):
    rng = np.random.default_rng(bodies)
    contacts = 3 * bodies
    body = rng.integers(0, bodies, (contacts, 2))
    body[:, 1] = np.minimum(bodies - 1, body[:, 0] + rng.integers(1, 5, contacts))
    body[body[:, 0] == body[:, 1], 1] = -1
    body[rng.random(contacts) < 0.2, 1] = -1
    crowd = new_crowd(bodies, 1, contacts + 40)
    crowd.problem.link.body[:contacts] = body
    assert find_order(bodies, contacts, crowd.graph, crowd.problem)
    expected = island_graph(bodies, body)
    pairs, updates = len(expected.later), len(expected.target)
    assert crowd.graph.count.tolist() == [bodies, contacts, updates, pairs]
    np.testing.assert_array_equal(crowd.problem.place, expected.place)
    np.testing.assert_array_equal(crowd.problem.later[:pairs], expected.later)
    np.testing.assert_array_equal(crowd.problem.target[:updates], expected.target)
    np.testing.assert_array_equal(crowd.problem.link.corner[:contacts], expected.corner)
    assert find_order(bodies, contacts, crowd.graph, crowd.problem)  # known


def test_without_room_it_says_so():
    """A thousand bodies that all touch need more blocks than there is room for."""
    pairs = np.stack(np.triu_indices(60, 1), axis=1)
    crowd = new_crowd(60, 1, len(pairs))
    tight = crowd._replace(problem=crowd.problem._replace(later=crowd.problem.later[:100]))
    tight.problem.link.body[:] = pairs
    assert not find_order(60, len(pairs), tight.graph, tight.problem)
    assert not find_order(60, len(pairs), tight.graph, tight.problem)  # known, too
