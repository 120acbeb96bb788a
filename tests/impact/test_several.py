"""Many impacts at once are those of one after another; plane ones; the two names of a law."""

import numpy as np
import pytest

import carom
from verified import agree, verifies

W = np.array([[1.0, 0.3, 0.1], [0.3, 3.5, 0.2], [0.1, 0.2, 3.0]])
LAWS = ["newton", "poisson", "stronge"]


def test_each_is_that_of_a_call_of_its_own():
    """To the last bit, more than one block of them."""
    mu, e = np.linspace(0, 1, 30)[:, None, None], np.linspace(0, 1, 30)[:, None]
    many = carom.resolve_impact(W, (-1.0, 0.4, 0.1), mu, e, LAWS)
    assert many.velocity_after.shape == (30, 30, 3, 3)
    assert many.phases.shape == many.wedged.shape == many.energy_change.shape == (30, 30, 3)
    for i, j, k in ((0, 0, 0), (3, 29, 1), (17, 8, 2), (29, 29, 2)):
        one = carom.resolve_impact(W, (-1.0, 0.4, 0.1), mu[i, 0, 0], e[j, 0], LAWS[k])
        for name in (name for name in vars(one) if not name.startswith("_")):
            value = getattr(one, name)
            assert np.array_equal(getattr(many, name)[i, j, k], value), name


def test_inverse_masses_and_velocities_have_rows_too():
    velocities = np.array([[-1.0, 0.5, 0.0], [-2.0, 0.0, 0.3]])
    many = carom.resolve_impact([W, 2 * W], velocities, 0.2, 0.5)
    for i, (mass, u) in enumerate(zip((W, 2 * W), velocities)):
        alone = carom.resolve_impact(mass, u, 0.2, 0.5)
        assert np.array_equal(many.impulse[i], alone.impulse)


def test_a_plane_impact_is_that_in_space_without_the_other_tangent():
    plane = carom.resolve_impact(W[:2, :2], (-1.0, 0.4), 0.3, 0.5, "stronge")
    space = np.zeros((3, 3))
    space[:2, :2] = W[:2, :2]
    whole = carom.resolve_impact(space, (-1.0, 0.4, 0.0), 0.3, 0.5, "stronge")
    assert plane.velocity_after.shape == (2,)
    assert np.array_equal(plane.velocity_after, whole.velocity_after[:2])
    assert plane.energy_change == whole.energy_change
    assert plane.phases == whole.phases


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            {"friction": [0.1, -0.1]},
            r"friction must be finite and at least 0, got -0.1 at index \(1,\)",
        ),
        ({"restitution": [[0.5], [1.5]]}, r"restitution .* from 0 to 1, got 1.5 at index \(1, 0\)"),
        (
            {"friction": [0.1, 0.2], "restitution": [0.1] * 3},
            "must have first axes that go together",
        ),
        ({"velocity": [(-1, 0, 0), (1, 0, 0)]}, "approach is negative.* got 1.0 at index"),
        ({"inverse_mass": np.eye(2)}, r"velocity must have shape \(..., 2\)"),
        ({"law": ["newton", "stronger"]}, "did you mean 'stronge'"),
        ({"inverse_mass": [W, -W]}, "above 0"),
        ({"inverse_mass": [W, W + np.triu(W)]}, "symmetric"),
    ],
)
def test_what_is_wrong_is_named_with_its_place(change, words):
    given = {"inverse_mass": W, "velocity": (-1, 0.4, 0.1), "friction": 0.1, "restitution": 0.5}
    with pytest.raises(ValueError, match=words):
        carom.resolve_impact(**{**given, **change})


def test_a_law_has_two_names_everywhere():
    blow = W, (-1, 0.4, 0.1), 0.1, 0.5
    by_one, by_other = (
        carom.resolve_impact(*blow, **{n: "stronge"}) for n in ("law", "impact_law")
    )
    assert np.array_equal(by_one.impulse, by_other.impulse)
    scene = carom.Scene()
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    ball = scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 1))
    assert scene.add_contact(ball, floor, law="poisson").impact_law == "poisson"
    with pytest.raises(AttributeError, match="did you mean 'impact_law'"):
        _ = scene.contacts[0].law
    scene.set_contact_default(law="stronge")
    assert scene.contact_default.impact_law == "stronge"
    both = "takes (law= or impact_law|impact_law= or law)=, which are the same, got both"
    with pytest.raises(TypeError, match=both):
        carom.resolve_impact(*blow, "newton", impact_law="newton")
    with pytest.raises(TypeError, match=both):
        scene.set_contact_default(law="newton", impact_law="newton")
    with pytest.raises(TypeError, match="it is called law="):
        carom.resolve_impact(*blow, model="newton")


def struck_double_pendulum():
    """Two rods, the second with a ball that strikes a wall at once, and a rotor in the first hinge."""
    scene = carom.Scene(gravity=(0, 0, 0))
    wall = scene.add_half_space(point=(0, 0, -0.05), normal=(0, 0, 1), name="wall")
    first = scene.add_body(mass=1.0, inertia=(1e-3, 0.02, 0.02), position=(0.25, 0, 0))
    ball = scene.add_body(
        carom.Sphere(0.05), mass=2.0, inertia=(1e-2, 0.02, 0.025), position=(0.6, 0, 0), velocity=(0, 0, -0.1),
        angular_velocity=(0, 1.0, 0), name="ball",
    )  # fmt: skip
    hinge = scene.add_joint(carom.joints.Revolute((0, 0, 0), (0, 1, 0)), carom.GROUND, first)
    scene.add_joint(carom.joints.Revolute((0.5, 0, 0), (0, 1, 0)), first, ball)
    scene.add_force(carom.forces.JointInertia(hinge, 0.3))
    scene.add_contact(ball, wall, restitution=0.6, friction=0.1)
    return scene


def test_inverse_mass_of_a_mechanism_is_that_of_the_run():
    scene = struck_double_pendulum()
    row = carom.simulate(scene, 1e-3, step=1e-4).impacts[0]
    found = carom.contact_inverse_mass(scene, "ball", (0.6, 0, -0.05), (0, 0, 1))
    np.testing.assert_allclose(found, row.inverse_mass, rtol=1e-9, atol=1e-9)
    assert np.all(found[2] == 0.0)  # the hinges let nothing move across their plane


@verifies(
    "contact_inverse_mass",
    r"two balls: $(1/m_1 + 1/m_2)\,\mathrm{diag}(1, \tfrac72, \tfrac72)$",
    "closed form",
)
def test_inverse_mass_of_two_bodies():
    """Of two balls the reduced mass: 1/m1 + 1/m2 along the normal, 7/2 times as much across it."""
    scene = carom.Scene()
    one = scene.add_body(carom.Sphere(0.1), mass=1.0, name="one")
    two = scene.add_body(carom.Sphere(0.2), mass=3.0, position=(0, 0, 0.3), name="two")
    W = carom.contact_inverse_mass(scene, two, point=(0, 0, 0.1), normal=(0, 0, 1), other="one")
    agree(W, np.diag([1, 3.5, 3.5]) * (1 + 1 / 3), rtol=1e-14, atol=1e-15)
    with pytest.raises(ValueError, match="another part than body"):
        carom.contact_inverse_mass(scene, one, (0, 0, 0), (0, 0, 1), other=one)
    with pytest.raises(ValueError, match="did you mean 'two'"):
        carom.contact_inverse_mass(scene, "too", (0, 0, 0), (0, 0, 1))
