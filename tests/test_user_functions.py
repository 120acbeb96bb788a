"""Functions of the user: what is made of them is made once, and they see the numbers of the run."""

import numba
import numpy as np

import carom
from carom._compiled import user_functions
from carom.bench.problems import chain

TURN = 0.3  # rad/s


def driven(motion):
    """Return a rod on a hinge whose angle is a function of time."""
    made = chain.scene()
    made.add_constraint(carom.constraints.Driver(made.joints[0], motion=motion))
    return made


def angle(t):
    return 0.5 * TURN * t * t, TURN * t, TURN


def test_a_compiled_function_is_compiled_once_for_all_runs(monkeypatch):
    made = []

    code_of = user_functions.code_of

    def counted(function, signature):
        made.append(signature)
        return code_of(function, signature)

    monkeypatch.setattr(user_functions, "code_of", counted)
    compiled = numba.njit(angle)
    scene = driven(compiled)
    ends = [carom.simulate(scene, 1.0, step=0.01).position[-1] for _ in range(2)]
    ends.append(carom.simulate(driven(compiled), 1.0, step=0.01).position[-1])
    ends.append(carom.simulate(driven(angle), 1.0, step=0.01).position[-1])
    assert len(made) == 1
    # the rod of 1 m turns by TURN/2 about y, downwards
    known = 0.5 * np.array([np.cos(TURN / 2), 0.0, -np.sin(TURN / 2)])
    np.testing.assert_allclose(ends, np.broadcast_to(known, (4, 1, 3)), atol=1e-8)


def test_arrays_are_the_numbers_at_their_address():
    """A place is looked up again after more places than are kept, and what is written there is seen."""
    places = [np.full(6, float(k)) for k in range(2 * user_functions.MOST_PLACES)]
    arrays = user_functions.Arrays((2, 3))
    for turn in range(2):
        for k, place in enumerate(places):
            place += 1.0
            np.testing.assert_array_equal(
                arrays[place.ctypes.data], np.full((2, 3), k + turn + 1.0)
            )
            assert len(arrays) <= user_functions.MOST_PLACES
    assert arrays[places[-1].ctypes.data] is arrays[places[-1].ctypes.data]
