"""Search, resampling, copies of scenes and roll-outs on their own."""

import numpy as np
import pytest

import carom
from carom.studies.identify import Parameter, Recording, State, roll_out, roll_outs, varied
from carom.studies.identify.evaluate import Evaluator
from carom.studies.identify.parameters import Space
from carom.studies.identify.search import search, simplex
from carom.studies.identify.uncertainty import bootstrap, design, minimum, quadratic_terms
from identify.tossed import HALF, G, box
from verified import agree, verifies


class Known(Evaluator):
    """An objective in closed form: `function(x)` returns that of each recording."""

    def __init__(self, parameters, function):
        self.function = function
        super().__init__(None, [Recording([0, 1], np.zeros((2, 3)), [[1, 0, 0, 0]] * 2)],
                         Space(parameters, None), lambda *_: 0.0, None)  # fmt: skip

    def number(self, point):
        point = self.space.clip(np.asarray(point, dtype=float))
        self.points.append(point)
        self.values.append(np.atleast_1d(self.function(point)))
        return len(self.points) - 1


@pytest.mark.parametrize("p", [1, 2, 5])
def test_a_quadratic_is_found_from_the_design(p):
    random = np.random.default_rng(p)
    assert len(design(p)) == 2 * p * p + 1
    root = random.normal(size=(p, p))
    H, middle = root @ root.T + np.eye(p), random.uniform(-0.5, 0.5, p)
    values = [0.5 * (z - middle) @ H @ (z - middle) for z in design(p)]
    c = np.linalg.lstsq(quadratic_terms(design(p)), np.array(values), rcond=None)[0]
    np.testing.assert_allclose(minimum(c), middle, rtol=0, atol=1e-11)


def test_least_point_of_a_surface_without_a_minimum_is_on_the_edge():
    # z0^2 - z1^2 + z1/2: least at z0 = 0, z1 = -1
    c = np.array([0.0, 0.0, 0.5, 1.0, 0.0, -1.0])
    np.testing.assert_allclose(minimum(c), [0, -1], rtol=0, atol=1e-6)


@pytest.mark.few(2)
@pytest.mark.parametrize("scale", [0.03, 1.0, 20.0])
def test_spread_of_the_mean_is_found_whatever_the_first_reach(scale):
    # recording k wants x = a_k: the minimum of the mean is the mean of the a_k, with the standard
    # deviation of a over sqrt(K). 500 draws: 3.2 %, three of them.
    a = np.random.default_rng(0).normal(size=(50, 2)) * [1.0, 0.1]
    space = {"x": (0.0, scale), "y": (0.0, scale)}
    known = Known(space, lambda x: np.sum((x - a) ** 2, axis=1))
    known.number(a.mean(axis=0))
    found = bootstrap(known, 500, 0)
    np.testing.assert_allclose(found.centre, a.mean(axis=0), rtol=0, atol=1e-8)
    np.testing.assert_allclose(
        np.std(found.samples, axis=0), np.std(a, axis=0) / np.sqrt(50), rtol=0.1
    )
    assert np.all(found.at_edge < 0.01)


def test_a_bound_is_kept():
    a = np.array([-0.2, 0.1, -0.1, 0.05])
    known = Known({"x": Parameter(0.5, 0.2, 0.0)}, lambda x: (x[0] - a) ** 2)
    search(known, "Nelder-Mead", 1, 1e-6, 200)
    assert known.points[known.best][0] == pytest.approx(0.0, abs=1e-5)
    samples = bootstrap(known, 100, 0).samples
    assert np.min(samples) == pytest.approx(0.0, abs=1e-12)
    assert np.min(known.points) >= 0.0


@pytest.mark.parametrize("method", ["Nelder-Mead", "Powell", "COBYQA"])
def test_search_finds_the_bottom_of_a_curved_valley(method):
    def rosenbrock(x):
        return (1 - x[0]) ** 2 + 10 * (x[1] - x[0] ** 2) ** 2

    known = Known({"x": (-0.5, 0.5), "y": (1.0, 0.5)}, rosenbrock)
    converged, message = search(known, method, 3, 1e-8, 3000)
    assert converged, message
    np.testing.assert_allclose(known.points[known.best], [1, 1], rtol=0, atol=1e-3)


def test_restarts_leave_a_rough_place():
    # ripples with a depth of 0.02 on a bowl; the simplex stops in one, its restarts go on
    def rough(x):
        return np.sum(x**2) + 0.02 * np.sum(1 - np.cos(40 * x))

    begin = {"x": (1.3, 0.5), "y": (-0.9, 0.5)}
    once, thrice = Known(begin, rough), Known(begin, rough)
    search(once, "Nelder-Mead", 0, 1e-6, 500)
    search(thrice, "Nelder-Mead", 4, 1e-6, 2000)
    assert thrice.mean(thrice.best) < once.mean(once.best)


def test_simplex_turns_at_a_bound():
    bounds = np.array([[-1.0, 0.3], [-5.0, 5.0]])
    corners = simplex(np.zeros(2), bounds, 1.0)
    np.testing.assert_array_equal(corners, [[0, 0], [-1, 0], [0, 1]])


