"""Rods with limits: closed forms of blows at both ends, energy, files and errors."""

import numpy as np
import pytest

import carom
from carom import GROUND, joints
from carom.visual.bodies import links_of
from verified import agree, verifies

G = 9.81


def pair(speed=0.0, gravity=0.0, **limits):
    """Two balls of 1 and 3 kg, 1 m from each other along x; the second moves."""
    scene = carom.Scene(gravity=(0, 0, -gravity))
    for name, x, v in (("a", 0.0, 0.0), ("b", 1.0, speed)):
        scene.add_body(
            carom.Sphere(0.05), mass=1.0 if name == "a" else 3.0, position=(x, 0, 0),
            velocity=(v, 0, 0), name=name,
        )  # fmt: skip
    made = scene.add_joint(joints.Distance((0, 0, 0), (1, 0, 0), **limits), "a", "b", name="rod")
    return scene, made


@verifies("joints.Distance", r"impulse $(1 + e)\,v/(1/m_a + 1/m_b)$", "closed form")
@pytest.mark.parametrize("e", [0.0, 0.5, 1.0])
@pytest.mark.parametrize(
    ("limits", "speed", "way"),
    [
        ({"upper": 1.5}, 2.0, 0.5),
        ({"lower": 0.25}, -2.0, 0.75),
        ({"lower": 0.25, "upper": 1.5}, 2.0, 0.5),
    ],
)
def test_a_blow_at_an_end(e, limits, speed, way):
    # At t = way/|v| an impulse (1 + e) v/(1/m_a + 1/m_b); momentum stays, e of the relative speed comes back.
    scene, _ = pair(speed, **limits, restitution=e)
    t = way / abs(speed)
    run = carom.simulate(scene, 1.2 * t)
    assert run.success
    agree(run.impacts.time[0], t, atol=1e-14)
    agree(run.impacts.impulse[0, 0], (1.0 + e) * abs(speed) * 0.75, rtol=1e-14)
    relative = run.velocity[-1, 1, 0] - run.velocity[-1, 0, 0]
    agree(relative, -e * speed, atol=1e-13)
    agree(run.velocity[-1, 0, 0] + 3.0 * run.velocity[-1, 1, 0], 3.0 * speed, rtol=1e-6)
    agree(run.ledger.impacts[-1], -0.5 * 0.75 * speed**2 * (1.0 - e**2), atol=1e-13)


def test_between_both_ends_it_goes_to_and_fro():
    # e = 1: a period of 2 (upper - lower)/|v| of the relative motion
    scene, rod = pair(2.0, lower=0.5, upper=1.5, restitution=1.0)
    run = carom.simulate(scene, 5.0)
    np.testing.assert_allclose(run.impacts.time, 0.25 + 0.5 * np.arange(10), atol=1e-12)
    assert run.impacts.contact.tolist() == [rod.upper.index, rod.lower.index] * 5
    assert np.ptp(run.total_energy) < 1e-13


def test_a_strut_carries_a_load_and_a_cord_does_not():
    # A ball on a strut of lower length 1 above a hinge stays by the force m g until it is pushed aside.
    scene = carom.Scene(gravity=(0, 0, -G))
    scene.add_body(carom.Sphere(0.05), mass=2.0, position=(0, 0, 1.0), name="ball")
    scene.add_joint(joints.Distance((0, 0, 0), (0, 0, 1), lower=1.0), GROUND, "ball", name="strut")
    run = carom.simulate(scene, 1.0)
    assert run.velocity[-1, 0, 2] == pytest.approx(0.0, abs=1e-13)
    assert run["strut"].force[-1, 0] == pytest.approx(2.0 * G, abs=1e-10)
    scene.replace("strut", lower=0.5)
    free = carom.simulate(scene, 0.2)
    assert free.position[-1, 0, 2] == pytest.approx(1.0 - 0.5 * G * 0.04, abs=1e-13)


@verifies("joints.Distance", r"a mass leaves its strut at $\cos\varphi = 2/3$", "closed form")
def test_a_pendulum_that_leaves_its_strut():
    # On a sphere of radius L a mass slides off a strut at cos phi = 2/3, from rest at the top.
    phi = 1e-3
    scene = carom.Scene(gravity=(0, 0, -G))
    top = (np.sin(phi), 0, np.cos(phi))
    scene.add_body(carom.Sphere(0.05), mass=2.0, position=top, name="ball")
    scene.add_joint(joints.Distance((0, 0, 0), top, lower=1.0), GROUND, "ball")
    run = carom.simulate(scene, 4.0, rtol=1e-9)
    opens = run.events.time[run.events.kind == "opens"]
    position = run.evaluate(opens[0])[0][0, 2]
    agree(position, 2.0 / 3.0 * np.cos(phi), atol=1e-8)


def test_what_is_made_and_kept(tmp_path):
    scene, rod = pair(2.0, lower=0.5, upper=1.5)
    assert (rod.lower.name, rod.upper.name) == ("rod.lower", "rod.upper")
    assert not scene.joints
    assert [link.kind for link in links_of(scene)] == ["rod"]
    _, one = pair(2.0, lower=0.5)
    assert (one.name, one.lower, one.upper) == ("rod", 0.5, None)
    pytest.importorskip("h5netcdf")
    run = carom.simulate(scene, 1.0)
    run.save(tmp_path / "run.nc")
    again = carom.simulate(carom.Solution.load(tmp_path / "run.nc").scene, 1.0)
    assert np.array_equal(again.position, run.position)
    unnamed = carom.Scene()
    for x in (0.0, 1.0):
        unnamed.add_body(carom.Sphere(0.05), mass=1.0, position=(x, 0, 0))
    for k in (1, 2):
        made = unnamed.add_joint(
            joints.Distance((0, 0, 0), (1, 0, 0), lower=0.5, upper=2.0), *unnamed.bodies
        )
        assert made.upper.name == f"rod{k}.upper"


def test_wrong_limits():
    with pytest.raises(ValueError, match=r"lower must be below upper, got 2 and 1\.5"):
        joints.Distance((0, 0, 0), (1, 0, 0), lower=2.0, upper=1.5)
    with pytest.raises(ValueError, match="lower must be finite and at least 0, got -1"):
        joints.Distance((0, 0, 0), (1, 0, 0), lower=-1.0)
    with pytest.raises(ValueError, match=r"stop 'rod' of 'a-b' must not be exceeded"):
        carom.simulate(pair(lower=1.2)[0], 0.1)
    scene, _ = pair()
    with pytest.raises(ValueError, match="lower and upper must be left out of a rod that is rigid"):
        scene.replace("rod", lower=0.5)
    with pytest.raises(ValueError, match="must be left out of a Distance, which has anchors"):
        scene.add_joint(
            joints.Distance((0, 0, 0), (1, 0, 0), upper=2.0), "a", "b", parent_frame=((0, 0, 0), (1, 0, 0, 0)),
        )  # fmt: skip
