"""Contacts of two bodies that touch by default come when these come near each other: no motion knows of it."""

import numpy as np
import pytest

import carom
from carom.io.files.checkpoint import capture
from carom.io.files.kept import run_again
from carom.io.files.writing import write
from carom.model import contact_rows
from carom.stepping.settings import checked_settings
from carom.studies.ensembles.again import Again
from carom.studies.values import find_targets

R = 0.01
ALLOWED = carom.Options(energy_tolerance=0.1)


def swarm(shape, count=70, pull=0.0, speed=1.0):
    """Bodies of about the same size in a box, at places of a grid that are shaken, with random velocities."""
    side, rng = int(np.ceil(count ** (1 / 3))), np.random.default_rng(count)
    cell = 2.6 * R
    scene = carom.Scene(gravity=(0, 0, -pull))
    for axis in np.eye(3):
        scene.add_half_space((0, 0, 0), axis)
        scene.add_half_space(side * cell * axis, -axis)
    grid = np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3)
    for place in grid[:count]:
        scene.add_body(
            shape, mass=0.1, position=(place + 0.5) * cell + 0.2 * R * rng.uniform(-1, 1, 3),
            velocity=speed * rng.normal(size=3),
        )  # fmt: skip
    scene.set_contact_default(restitution=0.6, friction=0.2)
    return scene


def from_the_start(monkeypatch, few):
    """Let up to so many pairs of bodies have contacts from the start."""
    monkeypatch.setattr(contact_rows, "FEW_PAIRS", few)


def ends(solution, numbers):
    """What contacts are of: body, other body, half-space."""
    pairs = solution.pairs
    return np.stack([pairs.body, pairs.other, pairs.plane], axis=1)[numbers]


def assert_same_motion(one, two):
    for name in ("position", "orientation", "velocity", "angular_velocity", "held_residual"):
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name))
    for name in ("impacts", "events", "contacts", "forces"):
        a, b = getattr(one, name), getattr(two, name)
        for column in (name for name in vars(a) if not name.startswith("_")):
            x, y = getattr(a, column), getattr(b, column)
            if column == "contact":
                x, y = ends(one, x), ends(two, y)
            np.testing.assert_array_equal(x, y, err_msg=f"{name}.{column}")


DUMBBELL = carom.Compound(
    [(carom.Sphere(0.5 * R), (0.4 * R, 0, 0)), (carom.Sphere(0.5 * R), (-0.4 * R, 0, 0))]
)


@pytest.mark.parametrize(
    ("shape", "count", "pull", "speed", "duration"),
    [
        (carom.Sphere(R), 70, 0.0, 1.0, 0.05),
        (carom.Sphere(R), 30, 9.81, 0.2, 0.15),  # they fall into a heap, taken whole
        (carom.Box(R, R, R), 20, 9.81, 0.2, 0.08),
        (DUMBBELL, 20, 0.0, 0.5, 0.05),
    ],
)
def test_the_motion_is_that_with_all_contacts_from_the_start(
    monkeypatch, shape, count, pull, speed, duration
):
    """Bit for bit: contacts of an island are in the order of the scene, whenever they came."""
    found = []
    for few in (10**9, 0):
        from_the_start(monkeypatch, few)
        scene = swarm(shape, count, pull, speed)
        found.append(carom.simulate(scene, duration, step=1e-3, options=ALLOWED))
    every, later = found
    assert len(every.impacts) > 5
    assert len(every.pairs.body) == 6 * count + count * (count - 1) // 2
    assert 6 * count < len(later.pairs.body) < len(every.pairs.body)
    assert_same_motion(every, later)


