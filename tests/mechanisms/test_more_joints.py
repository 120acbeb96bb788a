"""Cylindrical, universal, planar, point-on-line, point-on-plane and screw joints in closed form.

In both back ends: `with_loop` adds a rod far away, which takes the scene out of the trees'.
"""

import numpy as np
import pytest
from dense_reference import solve
from mechanism_scenes import G, about, orders
from random_forests import MORE, build, plan, with_loop
from scipy.integrate import quad
from test_forests import wrench_on_centre

import carom
from carom import GROUND, Scene, joints
from carom.model.arrays import FOREST, LOOPS
from verified import agree, verifies

BOTH = pytest.mark.parametrize("looped", [False, True], ids=["tree", "loop"])
UP = (0, 0, 1)
# reactions of the loops' back end are passes of an augmented Lagrangian: with 1e-3, its default, to 1e-6
# of the largest in the worst of these forests (some rows are nearly dependent)
SHARP = carom.Options(augmentation=1e-6)


def moved(scene, duration, step, solver=FOREST):
    """Run, see that it was by this back end and that the joints hold to round-off."""
    solution = carom.simulate(scene, duration, step=step, options=SHARP)
    assert solution._run.compiled.system.solver.kind == solver
    position, velocity = solution.constraint_errors
    size = 1.0 + np.max(np.abs(solution.velocity[:, 0]))
    assert np.max(position) < 1e-13 * size**2
    assert np.max(velocity) < 1e-12 * size
    return solution


def either(looped, scene, duration, step):
    """Run in either back end."""
    pair = (with_loop(scene), LOOPS) if looped else (scene, FOREST)
    return moved(pair[0], duration, step, pair[1])


def sleeve(definition, spin, speed):
    """One body 0.3 m off a vertical line through the origin, turned, with three different moments."""
    scene = Scene(gravity=(0, 0, -G))
    body = scene.add_body(
        mass=2.0, inertia=[0.1, 0.2, 0.25], position=(0.3, 0, 0), name="sleeve",
        orientation=about((0.6, 0, 0.8), 0.7), velocity=(0, 0.3 * spin, speed),
        angular_velocity=(0, 0, spin),
    )  # fmt: skip
    scene.add_joint(definition, GROUND, body, name="joint")
    return scene


@verifies("joints.Cylindrical", r"$z = v t - g t^2/2$, $q = \omega t$", "closed form")
@BOTH
def test_cylindrical_joint_falls_freely_and_turns_uniformly(looped):
    """The line takes all but the force along it and the torque about it: z = v t - g t^2/2, q = w t."""
    scene = sleeve(joints.Cylindrical((0, 0, 0.1), UP), spin=9.0, speed=2.0)
    s = either(looped, scene, 1.0, 0.01)
    q, rate = s.joint_coordinates("joint")
    exact = np.stack([9.0 * s.t, 2.0 * s.t - 0.5 * G * s.t**2], axis=1)
    # RK4 in the ambient space, turns of 0.09 rad: (w h)^4/120 of the velocity, 1e-6 over 9 rad
    agree(q, exact, atol=1e-6)
    agree(q[:, 1], exact[:, 1], atol=1e-12)
    agree(rate[:, 1], 2.0 - G * s.t, atol=1e-12)


@verifies("joints.Planar", r"$a = g \sin\alpha$ down the slope, uniform across it", "closed form")
@BOTH
@pytest.mark.plain
def test_plate_on_an_incline(looped):
    """Planar: a = g sin(slope) down the incline, uniform across it, uniform turn about the normal."""
    slope = 0.4
    down, normal = np.array([np.cos(slope), 0, -np.sin(slope)]), (np.sin(slope), 0, np.cos(slope))
    scene = Scene(gravity=(0, 0, -G))
    body = scene.add_body(
        mass=2.0, inertia=[0.1, 0.2, 0.25], orientation=about((0, 1, 0), slope), name="plate",
        velocity=0.5 * down + [0, 1.5, 0], angular_velocity=2.0 * np.array(normal),
    )  # fmt: skip
    scene.add_joint(joints.Planar(normal), GROUND, body, name="table")
    s = either(looped, scene, 0.5, 0.01)
    way = 0.5 * s.t + 0.5 * G * np.sin(slope) * s.t**2
    exact = way[:, None] * down + 1.5 * s.t[:, None] * np.array([0, 1, 0])
    agree(s.position[:, 0], exact, atol=1e-13)
    # t1 is y, t2 = normal x y points up the slope
    q, rate = s.joint_coordinates("table")
    agree(q, np.stack([1.5 * s.t, -way, 2.0 * s.t], 1), atol=1e-9)
    agree(rate[-1, :2], [1.5, -0.5 - 0.5 * G * np.sin(slope)], atol=1e-12)
    table = s.joint_reactions[0, 0, :3]  # what is left of the weight
    agree(table, 2.0 * G * np.cos(slope) * np.array(normal), atol=1e-12)


