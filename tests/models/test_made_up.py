"""Models that ask for too much, in other encodings, or broken: an error in bounded time and memory."""

import random
import time
from pathlib import Path

import numpy as np
import pytest

import carom

pytest.importorskip("mujoco")
BALL = '<body pos="0 0 1"><freejoint/><geom type="sphere" size=".1" mass="1"/></body>'


def model(inner, before=""):
    return f"<mujoco>{before}<worldbody>{inner}</worldbody></mujoco>"


@pytest.fixture
def little(monkeypatch):
    """Less memory than such models would take: two gigabytes more than there is now."""
    resource, table = pytest.importorskip("resource"), Path("/proc/self/statm")
    if not table.exists():
        pytest.skip("needs to know how much memory there is now")
    kind, used = resource.RLIMIT_AS, int(table.read_text().split()[0]) * resource.getpagesize()
    before = resource.getrlimit(kind)
    resource.setrlimit(kind, (used + (2 << 30), before[1]))
    yield
    resource.setrlimit(kind, before)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        (model(f'<replicate count="2000000">{BALL}</replicate>'), "20000 elements at most"),
        (model(f'<replicate count="300"><replicate count="300">{BALL}</replicate></replicate>'),
         "20000 elements at most"),
        (model(f'<replicate count="1e300">{BALL}</replicate>'), "<replicate> count must be at most 1e.30"),
        (model('<flexcomp type="grid" count="400 400 400" spacing="1 1 1" name="f"/>'),
         "20000 elements at most"),
        (model(BALL.replace('".1"', '"1e300"')), r"<geom> size must be at most 1e\+30, got '1e300'"),
        (model(BALL.replace('mass="1"', 'mass="1e300"')), "<geom> mass must be"),
        (model(BALL, '<asset><hfield name="h" nrow="100000" ncol="100000" size="1 1 1 1"/></asset>'),
         "<hfield> nrow x ncol must be at most 67108864"),
        (model(BALL, '<custom><numeric name="a" size="900000000" data="0"/></custom>'), "<numeric>"),
        ('<!DOCTYPE a [<!ENTITY a "aaaa">]>' + model(BALL), "not valid XML|not define entities"),
        (model("<body>" * 5000 + "</body>" * 5000), "cannot be read"),
        (model(BALL)[:-9], "is not valid XML"),
    ],
)  # fmt: skip
def test_too_much(text, what, little):
    begin = time.process_time()
    with pytest.raises(ValueError, match=what):
        carom.load_model(text if text.startswith("<m") else f"<?xml version='1.0'?>{text}")
    assert time.process_time() - begin < 5.0


@pytest.mark.parametrize("name", ["memory", "njmax", "nuser_body", "nkey", "nuserdata"])
def test_sizes_of_what_is_not_used(name, little):
    """They ask for memory that a scene does not need, and get none."""
    text = model(BALL, f'<size {name}="{"900G" if name == "memory" else 2_000_000_000}"/>')
    assert len(carom.load_model(text).scene.bodies) == 1


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "iso-8859-1"])
def test_encodings(encoding, tmp_path):
    named = BALL.replace("<body ", '<body name="Würfel" ')
    file = tmp_path / "model.xml"
    declared = encoding.removesuffix("-sig")
    file.write_bytes(f'<?xml version="1.0" encoding="{declared}"?>{model(named)}'.encode(encoding))
    assert carom.load_model(file).scene.bodies[0].name == "Würfel"


def test_another_encoding_than_it_says(tmp_path):
    file = tmp_path / "model.xml"
    file.write_bytes(model(BALL.replace("<body ", '<body name="Würfel" ')).encode("iso-8859-1"))
    with pytest.raises(ValueError, match=r"model\.xml is not valid XML: not well-formed"):
        carom.load_model(file)
    file.write_text('<?xml version="1.0" encoding="klingon"?>' + model(BALL))
    with pytest.raises(ValueError, match=r"model\.xml is not valid XML: unknown encoding"):
        carom.load_model(file)
    file.write_text(model(f'{BALL}<include file="more.xml"/>'), encoding="utf-16")
    with pytest.raises(ValueError, match="includes other files, so it must be in UTF-8"):
        carom.load_model(file)


def test_included_files_count(tmp_path):
    (tmp_path / "more.xml").write_text(f"<mujocoinclude>{BALL * 10}</mujocoinclude>")
    file = tmp_path / "model.xml"
    file.write_text(model('<replicate count="1000"><include file="more.xml"/></replicate>'))
    with pytest.raises(ValueError, match="20000 elements at most"):
        carom.load_model(file)


def test_damaged_files(tmp_path):
    """Some bytes of a model are others: a ValueError, or a model still; any other error fails."""
    text = model(
        f'<geom type="plane" size="1 1 1"/>{BALL}<body><joint name="j"/><geom size=".1"/></body>'
    )
    rng, file, refused = random.Random(2), tmp_path / "model.xml", 0
    for _ in range(150):
        data = bytearray(text.encode())
        for _ in range(rng.randrange(1, 4)):
            data[rng.randrange(len(data))] = rng.choice([rng.randrange(256), *b"015 <e"])
        file.write_bytes(data[: rng.choice([len(data)] * 5 + [rng.randrange(len(data))])])
        try:
            carom.load_model(file)
        except ValueError:
            refused += 1
    assert 0 < refused < 150  # both happen


WRIST = """
<mujoco><compiler angle="radian"/><option timestep="1e-4" gravity="0 0 0"/><worldbody>
<body name="base" euler=".3 .2 .1"><freejoint/><geom type="box" size=".3 .2 .1" contype="0" conaffinity="0"/>
<body name="hand" pos="0 0 .3" euler="0 .4 .2"><joint name="wrist" type="ball" range="0 1.2"/>
<geom type="box" size=".1 .05 .2" pos="0 0 .2" contype="0" conaffinity="0"/></body></body>
</worldbody></mujoco>
"""


def test_the_range_of_a_ball_joint_is_that_of_its_rotation():
    """It is the angle of the four numbers of `qpos`."""
    q = [0, 0, 1, 1, 0, 0, 0, np.cos(0.4), *(np.sin(0.4) * np.array([0.6, 0.0, 0.8]))]
    v = [0.1, 0, 0, 0.5, 0.2, 0, 1.5, 2.0, 1.0]
    model = carom.load_model(WRIST, qpos=q, qvel=v, limit_restitution=0.5)
    assert "wrist" not in str(model.report)
    solution = carom.simulate(model.scene, 1.0, step=0.005)
    place = model.qpos(solution)[:, 7:11]
    angle = 2.0 * np.arctan2(np.linalg.norm(place[:, 1:], axis=1), np.abs(place[:, 0]))
    assert angle[0] == pytest.approx(0.8, abs=1e-12)
    assert len(solution.impacts) >= 1
    assert angle.max() <= 1.2 + 1e-9
    assert angle.max() > 1.15
