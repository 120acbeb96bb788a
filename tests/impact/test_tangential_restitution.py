"""Tangential restitution: super balls in closed form, cones and energies that limit it, and nothing else."""

import numpy as np
import pytest

import carom
from verified import agree, verifies

R = 0.05


def bounce(e_t, *, velocity, spin, mu=10.0, e=1.0, impact_law="newton"):
    """Return a ball just after one impact with a floor."""
    scene = carom.Scene(gravity=(0, 0, 0))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    one = scene.add_body(
        carom.Sphere(R), mass=0.2, position=(0, 0, 0.01 + R), velocity=velocity,
        angular_velocity=(0, spin, 0), name="ball",
    )  # fmt: skip
    scene.add_contact(
        one, floor, restitution=e, friction=mu, tangential_restitution=e_t, impact_law=impact_law
    )
    return carom.simulate(scene, 0.02)


@verifies(
    "add_contact(tangential_restitution=)", r"$v^+ = \tfrac37 v + \tfrac47 r\omega$", "closed form"
)
@pytest.mark.parametrize("impact_law", ["newton", "poisson", "stronge"])
@pytest.mark.parametrize(("v", "rw"), [(1.0, 0.0), (0.0, 1.0), (1.0, -1.0), (0.7, 2.0)])
def test_super_ball(v, rw, impact_law):
    # e = e_t = 1: the slip v - r w is reversed, and the angular momentum about the point of contact is kept
    solution = bounce(1.0, velocity=(v, 0, -1.0), spin=rw / R, impact_law=impact_law)
    after = solution.velocity[-1, 0, 0], R * solution.angular_velocity[-1, 0, 1]
    agree(after[0], 3 / 7 * v + 4 / 7 * rw, atol=1e-12)
    agree(after[1], 10 / 7 * v - 3 / 7 * rw, atol=1e-12)
    agree(solution.kinetic_energy[-1], solution.kinetic_energy[0], rtol=1e-12)


def test_zero_ends_without_slip_and_minus_one_as_without_friction():
    for e_t in (-1.0, -0.4, 0.0, 0.3, 0.8):
        solution = bounce(e_t, velocity=(1.0, 0, -1.0), spin=0.0, e=0.5)
        slip = solution.velocity[-1, 0, 0] - R * solution.angular_velocity[-1, 0, 1]
        assert slip == pytest.approx(-e_t, abs=1e-12)
        loss = (1 - e_t**2) / 7 * 0.2
        assert solution.impacts.friction_loss[0] == pytest.approx(loss, rel=1e-9, abs=1e-14)


def test_friction_limits_what_comes_back():
    # stick takes P_t = 2/7 m v, the cone mu (1 + e) m v_n = .4 m v: 0.1143 m v is left for the way back
    solution = bounce(1.0, velocity=(1.0, 0, -1.0), spin=0.0, mu=0.2)
    assert solution.impacts.impulse[0, 1] == pytest.approx(-0.4 * 0.2, rel=1e-12)
    assert solution.velocity[-1, 0, 0] == pytest.approx(0.6, rel=1e-12)
    # and nothing where slip lasts
    slides = [bounce(e_t, velocity=(1.0, 0, -1.0), spin=0.0, mu=0.1) for e_t in (0.0, 1.0)]
    assert np.array_equal(slides[0].velocity, slides[1].velocity)


@pytest.mark.parametrize("seed", range(3))
def test_a_thrown_rod_never_gains(seed):
    rng = np.random.default_rng(seed)
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1), name="floor")
    rod = scene.add_body(
        carom.Capsule(0.02, 0.3), mass=1.0, position=(0, 0, 0.6), velocity=rng.normal(size=3),
        angular_velocity=5 * rng.normal(size=3), name="rod",
    )  # fmt: skip
    scene.add_contact(
        rod, floor, restitution=0.7, friction=0.6, impact_law="stronge",
        tangential_restitution=rng.uniform(-1, 1),
    )  # fmt: skip
    solution = carom.simulate(scene, 1.0)
    impacts = solution.impacts
    single = impacts.together == 1
    assert np.all(impacts.energy_change <= 0)
    assert np.all(impacts.friction_loss >= 0)
    # the normal velocity is that of the law, and the cone holds
    W, p = impacts.inverse_mass[single], impacts.impulse[single]
    after = impacts.relative_velocity_before[single] + np.einsum("kij,kj->ki", W, p)
    assert after == pytest.approx(impacts.relative_velocity_after[single], abs=1e-12)
    assert np.all(np.hypot(p[:, 1], p[:, 2]) <= 0.6 * p[:, 0] * (1 + 1e-12))