@verifies("joints.Screw", r"$z = -a t^2/2$, $a = g m k^2/(m k^2 + J)$, $k = p/2\pi$", "closed form")
@BOTH
def test_screw_over_many_turns_has_order_four(looped):
    """(m k^2 + J) q'' = -m g k with k = pitch/(2 pi): z = -a t^2/2, a = g m k^2/(m k^2 + J).

    Accelerations are constant: the error is that of turning a quaternion by RK4 at up to 138 rad/s.
    """
    k, errors = -0.05 / (2.0 * np.pi), []
    a = G * 2.0 * k**2 / (2.0 * k**2 + 1e-3)
    for step in (2e-3, 1e-3, 5e-4):
        scene = Scene(gravity=(0, 0, -G))
        nut = scene.add_body(mass=2.0, inertia=[2e-3, 1.5e-3, 1e-3], name="nut")
        scene.add_joint(joints.Screw((0, 0, 1), UP, -0.05), GROUND, nut, name="thread")
        s = either(looped, scene, 1.0, step)
        q, rate = s.joint_coordinates("thread")
        slide = -0.5 * a * s.t**2
        errors.append(np.max(np.abs(q[:, 0] - slide / k)))
        # the row of the screw, which each step brings back to round-off of the turn times k
        agree(q[:, 1], k * q[:, 0], atol=1e-13)
    assert q[-1, 0] > 2.0 * np.pi * 10  # by the left-hand thread
    agree(rate[-1], [-a / k, -a], rtol=1e-9)
    np.testing.assert_allclose(orders(errors), 4.0, rtol=0, atol=0.2)
    agree(errors[-1], 0.0, atol=1e-6)


@verifies("joints.PointOnLine", r"$r = r_0 \cosh\omega t$", "closed form")
@BOTH
def test_bead_on_a_rotating_wire_has_order_four(looped):
    """r'' = w^2 r on a straight wire that turns at w: r = r0 cosh(w t). Its inertia keeps w to 1e-12."""
    errors = []
    for step in (0.04, 0.02, 0.01):
        scene = Scene(gravity=(0, 0, 0))
        wire = scene.add_body(mass=1.0, inertia=[1e12] * 3, angular_velocity=(0, 0, 2), name="wire")
        bead = scene.add_body(
            mass=0.1, inertia=[1e-4, 2e-4, 2e-4], position=(0.5, 0, 0), velocity=(0, 1, 0),
            angular_velocity=(1, 2, 3), name="bead",
        )  # fmt: skip
        scene.add_joint(joints.Revolute((0, 0, 0), UP), GROUND, wire)
        scene.add_joint(joints.PointOnLine((0.5, 0, 0), (1, 0, 0)), wire, bead, name="hole")
        s = either(looped, scene, 1.0, step)
        q, rate = s.joint_coordinates("hole")
        exact = 0.5 * np.cosh(2.0 * s.t), np.sinh(2.0 * s.t)
        errors.append(
            max(np.max(np.abs(q[:, 0] + 0.5 - exact[0])), np.max(np.abs(rate[:, 0] - exact[1])))
        )
    np.testing.assert_allclose(orders(errors), 4.0, rtol=0, atol=0.15)
    agree(errors[-1], 0.0, atol=1e-7)


