"""Restitution as a law of the speed: bounces by recurrence, several contacts, stops, crowds, names."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

import carom
from carom import Restitution
from verified import agree, verifies

G = 9.81
LAWS = {
    "power": Restitution.power(0.5, speed=2.0, maximum=0.9),
    "rising": Restitution.power(0.7, exponent=0.2),
    "viscoelastic": Restitution.viscoelastic(0.2),
    "table": Restitution.table([0.2, 1.0, 3.0, 5.0], [0.95, 0.8, 0.6, 0.5]),
}


def ball(restitution, drop=1.0, radius=0.1, **contact):
    """Return a ball above a floor, without friction."""
    scene = carom.Scene(gravity=(0, 0, -G))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    one = scene.add_body(
        carom.Sphere(radius), mass=1.0, position=(0, 0, drop + radius), name="ball"
    )
    scene.add_contact(one, floor, restitution=restitution, **contact)
    return scene


def speeds(law, first, count):
    """Return the speeds of approach of the first impacts: v_{k+1} = e(v_k) v_k."""
    found = [first]
    for _ in range(count - 1):
        found.append(float(law(found[-1])) * found[-1])
    return np.array(found)


@verifies("Restitution.power", "$e = e_0 (v/v_0)^{-1/4}$, at most its maximum", "closed form")
@verifies(
    "Restitution.viscoelastic", r"$e = 1 - x + \tfrac35 x^2$, $x = c\,v^{1/5}$", "closed form"
)
@verifies("Restitution.table", "monotone cubics", "other program: SciPy's PchipInterpolator")
def test_values_by_their_formulas():
    v = np.array([1e-9, 1e-3, 0.3, 1.0, 2.7, 40.0])
    agree(LAWS["power"](v), np.minimum(0.9, 0.5 * (v / 2.0) ** -0.25), rtol=1e-14)
    agree(LAWS["rising"](v), np.minimum(1.0, 0.7 * v**0.2), rtol=1e-14)
    x = np.minimum(0.2 * v**0.2, 5 / 6)
    agree(LAWS["viscoelastic"](v), 1 - x + 0.6 * x**2, rtol=1e-14)
    agree(Restitution.viscoelastic(2.0)(40.0), 7 / 12, rtol=1e-14)
    table = PchipInterpolator([0.2, 1.0, 3.0, 5.0], [0.95, 0.8, 0.6, 0.5])
    agree(LAWS["table"](v), table(np.clip(v, 0.2, 5.0)), rtol=1e-14)
    for law in LAWS.values():
        everywhere = law(np.append(0.0, np.logspace(-300, 300, 999)))
        assert np.all((everywhere >= 0) & (everywhere <= 1))
        difference = (law(1.7 + 1e-5) - law(1.7 - 1e-5)) / 2e-5
        agree(law.slope(1.7), difference, rtol=1e-8, atol=1e-10)


@verifies("Restitution.fit", "a power law as a function, and its bounces", "closed form")
def test_a_function_is_a_law():
    """The power law as a function: a fit to 1e-10, with its kink; and the same bounces."""

    def power(v):
        return min(0.9, 0.5 * (v / 2.0) ** -0.25)

    law = Restitution.fit(power)
    v = np.logspace(-6, 4, 3000)
    agree(law(v), LAWS["power"](v), atol=2e-10)  # twice the stated accuracy, as a bound
    assert pickle.loads(pickle.dumps(law)) == law
    assert len({law, law, Restitution.fit(power, speeds=(0.1, 3))}) == 2
    times = [
        carom.simulate(ball(one), 3.0, save_at=0.1).impacts.time for one in (power, LAWS["power"])
    ]
    # an error of e of 1e-10 of its value moves the k-th impact by 2 k v / g times that
    agree(times[0], times[1], atol=1e-8)
    short = Restitution.fit(lambda v: 1.0 - 0.1 * v, speeds=(1.0, 5.0))  # below 0 from 10 m/s on
    agree(short([0.0, 1.0, 3.0, 99.0]), [0.9, 0.9, 0.7, 0.5], rtol=1e-12)
    assert short.fastest == 5.0
    assert law.elastic == 0.0
    slow = Restitution.fit(lambda v: min(1.0, v**-0.25), speeds=(0.0, 3.0))
    agree(slow.elastic, 1.0, rtol=1e-6)


@verifies("Restitution.power", r"$v_{k+1} = e(v_k)\,v_k$", "closed form")
@pytest.mark.few(4)
@pytest.mark.parametrize(
    "impact_law", [pytest.param("newton", marks=pytest.mark.plain), "poisson", "stronge"]
)
@pytest.mark.parametrize("name", LAWS)
def test_bounces_follow_the_recurrence(name, impact_law):
    law = LAWS[name]
    solution = carom.simulate(ball(law, impact_law=impact_law), 1.5)
    impacts = solution.impacts
    v = speeds(law, np.sqrt(2 * G), len(impacts))
    assert len(impacts) >= 2
    # located to the round-off of the height; speeds add up over the bounces
    agree(-impacts.relative_velocity_before[:, 0], v, rtol=1e-11)
    agree(impacts.relative_velocity_after[:, 0], law(v) * v, rtol=1e-11)
    agree(impacts.restitution, law(v), rtol=1e-11)
    times = np.sqrt(2 / G) + 2 / G * np.cumsum(np.append(0.0, v[1:]))
    agree(impacts.time, times, rtol=1e-11)
    assert np.all(impacts.energy_change <= 0)


def test_power_without_a_cap_bounces_for_ever_at_the_speed_of_e_1():
    # v_{k+1} = e_0 v_0^(1/4) v_k^(3/4), which goes to e_0^4 v_0
    e, v = 0.8, 1.0
    solution = carom.simulate(ball(Restitution.power(e), drop=0.2), 6.0)
    found = -solution.impacts.relative_velocity_before[:, 0]
    assert found[1:] == pytest.approx(e * v**0.25 * found[:-1] ** 0.75, rel=1e-9)
    assert found[-1] == pytest.approx(e**4 * v, rel=1e-3)
    (said,) = solution.warnings
    assert "were elastic, or nearly, as their law says below a speed of 0.4096" in said


@pytest.mark.parametrize(("c", "rtol"), [(0.35, 1e-6), (0.35, 1e-9), (0.6, 1e-6)])
def test_time_to_rest_of_viscoelastic_spheres_is_the_sum_of_the_series(c, rtol):
    law, drop = Restitution.viscoelastic(c), 0.05
    v, sum_of = np.sqrt(2 * G * drop), 0.0
    end = v / G
    for _ in range(20000):  # v_k falls as k^-5: the rest is less than 1e-15 s
        v *= float(law(v))
        sum_of += 2 * v / G
    end += sum_of
    solution = carom.simulate(ball(law, drop=drop), end + 0.05, rtol=rtol, atol=1e-4 * rtol)
    assert solution.velocity[-1] == pytest.approx(np.zeros((1, 3)), abs=1e-15)
    events = solution.events
    begun = float(events.time[events.kind == "held"][0])
    # left out are bounces that end within the time of one as high as the tolerance
    within = np.sqrt(8 * (rtol * 0.2 + 1e-4 * rtol) / G)
    assert end - within <= begun <= end


def test_two_contacts_at_once_have_the_e_of_their_own_speeds():
    law, velocity = LAWS["power"], np.array([-3.0, 0.0, -0.7])
    for impact_law in ("newton", "poisson", "stronge"):
        scene = carom.Scene(gravity=(0, 0, 0))
        one = scene.add_body(
            carom.Sphere(0.1), mass=1, position=(0.4, 0, 0.17), velocity=velocity, name="ball"
        )
        for normal in ((1, 0, 0), (0, 0, 1)):  # 0.3 / 3 s and 0.07 / 0.7 s away
            wall = scene.add_half_space((0, 0, 0), normal)
            scene.add_contact(one, wall, restitution=law, impact_law=impact_law)
        solution = carom.simulate(scene, 0.2)
        assert solution.impacts.together.tolist() == [2, 2]
        after = -np.array([law(3.0), 0.0, law(0.7)]) * velocity
        assert solution.velocity[-1, 0] == pytest.approx(after, rel=1e-9, abs=1e-12)
        assert solution.impacts.restitution == pytest.approx(law([3.0, 0.7]), rel=1e-12)


def test_a_stop_takes_the_speed_of_its_coordinate():
    law = Restitution.power(0.6, speed=2.0)
    scene = carom.Scene(gravity=(0, 0, 0))
    arm = scene.add_body(
        carom.Box(0.4, 0.1, 0.1), mass=1.0, position=(0.2, 0, 0), velocity=(0, 0, -0.6),
        angular_velocity=(0, 3.0, 0), name="arm",
    )  # fmt: skip
    hinge = scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, arm)
    scene.add_stop(hinge, upper=0.3, restitution=law)
    solution = carom.simulate(scene, 0.2)
    assert solution.angular_velocity[-1, 0, 1] == pytest.approx(-3.0 * law(3.0), rel=1e-9)
    assert solution.impacts.restitution == pytest.approx([law(3.0)], rel=1e-9)


def test_own_coordinates():
    law = LAWS["table"]
    system = carom.GeneralizedSystem(
        lambda q: np.eye(1), [1.0], [0.0], potential=lambda q: G * q[0]
    )
    system.add_contact(lambda q: q[0], restitution=law, name="floor")
    solution = carom.simulate(system, 1.5)
    v = speeds(law, np.sqrt(2 * G), len(solution.impacts))
    assert -solution.impacts.relative_velocity_before[:, 0] == pytest.approx(v, rel=1e-6)
    assert solution.impacts.restitution == pytest.approx(law(v), rel=1e-6)


def test_a_time_stepping_step_has_the_e_of_its_start():
    law, speed = LAWS["power"], 2.0
    scene = carom.Scene(gravity=(0, 0, 0))
    for k in range(2):  # two pairs that meet in one step are a crowd
        for side in (-1, 1):
            scene.add_body(
                carom.Sphere(0.1), mass=1, position=(0.105 * side, k, 0), velocity=(-side * speed / 2, 0, 0)
            )  # fmt: skip
    scene.set_contact_default(restitution=law)
    solution = carom.simulate(scene, 0.02, step=1e-3)
    assert np.abs(solution.velocity[-1, :, 0]) == pytest.approx(law(speed) * speed / 2, rel=1e-9)


def test_bodies_that_meet_later_have_the_law():
    # 70 balls have pairs of their own only when they come near each other
    law = LAWS["viscoelastic"]
    scene = carom.Scene(gravity=(0, 0, 0))
    for k in range(70):
        speed = -1.0 if k == 1 else 0.0
        scene.add_body(carom.Sphere(0.1), mass=1, position=(2.0 * k, 0, 0), velocity=(speed, 0, 0))
    scene.set_contact_default(restitution=law)
    solution = carom.simulate(scene, 2.5)
    e = float(law(1.0))
    assert solution.velocity[-1, :2, 0] == pytest.approx([-(1 + e) / 2, -(1 - e) / 2], rel=1e-9)


def test_names_files_copies_and_ensembles(tmp_path):
    scene = ball(LAWS["power"])
    solution = carom.simulate(scene, 1.0)
    for again in (
        pickle.loads(pickle.dumps(scene)),
        carom.Solution.load(saved(solution, tmp_path)).scene,
    ):
        assert again["ball-floor"].restitution == LAWS["power"]
    loaded = carom.Solution.load(tmp_path / "run.nc")
    assert np.array_equal(loaded.impacts.restitution, solution.impacts.restitution)
    values = [0.5, 0.3]
    found = carom.ensemble(scene, 1.0, vary={"ball-floor.restitution.value": values})
    for k, value in enumerate(values):
        one = carom.simulate(ball(replace(LAWS["power"], value=value)), 1.0)
        assert np.array_equal(found.outcomes["velocity"][k, 0], one.velocity[-1, 0])
    with pytest.raises(ValueError, match="in run 1: maximum must be"):
        carom.ensemble(scene, 1.0, vary={"ball-floor.restitution.maximum": [0.5, 1.3]})


def test_a_number_of_a_law_is_identified():
    from carom.studies.identify import Recording, mean_error

    solution = carom.simulate(ball(LAWS["power"]), 1.0)
    recording = Recording(solution.t, solution.position, solution.orientation)
    found = carom.identify(
        ball(replace(LAWS["power"], value=0.6)), [recording],
        {"ball-floor.restitution.value": (0.6, 0.05)}, mean_error(0.1, 1.0),
    )  # fmt: skip
    assert found.parameters["ball-floor.restitution.value"] == pytest.approx(0.5, rel=1e-3)
    with pytest.raises(ValueError, match="of a vector give components"):
        carom.identify(
            ball(LAWS["power"]), [recording], {"ball-floor.restitution": (0.5, 0.1)}, mean_error(0.1, 1.0)
        )  # fmt: skip


def saved(solution, folder):
    """Return the path of a run that has been saved."""
    solution.save(folder / "run.nc")
    return folder / "run.nc"


def test_sensitivities_know_how_e_depends_on_the_speed():
    # v_1 = e_0 v^(3/4), v^2 = 2 g h: dv_1/dh = (3/4) (v_1/v) g/v, not (v_1/v) g/v as for a number
    solution = carom.simulate(ball(Restitution.power(0.6)), 0.7)
    v, after = np.sqrt(2 * G), 0.6 * (2 * G) ** 0.375
    by_height = carom.sensitivities(solution, "ball.position.z")
    assert by_height.velocity_after[0, 0, 0] == pytest.approx(0.75 * after / v * G / v, rel=1e-8)
    with pytest.raises(ValueError, match="whose restitution is a law"):
        carom.sensitivities(solution, "ball-floor.restitution")


def test_faster_impacts_than_a_table_has_are_told():
    law = Restitution.table([0.1, 1.0], [0.8, 0.6])
    solution = carom.simulate(ball(law), 0.8)
    (said,) = solution.warnings
    assert "1 impacts were faster than their law of restitution is stated for (1)" in said
    assert solution.impacts.restitution[0] == 0.6
    assert not carom.simulate(ball(law, drop=0.04), 0.3).warnings


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Restitution.power(-0.1), "value must be finite and at least 0, got -0.1"),
        (lambda: Restitution.power(0.5, maximum=1.2), "maximum must be .* at most 1, got 1.2"),
        (lambda: Restitution.power(0.5, speed=0), "speed must be finite and above 0 .m/s., got 0"),
        (lambda: Restitution.power(0.5, exponent=-2), "exponent must be .* at least -1"),
        (lambda: Restitution.power(np.nan), "value must be finite"),
        (lambda: Restitution.viscoelastic(-1), "c must be finite and at least 0"),
        (lambda: Restitution.table([1], [0.5]), "speeds must be two numbers or more"),
        (lambda: Restitution.table([1, 1], [0.5, 0.4]), "speeds must rise"),
        (lambda: Restitution.table([0, 1], [0.5, 1.1]), "values must be two numbers or more, from 0 to 1"),
        (lambda: Restitution.table([0, 1], [0.5, -0.1]), "values must be two numbers or more, from 0 to 1"),
        (lambda: Restitution.table([0, 1], [0.5, 0.4, 0.3]), "speeds and values must have the same length"),
        (lambda: Restitution.table([0, 1], [0.5, np.nan]), "values must be finite"),
        (lambda: ball(lambda v: 1.5), r"restitution: function must be from 0 to 1 at all speeds, got 1.5"),
        (lambda: ball(lambda v: 1 - v), r"function must be from 0 to 1 .* speeds=\(lowest, highest\)"),
        (lambda: ball(lambda v: float(v < 2)), "function must be continuous above 0, .* jumps by 1 at 2 m/s"),
        (lambda: ball(lambda v: "a"), "function must return a finite number .* got 'a'"),
        (lambda: ball(carom.Friction(0.4, 0.3)), "restitution must be a number, a law, such as carom.Rest"),
        (lambda: Restitution.fit(lambda v: 0.5, speeds=(2, 1)), "speeds must be the lowest, at least 0, and a"),
    ],
)  # fmt: skip
def test_nonsense_is_refused_by_its_name(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_materials_have_equal_laws_or_the_pair_has_its_own():
    scene = carom.Scene()
    rubber = carom.Material(LAWS["power"], 0.3)
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor", material=rubber)
    one, two = (
        scene.add_body(carom.Sphere(0.1), mass=1, position=(k, 0, 0.1), material=material)
        for k, material in enumerate([rubber, carom.Material(0.3, 0.3)])
    )
    scene.set_contact_default(combine="average", all_pairs=False)
    assert scene.add_contact(one, floor).restitution == LAWS["power"]
    with pytest.raises(ValueError, match="different laws, which no rule combines"):
        scene.add_contact(two, floor)
    assert scene.add_contact(two, floor, restitution=0.4).restitution == 0.4
