"""Contact that stays, kind by kind, at random: true errors against what was asked, and trial steps.

    python benchmarks/contact_kinds.py all 20                    20 seeds of each kind
    python benchmarks/contact_kinds.py "block on a block" 5      one kind
    python benchmarks/contact_kinds.py pair 1000 --rtol 1e-8     random blocks on blocks
    python benchmarks/contact_kinds.py gripper 1 --first 17      one again

The reference is the same run at `rtol=1e-12`. An error is the greatest of a place or an arc at the end, divided
by atol + rtol of the size: at most ten is allowed. Trial steps at 1e-8 have a bound for each kind. A line names
a run that breaks one of these, that fails, or that lasts longer than a second.
"""

from __future__ import annotations

import argparse
import time
import warnings

import numpy as np

import carom
from carom import GROUND, constraints, forces, joints
from true_errors import error

FINE, TOLERANCES, G = 1e-12, (1e-4, 1e-6, 1e-8, 1e-10), 9.81
SMOOTH, STOP, TURN = (
    150,
    250,
    400,
)  # trial steps: no stop; a stop; a corner that rests and slips again
SHAPES = ("box", "prism", "cylinder", "table", "rounded box")


def scene_with(rng, friction=(0.1, 0.5), restitution=0.0, floor=True):
    """Return a scene with a floor, and the friction of its contacts."""
    scene, mu = carom.Scene(gravity=(0, 0, -G)), rng.uniform(*friction)
    if floor:
        scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.set_contact_default(restitution=restitution, friction=mu)
    return scene, mu


def shape(rng, size=0.2):
    """Return a shape that can stand on a face, and its height above that face."""
    kind = SHAPES[int(rng.integers(len(SHAPES)))]
    x, y, z = size * rng.uniform([0.7, 0.7, 0.3], [1.2, 1.2, 0.6])
    if kind == "prism":
        turns = 2.0 * np.pi / 5.0 * (np.arange(5) + rng.uniform(-0.2, 0.2, 5))
        base = 0.5 * x * np.c_[np.cos(turns), np.sin(turns)]
        solid = carom.Convex([(*p, h) for p in base for h in (0.0, z)])
        return solid, -float(solid.support(np.array([0.0, 0.0, -1.0]))[2])
    if kind == "cylinder":
        return carom.Cylinder(0.5 * x, z), 0.5 * z
    if kind == "table":
        legs = [(0.4 * x * i, 0.4 * y * j, -0.5 * z) for i in (-1, 1) for j in (-1, 1)]
        top = (carom.Box(x, y, 0.02), (0, 0, 0.01))
        table = carom.Compound([top, *((carom.Box(0.03, 0.03, z), leg) for leg in legs)])
        return table, -float(table.support(np.array([0.0, 0.0, -1.0]))[2])
    return carom.Box(x, y, z, radius=0.01 if kind == "rounded box" else 0.0), 0.5 * z


def slide(rng, speed=1.0, spin=4.0):
    """Return a velocity along the floor, and an angular velocity about the vertical."""
    return np.append(speed * rng.normal(size=2), 0.0), (0.0, 0.0, spin * rng.normal())


def add(scene, solid, low, rng, at=(0.0, 0.0, 0.0), **motion):
    """Add a body that stands on the height of `at`, turned about the vertical."""
    v, w = slide(rng, **motion)
    place = np.add(at, (0, 0, low))
    turned = carom.euler("z", rng.uniform(0, 360))
    return scene.add_body(
        solid, mass=rng.uniform(0.5, 3.0), position=place, orientation=turned, velocity=v, angular_velocity=w
    )  # fmt: skip


def on_half_space(rng):
    """Slide and turn on a half-space, to a stop or not."""
    scene, _ = scene_with(rng)
    add(scene, *shape(rng), rng, speed=1.5, spin=9.0)
    return scene, rng.uniform(0.2, 0.5)


def on_static_box(rng):
    """The same on a static box."""
    scene, _ = scene_with(rng, floor=False)
    scene.add_static(carom.Box(6, 6, 0.2), position=(0, 0, -0.1))
    add(scene, *shape(rng), rng, speed=1.5, spin=9.0)
    return scene, rng.uniform(0.2, 0.5)