def test_between_floor_and_wall():
    # floor, then wall: slip v_x - r w at the floor and v_z + r w at the wall, each reversed with the angular
    # momentum about its point kept (cases/closed_form, 3/7 and 4/7), e = 1 for what is normal
    scene = carom.Scene(gravity=(0, 0, 0))
    planes = [scene.add_half_space((0, 0, 0), n) for n in ((0, 0, 1), (-1, 0, 0))]
    one = scene.add_body(
        carom.Sphere(R), mass=0.2, position=(-0.3, 0, 0.1), velocity=(1.0, 0, -1.0), name="ball"
    )
    for plane in planes:
        scene.add_contact(one, plane, restitution=1, friction=10, tangential_restitution=1)
    run = carom.simulate(scene, 1.0)
    (v, z), rw = (3 / 7, 1.0), 10 / 7  # after the floor
    v, z, rw = (
        -v,
        3 / 7 * z + 4 / 7 * rw,
        10 / 7 * z - 3 / 7 * rw,
    )  # after the wall, on which r w goes up
    assert len(run.impacts) == 2
    assert run.velocity[-1, 0] == pytest.approx([v, 0, z], abs=1e-12)
    assert R * run.angular_velocity[-1, 0, 1] == pytest.approx(rw, abs=1e-12)


@pytest.mark.parametrize("law", ["newton", "stronge"])
def test_impacts_alone_are_those_of_a_run(law):
    run = bounce(0.6, velocity=(1.0, 0.4, -1.0), spin=3.0, e=0.7, mu=0.5, impact_law=law)
    (hit,) = run.impacts
    given = hit.inverse_mass, hit.relative_velocity_before, 0.5, 0.7, law
    one = carom.resolve_impact(*given, tangential_restitution=0.6)
    assert np.array_equal(one.impulse, hit.impulse)
    assert one.friction_loss == hit.friction_loss
    several = carom.resolve_impact(*given, tangential_restitution=np.array([0.6, 0.0, -0.6]))
    assert np.array_equal(several.impulse[0], hit.impulse)
    assert np.array_equal(several.impulse[1], carom.resolve_impact(*given).impulse)
    history = run.impact_history(0)
    assert history.velocity_after == pytest.approx(hit.relative_velocity_after, abs=1e-12)
    assert history.velocity[-1, 1:] == pytest.approx(0, abs=1e-12)  # slip returns at the exit
    alone = carom.resolve_impacts(given[0], [given[1]], *given[2:], tangential_restitution=0.6)
    assert alone.impulse[0] == pytest.approx(hit.impulse, rel=1e-12)


def test_a_ball_in_coordinates():
    sp = pytest.importorskip("sympy")
    x, z, b, dx, dz, db = sp.symbols("x z b dx dz db")
    system = carom.GeneralizedSystem.from_sympy(
        [x, z, b], [dx, dz, db], kinetic_energy=0.1 * (dx**2 + dz**2 + 0.4 * R**2 * db**2),
        position=[0, 0.01 + R, 0], velocity=[1.0, -1.0, 2.0],
    )  # fmt: skip
    system.add_contact(
        z - R, tangent=dx - R * db, restitution=0.8, friction=0.6, tangential_restitution=0.5
    )
    v = carom.simulate(system, 0.02).v[-1]
    of_body = bounce(0.5, velocity=(1.0, 0, -1.0), spin=2.0, e=0.8, mu=0.6)
    expected = [*of_body.velocity[-1, 0, ::2], of_body.angular_velocity[-1, 0, 1]]
    assert v == pytest.approx(expected, abs=1e-12)


def test_a_crowd_says_that_it_has_none():
    scene = carom.Scene(gravity=(0, 0, 0))
    for k in range(9):
        scene.add_body(
            carom.Sphere(0.03),
            mass=1.0,
            position=(k * 0.0601, 0, 0),
            velocity=(0 if k else 5, 0, 0),
        )
    scene.set_contact_default(restitution=0.5, friction=0.1, tangential_restitution=0.5)
    options = carom.Options(max_impacts_per_step=1)
    run = carom.simulate(scene, 0.02, step=1e-3, options=options)
    count = len(np.unique(run.impacts.time[run.impacts.located == 0]))
    said = (
        f"{count} impacts in time-stepping steps were without the tangential restitution of their"
    )
    assert any(said in one for one in run.warnings)
