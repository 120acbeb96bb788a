"""Which face is up, how fair a die is, and the command that throws one."""

import json
from math import erfc

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from carom.cli import main
from carom.studies.ensembles.dice import face_up, fairness
from verified import agree, verifies


@verifies("studies.ensembles.dice.face_up", "quarter turns of a die", "closed form")
def test_faces_of_known_orientations():
    turns = {
        6: Rotation.identity(), 1: Rotation.from_euler("x", np.pi),
        # a quarter turn about x takes y up; about -y it takes x up
        4: Rotation.from_euler("x", np.pi / 2), 3: Rotation.from_euler("x", -np.pi / 2),
        5: Rotation.from_euler("y", -np.pi / 2), 2: Rotation.from_euler("y", np.pi / 2),
    }  # fmt: skip
    for face, turn in turns.items():
        for about in np.linspace(0.0, 6.0, 5):
            Q = (Rotation.from_euler("z", about) * turn).as_quat(scalar_first=True)
            agree(face_up(Q), face)
    tilted = Rotation.from_euler("x", 0.01).as_quat(scalar_first=True)
    assert face_up([tilted, np.full(4, np.nan)]).tolist() == [0, 0]


@verifies(
    "studies.ensembles.dice.fairness",
    r"$\chi^2$, its tail for five degrees, Wilson's intervals",
    "closed form",
)
def test_fairness_in_numbers():
    """chi^2 = sum (n - 100)^2/100 = 8.72; Wilson at z = 1.96 for 120 of 600: .1700 to .2339."""
    counts = [120, 90, 110, 96, 84, 100]
    found = fairness(np.repeat(np.arange(1, 7), counts))
    assert found.counts.tolist() == counts
    agree(found.chi_square, sum((n - 100) ** 2 for n in counts) / 100, rtol=1e-12)
    z, n, p = 1.959963984540054, 600, 0.2
    middle, half = p + z * z / (2 * n), z * np.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    agree(found.low[0], (middle - half) / (1 + z * z / n), rtol=1e-12)
    agree(found.high[0], (middle + half) / (1 + z * z / n), rtol=1e-12)
    # five degrees: P(> x) = erfc(sqrt(x/2)) + sqrt(2 x/pi) e^(-x/2) (1 + x/3)
    x = found.chi_square
    tail = erfc(np.sqrt(x / 2)) + np.sqrt(2 * x / np.pi) * np.exp(-x / 2) * (1 + x / 3)
    agree(found.p_value, tail, rtol=1e-10)
    with pytest.raises(ValueError, match="at least one"):
        fairness([0, 0])


def thrown(capsys, *arguments):
    code = main(["throw", "--json", *arguments])
    said = capsys.readouterr()
    return code, json.loads(said.out) if said.out else said.err


def test_a_fair_die_and_a_loaded_one(capsys):
    """A tenth of the throws of the study: the weight under face 1 keeps it down."""
    code, fair = thrown(capsys, "--count", "120", "--height", "0.1", "--step", "4e-3")
    assert code == 0
    assert fair["at_rest_on_a_face"] == 120
    assert fair["p_value"] > 1e-3
    assert fair["throws_per_second"] > 0
    code, loaded = thrown(
        capsys, "--count", "120", "--height", "0.1", "--step", "4e-3", "--load", "0.6"
    )
    assert code == 0
    assert loaded["p_value"] < 1e-6
    assert loaded["faces"]["6"]["low"] > loaded["faces"]["1"]["high"]


def test_saved_and_said_in_words(capsys, tmp_path):
    pytest.importorskip("zarr")
    arguments = [
        "throw",
        "--count",
        "10",
        "--height",
        "0.05",
        "--save",
        str(tmp_path / "dice.zarr"),
    ]
    assert main(arguments) == 0
    first = capsys.readouterr().out
    assert "10 throws (10 success)" in first
    assert "chi-square" in first
    assert main(arguments) == 0  # nothing is left to do
    again = capsys.readouterr().out
    assert again.splitlines()[1:] == first.splitlines()[1:]


def test_wrong_arguments(capsys):
    assert main(["throw", "--load", "1.5"]) == 2
    assert "--load must be" in capsys.readouterr().err
    assert main(["throw", "--count", "0"]) == 2
    assert "runs must be" in capsys.readouterr().err