@verifies(
    "joints.PointOnPlane", r"$(m l^2 \sin^2 q + J)\,\dot q^2/2 = E - m g l \cos q$", "closed form"
)
@BOTH
def test_rod_whose_tip_slides_on_a_plane(looped):
    """Upright rod that tips over, its tip on a smooth table: the centre falls straight down, and

    (m l^2 sin^2 + J) q'^2/2 = E - m g l cos, q from the vertical, l half its length. Turned by 30
    degrees about the vertical.
    """
    l, lean, spin = 0.5, 0.3, 1.0
    axis, along = np.array([0.5, np.sqrt(0.75), 0.0]), np.array([np.sqrt(0.75), -0.5, 0.0])
    centre = np.array([0.2, 0.1, l * np.cos(lean)])
    tip = centre - l * (np.sin(lean) * along + np.cos(lean) * np.array(UP))
    scene = Scene(gravity=(0, 0, -G))
    # z along the rod, y the axis it turns about: moments J = 1/12 across
    orientation = carom.geometry.quaternion.multiply(
        about(UP, np.arctan2(along[1], along[0])), about((0, 1, 0), lean)
    )
    rod = scene.add_body(
        mass=1.0, inertia=[1 / 12, 1 / 12, 1e-3], position=centre, orientation=orientation,
        velocity=(0, 0, -l * np.sin(lean) * spin), angular_velocity=spin * axis, name="upright",
    )  # fmt: skip
    scene.add_joint(joints.PointOnPlane(tip, UP), GROUND, rod, name="tip")
    s = either(looped, scene, 0.5, 0.0025)
    agree(s.position[:, 0, :2], centre[:2] + 0 * s.t[:, None], atol=1e-13)
    cos = s.position[:, 0, 2] / l
    assert cos[-1] < 0.3  # it has gone far

    def inertia(c):
        return l**2 * (1.0 - c * c) + 1 / 12

    energy = 0.5 * inertia(np.cos(lean)) * spin**2 + G * l * np.cos(lean)
    fast = np.sqrt(2.0 * (energy - G * l * cos) / inertia(cos))
    # up to 8 rad/s: (q' h)^4 = 2e-7
    agree(s.angular_velocity[:, 0] @ axis, fast, atol=1e-7)

    # the time to get there, by quadrature
    def falls(a):
        return np.sqrt(inertia(np.cos(a)) / (2.0 * (energy - G * l * np.cos(a))))

    time = quad(falls, lean, np.arccos(cos[-1]), epsabs=1e-13)[0]
    agree(time, 0.5, atol=1e-8)
    # the tip slides against the fall
    q, rate = s.joint_coordinates("tip")
    slide = -l * (np.sqrt(1.0 - cos**2) - np.sin(lean))
    agree(q, slide[:, None] * along[:2], atol=1e-12)
    agree(rate[-1], -l * fast[-1] * cos[-1] * along[:2], atol=1e-7)


def shafts(bend):
    """Two shafts in bearings, bent by `bend` about z, joined by a cross whose pin in the first is z."""
    out = np.array([np.cos(bend), np.sin(bend), 0.0])
    scene = Scene(gravity=(0, 0, -G))
    first = scene.add_body(
        mass=1.0, inertia=[0.02, 0.03, 0.03], position=(-1, 0, 0), angular_velocity=(3, 0, 0),
        name="first",
    )  # fmt: skip
    second = scene.add_body(
        mass=1.0, inertia=[0.05, 0.04, 0.04], position=out, orientation=about(UP, bend),
        angular_velocity=3.0 * np.cos(bend) * out, name="second",
    )  # fmt: skip
    cross = joints.Universal((0, 0, 0), UP, np.cross(UP, out))
    scene.add_joint(joints.Revolute((-1, 0, 0), (1, 0, 0)), GROUND, first, name="in")
    scene.add_joint(joints.Revolute(out, out), GROUND, second, name="out")
    scene.add_joint(cross, first, second, name="cross")
    return scene


@verifies("joints.Universal", r"$\tan q_2 = \tan q_1 \cos\beta$; time by quadrature", "closed form")
def test_cardan_shaft_has_order_four():
    """tan(q2) = tan(q1) cos(bend), the energy of both shafts, and with it q1 over time.

    dq2/dq1 = r = cos(bend)/(1 - sin^2(bend) sin^2(q1)), q1' = (2 E/(J1 + J2 r^2))^(1/2).
    """
    bend, errors = 0.6, []

    def inertia(a):
        ratio = np.cos(bend) / (1.0 - (np.sin(bend) * np.sin(a)) ** 2)
        return 0.02 + 0.05 * ratio**2

    start = 9.0 * inertia(0.0)
    for step in (0.02, 0.01, 0.005):
        s = carom.simulate(shafts(bend), 3.0, step=step)
        a, b = (s.joint_coordinates(k)[0][:, 0] for k in ("in", "out"))
        wrong = np.sin(b) * np.cos(a) - np.cos(b) * np.sin(a) * np.cos(bend)
        agree(wrong, 0.0, atol=1e-13)
        agree(b[-1], a[-1], atol=0.2)  # both counted all turns
        assert max(np.max(e) for e in s.constraint_errors) < 1e-13
        time = quad(lambda x: np.sqrt(inertia(x) / start), 0.0, a[-1], epsabs=1e-13, limit=200)[0]
        errors.append(abs(time - 3.0))
    assert a[-1] > 2.0 * np.pi
    np.testing.assert_allclose(orders(errors), 4.0, rtol=0, atol=0.2)
    agree(errors[-1], 0.0, atol=1e-8)
    # the pins of the cross, as the second shaft goes round a cone in the axes of the first
    q, _ = s.joint_coordinates("cross")
    exact = [np.arctan(np.tan(bend) * np.cos(a)) - bend, np.arcsin(np.sin(bend) * np.sin(a))]
    agree(q.T, exact, atol=1e-12)