def test_contacts_are_of_pairs_that_came_near():
    """Of 70 balls that fly, two that touch have one; two that stay a diameter and their ways apart none."""
    step = 1e-3
    s = carom.simulate(swarm(carom.Sphere(R), 70), 20 * step, step=step, options=ALLOWED)
    pairs, first = s.pairs, 6 * 70
    assert np.all(pairs.other[:first] == -1)
    known = set(zip(pairs.body[first:].tolist(), pairs.other[first:].tolist()))
    assert len(known) == len(pairs.body) - first  # each once
    fastest = np.max(np.linalg.norm(s.velocity, axis=2))
    for i in range(70):
        for j in range(i + 1, 70):
            least = np.min(np.linalg.norm(s.position[:, i] - s.position[:, j], axis=1))
            if least <= 2 * R:
                assert (i, j) in known
            # balls hold the body, its way in a step at twice the greatest speed, and the body once more
            elif least > 2 * (2 * R + 2 * fastest * step) + 2 * fastest * step:
                assert (i, j) not in known
    between = s.pairs.other[s.impacts.contact] >= 0
    assert between.any()
    for k in np.flatnonzero(between)[::8].tolist():  # a number of a contact names both bodies
        row = s.impacts[k]
        (i, j, plane), t = ends(s, row.contact), row.time
        assert plane == -1
        x = s.evaluate(t)[0]
        assert np.linalg.norm(x[i] - x[j]) == pytest.approx(2 * R, abs=1e-9)
        assert np.linalg.norm(row.point - x[i]) == pytest.approx(R, abs=1e-9)


def test_few_bodies_have_all_contacts_from_the_start():
    """Up to 64 the numbers are those of the scene."""
    s = carom.simulate(swarm(carom.Sphere(R), 64), 1e-3, step=1e-3)
    assert len(s.pairs.body) == 6 * 64 + 64 * 63 // 2
    assert s._run.found is None


def test_joined_bodies_have_all_contacts_from_the_start(monkeypatch):
    from_the_start(monkeypatch, 0)
    scene = swarm(carom.Sphere(R), 8)
    body = scene.bodies[0]
    scene.add_joint(carom.joints.Spherical(body.position), carom.GROUND, body)
    s = carom.simulate(scene, 1e-3, step=1e-3, options=carom.Options(project_start=True))
    assert len(s.pairs.body) == 6 * 8 + 8 * 7 // 2


def row_of_balls(materials=(None,)):
    """Six balls on a line, each at rest but the first, without gravity."""
    scene = carom.Scene(gravity=(0, 0, 0))
    for k in range(6):
        scene.add_body(
            carom.Sphere(R), mass=1.0, position=(3 * R * k, 0, 0), velocity=(1.0 if k == 0 else 0.0, 0, 0),
            material=materials[k % len(materials)],
        )  # fmt: skip
    return scene


def test_pairs_that_are_ignored_or_have_their_own_contact(monkeypatch):
    """Ball 0 goes through ball 1 and strikes 2, by the law of their contact; that strikes 3 by default."""
    from_the_start(monkeypatch, 0)
    scene = row_of_balls()
    b = scene.bodies
    own = scene.add_contact(b[2], b[0], restitution=1.0)
    scene.set_contact_default(restitution=0.5)
    scene.ignore_contact(b[1], b[0])
    s = carom.simulate(scene, 0.15, step=1e-3)
    np.testing.assert_array_equal(ends(s, s.impacts.contact[:2]), [[2, 0, -1], [2, 3, -1]])
    assert s.impacts.contact[0] == own.index == 0
    np.testing.assert_array_equal(s.impacts.restitution[:2], [1.0, 0.5])
    np.testing.assert_array_equal(s.position[:, 1], s.position[:1, 1] + np.zeros((len(s.t), 1)))
    found = ends(s, slice(None))[:, :2].tolist()
    assert [0, 1] not in found
    assert [0, 2] not in found


def test_materials_give_the_law_of_each_pair(monkeypatch):
    from_the_start(monkeypatch, 0)
    materials = (carom.Material(0.9, 0.1), carom.Material(0.5, 0.4), carom.Material(0.7, 0.2))
    scene = row_of_balls(materials)
    scene.set_contact_default(combine="min")
    s = carom.simulate(scene, 0.3, step=1e-3)
    assert len({tuple(e) for e in ends(s, s.impacts.contact)}) == 5
    for (i, j, _), e, mu in zip(
        ends(s, s.impacts.contact), s.impacts.restitution, s.impacts.friction
    ):
        law = scene.contact_law(scene.bodies[i], scene.bodies[j])
        assert law is not None
        assert (e, mu) == (law.restitution, law.friction)
        k = s.pairs.body.tolist().index(i)  # each ball is the first of one contact
        assert s.pairs.laws[s.pairs.law[k]] == law


