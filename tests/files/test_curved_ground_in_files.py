"""Height fields and surfaces of functions in files, pickles and copies: functions only by name."""

import pickle

import numpy as np
import pytest

import carom

S = carom.surfaces
BOX = [(-1, -1, -1), (1, 1, 1)]
GIVEN = {
    "own.shape.function": lambda x, y, z: z - 0.1 * x * x,
    "three.shape.function": lambda x, y, z: z,
    "three.shape.gradient": lambda x, y, z: (0.0, 0.0, 1.0),
    "three.shape.hessian": lambda x, y, z: np.zeros((3, 3)),
}


def scene():
    one = carom.Scene()
    x = np.linspace(-1, 1, 21)
    one.add_surface(S.HeightField(0.5 * (x[:, None] ** 2 + x**2), 0.1), name="field")
    own, *three = GIVEN.values()
    one.add_surface(S.Surface(own, BOX), position=(0, 0, -3), name="own")
    one.add_surface(S.Surface(three[0], BOX, *three[1:]), position=(0, 0, -9), name="three")
    one.add_body(carom.Sphere(0.1), mass=1, position=(0.3, 0, 0.5), name="ball")
    one.set_contact_default(friction=0.3, restitution=0.4)
    return one


def test_files(tmp_path):
    solution = carom.simulate(scene(), 0.6)
    solution.save(tmp_path / "run.nc")
    bare = carom.Solution.load(tmp_path / "run.nc")
    assert np.array_equal(bare.scene["field"].shape.heights, scene()["field"].shape.heights)
    assert bare.scene["own"].shape.bend == scene()["own"].shape.bend
    with pytest.raises(
        RuntimeError, match=r"the function 'own.shape.function' .* is not in the file"
    ):
        carom.simulate(bare.scene, 0.6)
    whole = carom.Solution.load(tmp_path / "run.nc", functions=GIVEN)
    assert np.array_equal(carom.simulate(whole.scene, 0.6).position, solution.position)


def test_pictures_of_a_run_without_its_functions(tmp_path):
    pytest.importorskip("PIL")
    solution = carom.simulate(scene(), 0.1)
    solution.save(tmp_path / "run.nc")
    picture = carom.films.still(carom.Solution.load(tmp_path / "run.nc"), size=(64, 48))
    assert np.any(picture < 200)  # the field is drawn


def test_pickles_and_copies():
    one = scene()
    one.remove("own")
    one.remove("three")
    solution = carom.simulate(one, 0.6)
    for other in (pickle.loads(pickle.dumps(one)), one.copy()):
        assert np.array_equal(carom.simulate(other, 0.6).position, solution.position)