def forest(seed, **more):
    rng = np.random.default_rng(seed)
    return plan(rng, len(MORE), floating=0.0, kinds=rng.permutation(MORE), each=True, **more)


@pytest.mark.parametrize("seed", range(4))
@BOTH
def test_reactions_equal_a_dense_solve(seed, looped):
    scene = build(forest(seed))
    if looped:
        scene = with_loop(scene)
    _, wrenches, _, wrong = solve(scene)
    assert wrong < 1e-8
    found = wrench_on_centre(scene, carom.simulate(scene, 1e-3, step=1e-3, options=SHARP))
    scale = np.max(np.abs(wrenches))
    np.testing.assert_allclose(found, wrenches[:, 0], rtol=0, atol=2e-7 * scale)


@pytest.mark.parametrize("seed", range(4))
def test_back_ends_orders_and_flips_move_alike(seed):
    """A line or plane that would be walked from its point takes the loops' back end."""
    rows, rng = forest(seed), np.random.default_rng(seed)
    tree = moved(build(rows), 0.1, 1e-3)
    loop = moved(with_loop(build(rows)), 0.1, 1e-3, LOOPS)
    bodies, edges, n = rng.permutation(len(rows)), rng.permutation(len(rows)), len(rows)
    names = [k for k in range(n) if rows[k]["kind"] not in ("PointOnLine", "PointOnPlane")]
    mixed = moved(build(rows, bodies=bodies, edges=edges, flips=set(names)), 0.1, 1e-3)
    for other in (loop, mixed):
        for body in tree.scene.bodies:
            i, k = body.index, other.scene[body.name].index
            for word, within in (("position", 1e-10), ("velocity", 1e-9), ("orientation", 1e-10)):
                a, b = getattr(tree, word)[-1, i], getattr(other, word)[-1, k]
                np.testing.assert_allclose(b, a, rtol=0, atol=within)
        for joint in tree.scene.joints:
            same = other.scene[joint.name]
            sign = 1.0 if same.child.name == joint.child.name else -1.0
            f, g = tree.joint_reactions[-1, joint.index], other.joint_reactions[-1, same.index]
            np.testing.assert_allclose(sign * g[:3], f[:3], rtol=1e-7, atol=1e-6)
    twice = build(rows)  # every joint once more: half the rows are redundant
    for joint in twice.joints:
        twice.add_joint(joint.definition, joint.parent, joint.child)
    double = moved(twice, 0.1, 1e-3, LOOPS)
    np.testing.assert_allclose(double.position[-1], tree.position[-1], rtol=0, atol=1e-10)
    fine = carom.simulate(build(rows), 0.1, step=5e-4)
    drift = [np.max(np.abs(s.ledger.residual)) for s in (tree, fine)]
    assert drift[1] < 1e-8 * np.max(fine.kinetic_energy)
    assert drift[1] < drift[0] / 8.0 or drift[0] < 1e-11


def test_line_of_the_child_takes_the_loops_back_end():
    """Bead first, wire second, both free: the walk starts at the bead, against the joint."""
    found = []
    for names in (("wire", "bead"), ("bead", "wire")):
        scene = Scene(gravity=(0, 0, 0))
        at = {"wire": (0, 0, 0), "bead": (0.5, 0, 0)}
        for name in names:
            scene.add_body(
                mass=1.0, inertia=[0.1, 0.2, 0.2], position=at[name], name=name,
                velocity=(0, 2 * at[name][0], 0), angular_velocity=(1, 0, 2),
            )  # fmt: skip
        hole = joints.PointOnLine((0.5, 0, 0), (1, 0, 0))
        scene.add_joint(hole, scene["wire"], scene["bead"], name="hole")
        found.append(moved(scene, 1.0, 0.01, LOOPS if names[0] == "bead" else FOREST))
    np.testing.assert_allclose(
        found[1].position[:, ::-1], found[0].position, rtol=0, atol=1e-12
    )  # fmt: skip
    a, b = (s.joint_coordinates("hole")[0] for s in found)
    np.testing.assert_allclose(b, a, rtol=0, atol=1e-12)
    assert a[-1, 0] > 0.5  # it is thrown outwards