def on_a_block(rng):
    """A shape that slides and turns on a block that does so, too."""
    scene, _ = scene_with(rng)
    high = rng.uniform(0.08, 0.15)
    add(scene, carom.Box(1.2, 1.0, high), 0.5 * high, rng, speed=0.7, spin=1.0)
    add(scene, *shape(rng), rng, (*rng.uniform(-0.1, 0.1, 2), high), speed=0.7, spin=4.0)
    return scene, rng.uniform(0.1, 0.3)


def that_pivots(rng):
    """A fast turn on a slow block: a corner comes to rest while others slip."""
    scene, _ = scene_with(rng, (0.2, 0.3))
    add(scene, carom.Box(0.7, 0.6, 0.12), 0.06, rng, speed=0.6, spin=1.0)
    add(scene, carom.Box(0.24, 0.12, 0.08), 0.04, rng, (0, 0, 0.12), speed=0.4, spin=5.0)
    return scene, 0.2


def pile(rng):
    """Three blocks on each other."""
    scene, _ = scene_with(rng)
    z = 0.0
    for size in (1.0, 0.5, 0.2):
        x, y, high = size * rng.uniform([0.9, 0.9, 0.15], [1.1, 1.1, 0.3])
        add(scene, carom.Box(x, y, high), 0.5 * high, rng, (0, 0, z), speed=0.6, spin=1.0)
        z += high
    return scene, rng.uniform(0.1, 0.25)


def ball_on_ball(rng):
    """A ball that rolls off a ball that rolls."""
    scene, _ = scene_with(rng, (0.2, 0.6))
    a, b, tilt = rng.uniform(0.1, 0.3), rng.uniform(0.05, 0.2), rng.uniform(0.02, 0.2)
    v = np.append(0.2 * rng.normal(size=2), 0.0)
    scene.add_body(carom.Sphere(a), mass=rng.uniform(1, 4), position=(0, 0, a), velocity=v)
    top = np.array([(a + b) * np.sin(tilt), 0, a + (a + b) * np.cos(tilt)])
    scene.add_body(carom.Sphere(b), mass=rng.uniform(0.3, 2), position=top)
    return scene, 0.2


def loop_on_the_floor(rng, feet=False):
    """A parallelogram of bars whose lowest, or whose two legs, slide on the floor."""
    scene, _ = scene_with(rng)
    v = (rng.uniform(0.3, 1.5), 0, 0)
    half, leg = rng.uniform(0.15, 0.25), rng.uniform(0.25, 0.4)
    sizes = [(2.5 * half, 0.1, 0.1), (0.1, 0.1, leg), (0.1, 0.1, leg), (2.0 * half, 0.1, 0.1)]
    low, high = (0.2 * leg, 0.8 * leg) if feet else (0.1, 0.1 + leg - 0.05)
    middle = 0.5 * leg if feet else 0.1 + 0.5 * (leg - 0.05)
    at = [(0, 0, low if feet else 0.05), (-half, 0, middle), (half, 0, middle), (0, 0, high)]
    bars = [
        scene.add_body(carom.Box(*size), mass=rng.uniform(0.3, 1.5), position=p, velocity=v)
        for size, p in zip(sizes, at)
    ]
    ends = [(-half, low, 0, 1), (half, low, 0, 2), (-half, high, 1, 3), (half, high, 2, 3)]
    for x, z, i, j in ends:
        scene.add_joint(joints.Revolute((x, 0, z), (0, 1, 0)), bars[i], bars[j])
    return scene, rng.uniform(0.15, 0.3)


def loop_on_two_feet(rng):
    """The same on two feet."""
    return loop_on_the_floor(rng, True)


def cart(rng):
    """A cart on two balls, with rolling friction."""
    scene = carom.Scene(gravity=(0, 0, -G))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    r, v = rng.uniform(0.07, 0.12), rng.uniform(0.5, 1.5)
    body = scene.add_body(
        carom.Box(0.4, 0.05, 0.05), mass=1, position=(0.2, 0, r), velocity=(v, 0, 0)
    )
    for x in (0.0, 0.4):
        wheel = scene.add_body(
            carom.Sphere(r), mass=rng.uniform(0.5, 2), position=(x, 0, r),
            velocity=(v, 0, 0), angular_velocity=(0, v / r, 0),
        )  # fmt: skip
        scene.add_joint(joints.Revolute((x, 0, r), (0, 1, 0)), body, wheel)
        mu = rng.uniform(0.3, 0.8)
        scene.add_contact(
            wheel, floor, restitution=0, friction=mu, rolling_friction=rng.uniform(3e-4, 3e-3)
        )
    return scene, 0.5


