"""Damage is seen before anything is read; what is made up, with a right digest, is looked at."""

import json
import os
import random
import re
import time

import h5py
import numpy as np
import pytest

import carom
from carom.io.files import sealed
from files.compare import differences
from files.made_up import parts_of, rewrite
from files.scenes import everything

REFUSED = r"path must be a file of a run, got '.*run\.nc': "


def test_every_place_counts(path):
    # one bit of one byte, in turn through the file: HDF5, the arrays, the index and the line at the end
    whole = path.read_bytes()
    rng = random.Random(1)
    last = range(len(whole) - sealed.LENGTH, len(whole))
    for place in [*(rng.randrange(len(whole)) for _ in range(150)), *last]:
        broken = bytearray(whole)
        broken[place] ^= 1 << rng.randrange(8)
        path.write_bytes(broken)
        with pytest.raises(ValueError, match=REFUSED):
            carom.Solution.load(path)


@pytest.mark.parametrize("seed", range(60))
def test_what_disks_do(seed, path):
    # cut short, longer, blocks of zeros, parts of the file in the wrong place
    rng, whole = random.Random(seed), path.read_bytes()
    a, b = sorted(rng.randrange(len(whole)) for _ in range(2))
    broken = [
        whole[:a], whole + bytes(rng.randrange(256) for _ in range(rng.randrange(1, 600))),
        whole[:a] + b"\0" * 512 + whole[a + 512 :], whole[b:] + whole[:b],
        whole[:a] + whole[b:], whole[:a] + whole[: b - a] + whole[b:],
    ][seed % 6]  # fmt: skip
    path.write_bytes(broken)
    if broken != whole:
        with pytest.raises(ValueError, match=REFUSED):
            carom.Solution.load(path)


def test_changed_by_another_program(path):
    with h5py.File(path, "a") as file:
        file.attrs["note"] = "measured on a Monday"
    with pytest.raises(ValueError, match="HDF5 without the end that carom writes"):
        carom.Solution.load(path)


def test_no_file_to_read_from(tmp_path):
    os.mkfifo(tmp_path / "run.nc")
    with pytest.raises(ValueError, match=REFUSED + "it is not a regular file"):
        carom.Solution.load(tmp_path / "run.nc")


def test_nothing_outside_the_file_is_read(thrown, path, tmp_path):
    """Links and arrays of HDF5 that lie in other files: HDF5 does not open what carom reads."""
    secret = tmp_path / "secret"
    secret.write_bytes(np.arange(200.0).tobytes())
    _, index = parts_of(path)
    made = tmp_path / "made.h5"
    with h5py.File(made, "w") as file:
        file.create_dataset("time", (51,), "f8", external=[(str(secret), 0, 408)])
        file["position"] = h5py.ExternalLink(str(secret), "/position")
        file["velocity"] = h5py.SoftLink("/time")
    index["arrays"] = {name: [kind, 0] for name, (kind, _) in index["arrays"].items()}
    path.write_bytes(b"".join(sealed.seal([made.read_bytes() + bytes(50000)], index)))
    try:
        again = carom.Solution.load(path)
    except ValueError:
        return
    assert secret.read_bytes()[8:16] not in again.t.tobytes()
    assert again.t.tobytes() != np.arange(51.0).tobytes()


def changed(place, value):
    """A change of one entry of an index."""

    def change(index):
        for key in place[:-1]:
            index = index[key]
        index[place[-1]] = value

    return change


@pytest.mark.parametrize(
    ("place", "value", "what"),
    [
        (("sizes", "time"), 10**15, "too short for its sizes"),
        (("sizes", "time"), -1, "size of time must be"),
        (("sizes", "body"), 2, "it has 1 bodies, and 2 rows"),
        (("sizes", "event"), 3.5, "size of event must be a whole number"),
        (("arrays", "position", 1), 10**18, "place of position must be"),
        (("arrays", "position", 1), -8, "place of position must be"),
        (("arrays", "position", 0), "|O", "type of position must be one of"),
        (("arrays", "impact_contact", 0), "<f8", "impact_contact is of type"),
        (("arrays", "held_saved"), [], "ValueError"),
        (("words", "impact_law"), "9", "impact_law has 1 rows|out of bounds"),
        (("attributes", "settings"), "{}", "KeyError"),
        (("attributes", "settings"), '{"duration": -1}', "missing or broken"),
        (("attributes", "options"), '{"heaps": 3}', "heaps"),
        (("attributes", "status"), "FINE", "FINE"),
        (("attributes", "stats"), '{"steps": "many"}', "steps must be a number"),
        (("checkpoint",), {"found": {}, "arrays": {"x": ["|O", [1], 0, 8]}}, "is not an array"),
        (("checkpoint",), {"found": {"spots": -1}, "arrays": {}}, "spots must be"),
        (("scene",), "{", "its scene is broken: the text"),
        (("scene",), None, "its scene is broken: the text"),
    ],
)  # fmt: skip
def test_made_up_index(place, value, what, path):
    rewrite(path, changed(place, value))
    with pytest.raises(ValueError, match=rf"{REFUSED}.*({what})"):
        carom.Solution.load(path)