@verifies("studies.identify.varied", "what is named has its new value", "closed form")
def test_varied_changes_what_it_is_told_and_nothing_else():
    scene = box()
    same, cube = varied(scene), scene.bodies[0]
    for a, b in ((same.bodies[0], cube), (same.contacts[0], scene.contacts[0])):
        for name in ("mass", "restitution", "friction", "friction_held", "name"):
            assert getattr(a, name, None) == getattr(b, name, None)
    np.testing.assert_array_equal(same.bodies[0].inertia, cube.inertia)
    np.testing.assert_array_equal(same.gravity, scene.gravity)
    start = State((0, 0, 2), (0, 1, 0, 0), (1, 2, 3), (4, 5, 6))
    other = varied(
        scene, restitution=0.1, friction=0.7, inertia_factor=2.0, corner_radius=0.01, start=start
    )  # fmt: skip
    body, contact = other.bodies[0], other.contacts[0]
    assert (contact.restitution, contact.friction, contact.friction_held) == (0.1, 0.7, 0.7)
    assert body.shape == carom.Box(2 * HALF, 2 * HALF, 2 * HALF, radius=0.01)
    agree(body.inertia, 2 * cube.inertia)
    np.testing.assert_array_equal(body.angular_velocity, (4, 5, 6))
    assert body.mass == cube.mass
    assert varied(scene, friction_held=0.9).contacts[0].friction == 0.3


def test_varied_copies_joints_and_forces():
    scene = carom.Scene()
    a = scene.add_body(mass=1, inertia=(1, 1, 1), name="a")
    b = scene.add_body(mass=1, inertia=(1, 1, 1), position=(1, 0, 0), name="b")
    scene.add_joint(carom.joints.Revolute((0.5, 0, 0), (0, 1, 0)), a, b)
    scene.add_force(carom.forces.Force((0, 0, 3)), a)
    copy = varied(scene, inertia_factor=3.0)
    assert [copy.joints[0].parent.name, copy.joints[0].child.name] == ["a", "b"]
    assert copy.forces[0].child is copy["a"]
    with pytest.raises(ValueError, match=r"start must be left out, .* for a scene with joints"):
        varied(
            scene, start=State(np.zeros((2, 3)), np.eye(4)[:2], np.zeros((2, 3)), np.zeros((2, 3)))
        )


@pytest.mark.parametrize(
    ("make", "change", "error", "message"),
    [
        (lambda: 3, {}, TypeError, "scene must be a carom.Scene"),
        (box, {"inertia_factor": 0.0}, ValueError, "inertia_factor must be finite and above 0"),
        (box, {"corner_radius": 1.0}, ValueError, "radius must be"),
        (box, {"friction": -0.1}, ValueError, "friction must be"),
        (
            box,
            {"start": State(*[np.ones((2, 3))] * 4)},
            ValueError,
            r"start.position must have shape \(1, 3",
        ),
    ],
)
def test_varied_refuses(make, change, error, message):
    with pytest.raises(error, match=message):
        varied(make(), **change)


def falling(t, name=""):
    """A cube that falls from 1 m: 0.43 s of free flight."""
    n = len(t)
    return Recording(t, np.zeros((n, 3)), [[1, 0, 0, 0]] * n, name=name)


@verifies("studies.identify.roll_out", "$z = 1 - g t^2/2$", "closed form")
@pytest.mark.parametrize("t", [np.arange(9) / 30, np.array([2.0, 2.05, 2.1, 2.2, 2.23])])
def test_roll_out_at_the_times_of_the_recording(t):
    run = roll_out(box(), falling(t))
    since = t - t[0]
    agree(run.position[:, 0, 2], 1 - 0.5 * G * since**2, atol=1e-12)
    assert run.position.shape == (t.size, 1, 3)
    assert run.orientation.shape == (t.size, 1, 4)
    assert run.message == ""
    agree(run.speed, G * since[-1], rtol=1e-12)
    assert run.residual < 1e-12


@pytest.mark.parametrize("t", [np.arange(60) / 30, np.array([0.0, 0.5, 2.0])])
def test_a_run_that_fails_stays_where_it_stopped(t):
    options = carom.Options(hold=False)  # bounces accumulate
    run = roll_out(box(), falling(t), options=options)
    assert "One step has more impacts" in run.message
    assert run.position.shape == (t.size, 1, 3)
    np.testing.assert_allclose(run.position[-1, 0, 2], HALF, atol=1e-6)


@verifies(
    "studies.identify.roll_outs", "$z = 1 - g t^2/2$, in any order of the workers", "closed form"
)
def test_roll_outs_keep_their_order():
    found = [falling(np.arange(4) / 30 / (k + 1), str(k)) for k in range(5)]
    for workers in (1, 3):
        runs = roll_outs(lambda r: box(), found, workers=workers)
        drops = [1 - run.position[-1, 0, 2] for run in runs]
        expected = [0.5 * G * (0.1 / (k + 1)) ** 2 for k in range(5)]
        agree(drops, expected, atol=1e-12)