def capsule(rng):
    """A capsule that slides, rolls and turns on a static box."""
    scene, _ = scene_with(rng, floor=False)
    scene.add_static(carom.Box(6, 6, 0.2), position=(0, 0, -0.1))
    r, (v, w) = rng.uniform(0.03, 0.07), slide(rng, 1.0, 3.0)
    scene.add_body(
        carom.Capsule(r, rng.uniform(0.1, 0.3)), mass=1, position=(0, 0, r),
        orientation=carom.euler("y", 90), velocity=v, angular_velocity=w,
    )  # fmt: skip
    return scene, 0.4


def plank(rng):
    """A plank that rocks on a cylinder, slides or not."""
    scene, _ = scene_with(rng, (0.2, 0.8), floor=False)
    r, thick = rng.uniform(0.2, 0.4), rng.uniform(0.03, 0.06)
    scene.add_static(carom.Cylinder(r, 1.0), position=(0, 0, -r), orientation=carom.euler("y", 90))
    v = (rng.uniform(-0.4, 0.4), 0, 0)
    y = rng.uniform(-0.02, 0.02)
    scene.add_body(carom.Box(0.3, 0.2, thick), mass=1, position=(0, y, 0.5 * thick), velocity=v)
    return scene, 0.4


def door(rng):
    """A door on three hinges that strikes a post and leans on it."""
    scene, _ = scene_with(rng, floor=False)
    wide = rng.uniform(0.6, 1.0)
    w = rng.uniform(1.0, 3.0)
    leaf = scene.add_body(
        carom.Box(wide, 0.04, 2.0), mass=20, position=(0.5 * wide, 0, 1),
        velocity=(0, 0.5 * wide * w, 0), angular_velocity=(0, 0, w),
    )  # fmt: skip
    hinges = [joints.Revolute((0, 0, z), (0, 0, 1)) for z in (0.2, 1.0, 1.8)]
    first, *_ = [scene.add_joint(hinge, GROUND, leaf) for hinge in hinges]
    scene.add_force(forces.JointForce(first, rng.uniform(2.0, 10.0)))
    post = scene.add_static(carom.Sphere(0.05), position=(0.8 * wide, 0.2, rng.uniform(0.5, 1.5)))
    scene.add_contact(leaf, post, restitution=0, friction=rng.uniform(0, 0.5))
    return scene, 0.8


def arm(rng):
    """An arm of two links that pushes a box over the floor."""
    scene, _ = scene_with(rng)
    a, b = rng.uniform(0.3, 0.5), rng.uniform(0.2, 0.4)
    upper = scene.add_body(
        carom.Capsule(0.03, a), mass=2, position=(0.5 * a, 0, 0.1), orientation=carom.euler("y", 90)
    )
    lower = scene.add_body(
        carom.Capsule(0.03, b),
        mass=1,
        position=(a + 0.5 * b, 0, 0.1),
        orientation=carom.euler("y", 90),
    )
    one = scene.add_joint(joints.Revolute((0, 0, 0.1), (0, 0, 1)), GROUND, upper)
    two = scene.add_joint(joints.Revolute((a, 0, 0.1), (0, 0, 1)), upper, lower)
    scene.add_force(forces.JointForce(one, rng.uniform(1.0, 4.0)))
    scene.add_force(forces.JointSpring(two, stiffness=rng.uniform(3, 10), damping=0.1))
    x, y, z = rng.uniform([0.15, 0.15, 0.15], [0.25, 0.25, 0.25])
    at = (a + rng.uniform(0.2, 1) * b, 0.03 + 0.5 * y, 0.5 * z)
    scene.add_body(carom.Box(x, y, z), mass=rng.uniform(0.5, 2), position=at)
    return scene, 0.4