def test_no_scene(path):
    rewrite(path, lambda index: index.pop("scene") and None)
    with pytest.raises(ValueError, match=REFUSED + "its scene is broken: the text"):
        carom.Solution.load(path)


@pytest.mark.parametrize("column", ["impact_contact", "event_contact", "records/snapshot_body"])
def test_numbers_that_do_not_exist(column, path):
    body, index = parts_of(path)
    start = index["arrays"][column][1]
    broken = body[:start] + (10**6).to_bytes(8, "little") + body[start + 8 :]
    rewrite(path, lambda index: None, broken)
    with pytest.raises(ValueError, match="numbers outside 0 to 0, which do not exist"):
        carom.Solution.load(path)


@pytest.mark.parametrize("text", ['{"a": NaN}', "[" * 10**5, "[]", "9" * 5000, "{"])
def test_broken_index(text, path):
    body, _ = parts_of(path)
    parts = [body, text.encode(), (sealed.BEFORE % (sealed.FORMAT, len(text))).encode()]
    digest = sealed.hashlib.sha256(b"".join(parts)).hexdigest()
    path.write_bytes(b"".join(parts) + f"{digest}\n".encode())
    with pytest.raises(ValueError, match=REFUSED + "its index is broken"):
        carom.Solution.load(path)


SOME = [
    None, True, 0, -1, 3, 1e308, 10**400, "", "nan", [], [1.0], {}, {"tuple": []}, {"number": "inf"},
    {"part": "body1"}, {"shape": 10**9}, {"type": "Body"}, {"dtype": "O", "of": [1], "array": [1]},
]  # fmt: skip


def places(data, place=()):
    """All places in a tree of JSON."""
    if place:
        yield place
    for key in (
        data if isinstance(data, dict) else range(len(data)) if isinstance(data, list) else ()
    ):
        yield from places(data[key], (*place, key))


def test_made_up_scenes():
    """One value in a scene is another one: it is refused by a ValueError, or it is a scene still."""
    from carom.io.files.scene_parts import scene_from_text, scene_to_text

    rng, text = random.Random(5), scene_to_text(everything())
    where, told = list(places(json.loads(text))), []
    count = len(everything().bodies)
    for _ in range(200):
        data = json.loads(text)
        changed(rng.choice(where), rng.choice(SOME))(data)
        try:
            scene, _ = scene_from_text(json.dumps(data))
        except ValueError as error:
            told.append(str(error))
        else:
            assert len(scene.bodies) == count
    assert len(told) > 150
    assert all(
        re.match(r"the text|(shapes|parts)(\[\d+\])?|gravity|contacts|robot|look", one)
        for one in told
    )


@pytest.mark.plain
@pytest.mark.parametrize(
    ("change", "what"),
    [
        (changed(("parts", 1, "mass"), -1.0), r"parts\[1\]: mass must be finite and above 0"),
        (changed(("parts", 1, "position"), [1.0]), r"parts\[1\]: position must have shape \(3,\)"),
        (changed(("parts", 2, "name"), "ground"), r"parts\[2\]: name must be unique"),
        (changed(("parts", 2, "orientation"), [1.0, 1, 1, 1]), r"parts\[2\]: orientation must be a"),
        (changed(("shapes", 0, "radius"), 10**400), r"shapes\[0\]: "),
        (changed(("parts",), {}), "parts: "),
    ],
)  # fmt: skip
def test_a_scene_says_where_it_is_wrong(change, what):
    from carom.io.files.scene_parts import scene_from_text, scene_to_text

    data = json.loads(scene_to_text(everything()))
    change(data)
    with pytest.raises(ValueError, match=what):
        scene_from_text(json.dumps(data))


def test_a_small_file_takes_little(path):
    """Zeros and deflated arrays of a checkpoint are made only where the run has such arrays."""
    arrays = {"clock": ["<f8", [10**12], 0, 0], "now": ["<f8", [10**12], 0, 8]}
    rewrite(path, lambda index: index.update(checkpoint={"found": {}, "arrays": arrays}))
    begin = time.perf_counter()
    again = carom.Solution.load(path)
    assert time.perf_counter() - begin < 5.0
    assert differences(again, again) == []
