"""What a record of an impact says: names of what strikes what, and a record for each point of a blow."""

import numpy as np
import pytest

import carom

TILT = 0.3
TILTED = (np.cos(0.5 * TILT), 0.0, np.sin(0.5 * TILT), 0.0)  # about y: an edge along y is lowest


def cube(scene, **more):
    return scene.add_body(
        carom.Box(0.1, 0.1, 0.1),
        mass=1.0,
        position=(0, 0, 0.3),
        orientation=TILTED,
        name="cube",
        **more,
    )


@pytest.fixture(scope="module")
def on_a_slab():
    """The edge of a cube strikes a slab that floats: both ends of the edge."""
    scene = carom.Scene()
    slab = carom.Box(0.5, 0.5, 0.1)
    scene.add_body(slab, mass=3.0, position=(0, 0, 0), velocity=(0, 0, 1.0), name="slab")
    cube(scene)
    scene.set_contact_default(restitution=0.5, friction=0.2)
    return carom.simulate(scene, 0.21, step=1e-3)


def test_pairs_are_a_table_with_rows(on_a_slab):
    pairs = on_a_slab.pairs
    assert len(pairs) == len(pairs.body) == len(list(pairs))
    assert pairs[0] == {
        "body": pairs.body[0],
        "other": pairs.other[0],
        "plane": pairs.plane[0],
        "law": 0,
    }
    assert repr(pairs).startswith(f"<PairTable: {len(pairs)} rows\n  body = ")
    with pytest.raises(IndexError, match="there is no row"):
        pairs[len(pairs)]


def test_a_slice_of_a_table_is_a_table(on_a_slab):
    for table in (on_a_slab.impacts, on_a_slab.events, on_a_slab.pairs, on_a_slab.forces):
        part = table[1:3]
        assert type(part) is type(table)
        assert len(part) == len(range(len(table))[1:3])
        for name, column in vars(table).items():
            if isinstance(column, np.ndarray):
                np.testing.assert_array_equal(getattr(part, name), column[1:3])
    assert on_a_slab.impacts[1:3][0].time == on_a_slab.impacts.time[1]


def test_pairs_by_default_have_names(on_a_slab):
    blow = on_a_slab.impacts[0]
    assert (blow.name, blow.body, blow.other) == ("slab-cube", "slab", "cube")
    table = on_a_slab.to_pandas().impacts
    assert table[["contact", "body", "other"]].iloc[0].tolist() == ["slab-cube", "slab", "cube"]
    assert "slab-cube" in repr(on_a_slab.impacts)


def test_each_end_of_an_edge_has_a_record_with_its_share(on_a_slab):
    impacts = on_a_slab.impacts
    first = impacts.time == impacts.time[0]
    assert impacts.together[first].tolist() == [2, 2]
    assert sorted(impacts.point[first, 1].round(12)) == [-0.05, 0.05]
    # equal by symmetry; together they are what changes the motion of the slab
    assert impacts.impulse[first][0] == pytest.approx(impacts.impulse[first][1], abs=1e-12)
    before = on_a_slab.evaluate(impacts.time[0], side="left")
    after = on_a_slab.evaluate(impacts.time[0])
    push = np.sum(impacts.impulse[first, 0]) * impacts.normal[0]
    assert 3.0 * (after[2][0] - before[2][0])[2] == pytest.approx(push[2], rel=1e-12)
    last = on_a_slab.ledger.impacts[-1]
    assert np.sum(impacts.energy_change) == pytest.approx(last, rel=1e-12)


def test_an_edge_that_strikes_the_ground_evenly_is_one_point():
    scene = carom.Scene()
    ground = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="ground")
    scene.add_contact(cube(scene), ground, restitution=0.5, friction=0.2)
    blow = carom.simulate(scene, 0.25, step=1e-3).impacts[0]
    assert (blow.name, blow.body, blow.other) == ("cube-ground", "cube", "ground")
    assert blow.together == 1
    assert blow.point[1] == pytest.approx(0.0, abs=1e-12)  # its middle


def test_stops_have_names():
    scene = carom.Scene(gravity=(0, 0, 0))
    arm = scene.add_body(
        mass=1.0,
        inertia=(1, 1, 1),
        position=(1, 0, 0),
        velocity=(0, 1, 0),
        angular_velocity=(0, 0, 1),
        name="arm",
    )
    hinge = scene.add_joint(
        carom.joints.Revolute((0, 0, 0), (0, 0, 1)), carom.GROUND, arm, name="hinge"
    )
    scene.add_stop(hinge, upper=0.1, restitution=0.5, name="buffer")
    blow = carom.simulate(scene, 0.2, step=1e-2).impacts[0]
    assert (blow.name, blow.body, blow.other) == ("buffer", "arm", "GROUND")