def gripper(rng):
    """A box that two plates hold by friction, shaken sideways."""
    scene, reach, rate = (
        carom.Scene(gravity=(0, 0, -G)),
        rng.uniform(0.005, 0.05),
        rng.uniform(10, 20),
    )
    hand = scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=1, position=(0, 0, 2))
    rail = scene.add_joint(joints.Prismatic((0, 1, 0)), GROUND, hand)

    def motion(t):
        angle = rate * t
        sine, cosine = reach * np.sin(angle), reach * np.cos(angle)
        return reach - cosine, rate * sine, rate * rate * cosine

    scene.add_constraint(constraints.Driver(rail, motion=motion))
    box = scene.add_body(carom.Box(0.05, 0.04, 0.04), mass=0.2, position=(0, 0, 0.12))
    force, mu = rng.uniform(8, 15), rng.uniform(0.3, 0.6)
    for side in (-1, 1):
        plate = scene.add_body(
            carom.Box(0.02, 0.4, 0.4), mass=0.05, position=(0.035 * side, 0, 0.12)
        )
        joint = scene.add_joint(joints.Prismatic((-side, 0, 0)), hand, plate)
        scene.add_force(forces.JointForce(joint, force))
        scene.add_contact(plate, box, restitution=0, friction=mu)
    return scene, 0.3


def over_an_edge(rng):
    """A block that slides and turns over the edge of a table, and stays on it."""
    scene, _ = scene_with(rng, (0.3, 0.5), floor=False)
    scene.add_static(carom.Box(2, 4, 0.2), position=(-1, 0, -0.1))
    x = rng.uniform(0.15, 0.2)
    w, v = (0.0, 0.0, rng.normal() * 4), (0.4, 0.3 * rng.normal(), 0)
    place = (-0.62 * x, 0, 0.03)
    scene.add_body(carom.Box(x, x, 0.06), mass=1, position=place, velocity=v, angular_velocity=w)
    return scene, 0.15


def overhang(rng):
    """A block that hangs over the edge of a block on which it slides."""
    scene, _ = scene_with(rng, (0.2, 0.4))
    x, high = rng.uniform(0.3, 0.4), rng.uniform(0.06, 0.12)
    v = (0.3 * rng.normal(), 0.3 * rng.normal(), 0)
    scene.add_body(carom.Box(x, x, high), mass=3, position=(0, 0, 0.5 * high), velocity=v)
    at = (0.4 * x, rng.uniform(-0.05, 0.05), high)
    add(scene, carom.Box(0.2, 0.15, 0.06), 0.03, rng, at, speed=0.2, spin=2.0)
    return scene, 0.2


def leaves_a_table(rng):
    """A block that slides off a table, tips and falls."""
    scene, _ = scene_with(rng, (0.05, 0.4), floor=False)
    scene.add_static(carom.Box(2, 4, 0.2), position=(-1, 0, -0.1))
    x, y, z = rng.uniform([0.15, 0.1, 0.04], [0.2, 0.2, 0.08])
    v = (rng.uniform(0.8, 1.5), 0, 0)
    scene.add_body(carom.Box(x, y, z), mass=1, position=(-0.6 * x, 0, 0.5 * z), velocity=v)
    return scene, 0.25


def tips_over_an_edge(rng):
    """A block whose centre is beyond the edge tips from rest."""
    scene, _ = scene_with(rng, (0.4, 0.9), floor=False)
    scene.add_static(carom.Box(2, 4, 0.2), position=(-1, 0, -0.1))
    x, y, z = rng.uniform([0.15, 0.1, 0.04], [0.2, 0.2, 0.08])
    beyond = rng.uniform(0.01, 0.2) * x
    scene.add_body(carom.Box(x, y, z), mass=1, position=(beyond, 0, 0.5 * z))
    return scene, 0.2