SETTINGS = {
    "duration": 0.03, "step": 1e-3, "method": "rk4", "impact_location": "locate", "save_every": 1,
}  # fmt: skip


def half_way(path):
    """Write a run of which 12 of 30 steps are done; return how many contacts it had."""
    run = run_again(swarm(carom.Sphere(R), 70), SETTINGS, ALLOWED)
    run.go_on(12)
    so_far = carom.Solution._from_run(run, carom.Status.INTERRUPTED)
    write(path, so_far, capture(run), whole=False)
    return len(run.pairs.body)


def test_a_run_goes_on_from_its_file_bit_for_bit(tmp_path):
    """With the same numbers of contacts, though more came after the file was written."""
    first = half_way(tmp_path / "run.nc")
    again = carom.resume(tmp_path / "run.nc")
    whole = carom.simulate(
        swarm(carom.Sphere(R), 70), 0.03, step=1e-3, options=ALLOWED, method="rk4"
    )
    assert len(whole.pairs.body) > first
    kept = carom.Solution.load(tmp_path / "run.nc")
    for s in (again, kept):
        assert_same_motion(whole, s)
        np.testing.assert_array_equal(s.impacts.contact, whole.impacts.contact)
        for column in ("body", "other", "plane", "law"):
            np.testing.assert_array_equal(getattr(s.pairs, column), getattr(whole.pairs, column))
        alone = np.flatnonzero(s.impacts.together == 1)[-1]
        np.testing.assert_array_equal(s.impact_history(alone).t, whole.impact_history(alone).t)
    names = kept.to_xarray()
    i, j = whole.pairs.body[-1], whole.pairs.other[-1]
    assert names.contact.values[-1] == f"body{i + 1}-body{j + 1}"
    assert (names.contact_body.values[-1], names.contact_other.values[-1]) == (i, j)


@pytest.mark.parametrize("pair", [[3, 3], [5, 2], [0, 70], [-1, 4]])
def test_a_file_with_contacts_of_no_pair_is_refused(tmp_path, monkeypatch, pair):
    from carom.io.files import reading

    half_way(tmp_path / "run.nc")
    read = reading._found

    def spoiled(*arguments):
        found = read(*arguments)
        assert found is not None
        found[-1] = pair
        return found

    monkeypatch.setattr(reading, "_found", spoiled)
    with pytest.raises(ValueError, match="contacts of bodies that may not touch"):
        carom.Solution.load(tmp_path / "run.nc")


def test_runs_of_an_ensemble_do_not_know_of_each_other(monkeypatch):
    """Contacts that came in one run are not there in the next."""
    from_the_start(monkeypatch, 0)
    scene = row_of_balls()
    scene.set_contact_default(restitution=0.5)
    speeds = {"body1.velocity": np.array([[1.0, 0, 0], [-1.0, 0, 0], [1.0, 0, 0]])}
    settings = checked_settings(0.1, 1e-3, options=ALLOWED)
    again = Again(scene, settings, find_targets(scene, speeds))
    numbers = []
    for k in range(3):
        run = again.start(speeds, k)
        run.go_on(100)
        numbers.append([run.pairs.body.tolist(), run.pairs.other.tolist(), run.clock.struck[0]])
    assert numbers[0] == numbers[2]
    assert numbers[0][2] > 0
    assert numbers[1] == [[], [], 0]


def test_many_bodies_begin_with_little():
    """2000 balls have 2 million pairs, of which a few thousand are near: a row has 280 bytes."""
    scene = swarm(carom.Sphere(R), 2000, speed=0.1)
    run = run_again(scene, SETTINGS, ALLOWED)
    assert len(run.compiled.system.contacts) == 6 * 2000
    run.go_on(3)
    assert len(run.pairs.body) < 20 * 2000