def pair(rng, seed):
    """A block of any size, mass and friction on a block, to a stop and beyond."""
    rng = np.random.default_rng(5)
    for _ in range(seed + 1):
        a = rng.uniform([1.0, 0.9, 0.05], [1.6, 1.4, 0.15])
        b = rng.uniform([0.1, 0.08, 0.04], [0.35, 0.3, 0.12])
        m = rng.uniform(0.3, 5, 2)
        va, vb = rng.normal(size=2) * 0.8, rng.normal(size=2) * 0.8
        wa, wb = rng.normal(size=2) * [1.5, 6]
        mu, off = rng.uniform(0.05, 0.5, 2), rng.uniform(-0.1, 0.1, 2)
        duration, turn = rng.uniform(0.1, 0.5), rng.uniform(0, 3)
    scene = carom.Scene(gravity=(0, 0, -G))
    floor = scene.add_half_space((0, 0, 0), (0, 0, 1))
    low = scene.add_body(
        carom.Box(*a), mass=m[0], position=(0, 0, 0.5 * a[2]), velocity=(*va, 0), angular_velocity=(0, 0, wa)
    )  # fmt: skip
    high = scene.add_body(
        carom.Box(*b), mass=m[1], position=(*off, a[2] + 0.5 * b[2]), velocity=(*vb, 0),
        orientation=(np.cos(0.5 * turn), 0, 0, np.sin(0.5 * turn)), angular_velocity=(0, 0, wb),
    )  # fmt: skip
    scene.add_contact(low, floor, restitution=0, friction=mu[0])
    scene.add_contact(high, low, restitution=0, friction=mu[1])
    return scene, duration


#: kinds, and the trial steps that are allowed at 1e-8
KINDS = {
    "block on a half-space": (on_half_space, 60),
    "block on a static box": (on_static_box, 60),
    "block on a block": (on_a_block, STOP),
    "block that pivots": (that_pivots, TURN),
    "pile of three": (pile, STOP),
    "ball on a ball": (ball_on_ball, SMOOTH),
    "loop on the floor": (loop_on_the_floor, STOP),
    "loop on two feet": (loop_on_two_feet, STOP),
    "cart": (cart, SMOOTH),
    "capsule": (capsule, STOP),
    "plank": (plank, STOP),
    "door": (door, SMOOTH),
    "arm": (arm, STOP),
    "gripper": (gripper, STOP),
    "over an edge": (over_an_edge, STOP),
    "overhang": (overhang, STOP),
    "leaves a table": (leaves_a_table, SMOOTH),
    "tips over an edge": (tips_over_an_edge, SMOOTH),
    "pair": (pair, STOP),
}


def one(kind: str, seed: int, rtol: float) -> tuple[carom.Solution, float]:
    """Return a run of which only the end is saved, and its processor time."""
    make, rng = KINDS[kind][0], np.random.default_rng([17, list(KINDS).index(kind), seed])
    scene, duration = make(rng, seed) if make is pair else make(rng)
    start = time.process_time()
    run = carom.simulate(scene, duration, rtol=rtol, save_at=[duration], throw=False)
    return run, time.process_time() - start


def campaign(kind: str, seeds: range, tolerances: tuple[float, ...]) -> None:
    """Print the runs that break a bound, then a line for each tolerance."""
    most, table = KINDS[kind][1], {rtol: [] for rtol in tolerances}
    for seed in seeds:
        exact, _ = one(kind, seed, FINE)
        for rtol in tolerances:
            run, seconds = one(kind, seed, rtol)
            trials, off = run.stats["trial_steps"], error(run, exact, rtol)
            table[rtol].append((off, trials, seconds))
            named = {s.status.name for s in (run, exact)} | {
                w.split("\n")[0][:90] for w in run.warnings
            }
            if (
                not off <= 10.0
                or seconds > 1.0
                or named != {"SUCCESS"}
                or (rtol == 1e-8 and trials > most)
            ):
                rest = "" if named == {"SUCCESS"} else f" {named}"
                print(
                    f"  {kind}, {seed}, {rtol:g}: {off:.1e}, {trials} trials, {seconds:.2f} s{rest}",
                    flush=True,
                )
    for rtol, rows in table.items():
        off, trials, seconds = np.array(rows).T
        print(
            f"{kind}, {rtol:g}: error median {np.median(off):.1e}, worst {off.max():.1e}; trials "
            f"{np.median(trials):.0f}, {trials.max():.0f} (bound {most} at 1e-08); "
            f"{np.median(seconds):.2f} s, {seconds.max():.2f} s",
            flush=True,
        )  # fmt: skip


def main() -> None:
    """Run one kind, or all."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("kind", choices=[*KINDS, "all"])
    parser.add_argument("count", type=int)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--rtol", type=float, nargs="*", default=TOLERANCES)
    given = parser.parse_args()
    warnings.simplefilter("ignore")
    for kind in KINDS if given.kind == "all" else [given.kind]:
        campaign(kind, range(given.first, given.first + given.count), tuple(given.rtol))


if __name__ == "__main__":
    main()
