"""Turn a scene into flat arrays, once, before a run."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from carom._compiled.record_arrays import Columns, table
from carom._compiled.template import Template
from carom._compiled.user_functions import Functions
from carom.geometry import quaternion
from carom.geometry.thresholds import LAST_DIGIT
from carom.model import graph, solvers
from carom.model.arrays import (
    ABSENT,
    BODY,
    CHART_CONSTRAINT,
    JOINT,
    KIND,
    SCREW,
    STATE,
    MovingSurfaces,
    System,
)
from carom.model.chart import ROWS_OF_ELEMENT, Chart, no_chart
from carom.model.contacts import Contacts, Surfaces, compile_contacts, more_contacts
from carom.model.cores import arms_of
from carom.model.flexible import bodies_of_modes, flexible_bodies, refuse_others
from carom.model.forces import Place
from carom.model.laws import LawTable
from carom.model.moving_surfaces import moving_surfaces
from carom.model.pieces import Pieces
from carom.model.placement import Placement, put_in
from carom.model.relations import Coordinates, Elements
from carom.model.stated_forces import ForceRows
from carom.model.stops import with_stops
from carom.model.thresholds import EQUAL_MOMENTS, LARGEST_MASS_RATIO, MASS_RATIO
from carom.model.user_surfaces import add_functions
from carom.options import Options
from carom.scene.all_pairs import Defaults, PairTable, joined_tables, some_pairs
from carom.scene.coordinates import Combination, Length, terms_of
from carom.scene.joint_friction import DryFriction
from carom.scene.more_forces import JointInertia
from carom.scene.scene import Scene
from carom.scene.switches import is_off


class Compiled(NamedTuple):
    """A scene as arrays, and the maps from these back to the parts and axes of the scene."""

    system: System
    start: np.recarray  # (N,) STATE
    to_principal: np.ndarray  # (N, 4) principal axes -> the scene's body axes
    flipped: np.ndarray  # (J,) joints whose parent and child were exchanged
    functions: Functions  # of the user's
    pairs: PairTable  # the two sides of each contact, by its number
    surfaces: Surfaces  # data from which rows of contacts are made
    later: Defaults | None  # pairs of bodies that get rows when they come near each other
    numbers: dict[
        tuple[Any, int | str], int
    ]  # of coordinates, by the index of the joint and their own
    places: dict[int, Place]  # where kernels find the forces, by their index


def compile_scene(
    scene: Scene, options: Options, loops: bool = False, implicit: bool = False, apart: bool = False
) -> Compiled:
    """Return the arrays of `scene`.

    With `loops`, even a forest has the block-sparse back end. With `implicit`, springs are rows of the solve,
    not forces. If bodies move `apart`, in islands, many pairs have no rows until they come near each other
    (`with_pairs`).
    """
    made = _Moved(scene, options, loops, implicit)
    # stops have the numbers after those of all pairs, so no pair may be added later
    may_come = apart and bool(made.bodies["ballistic"].any())
    may_come = may_come and not scene.stops and not scene.switches
    touching = compile_contacts(scene, made.to_principal, options, made.laws, may_come)
    add_functions(scene, touching, made.functions)
    contacts = with_stops(scene, touching.rows, made.elements, options, made.laws)
    if scene._off:
        off = [one.index for one in scene.contacts if is_off(scene, one)]
        contacts = contacts[~np.isin(contacts["number"], off)].view(Columns)
    return made.compiled(touching, contacts, moving_surfaces(scene, made.functions))


def compile_for_reports(scene: Scene) -> Compiled:
    """Return the arrays of a scene without its contacts, with all forces as forces and all coordinates."""
    made = _Moved(scene, Options(), False, False)
    made.coordinates.report(scene.joints, scene.stops)
    bare, touching = _bare()
    return made.compiled(touching, touching.rows, bare)


@cache
def _bare() -> tuple[MovingSurfaces, Contacts]:
    """Return the moving surfaces and the contacts of a scene that has none."""
    scene = Scene()
    scene.add_body(mass=1.0, inertia=(1.0, 1.0, 1.0))
    contacts = compile_contacts(scene, _start(scene)[1], Options(), LawTable())
    return moving_surfaces(scene, Functions()), contacts


class _Moved:
    """The bodies of a scene, and all that acts on them but contacts, as arrays."""

    def __init__(self, scene: Scene, options: Options, loops: bool, implicit: bool):
        self.scene = scene
        self.functions = Functions() if scene._chart is None else scene._chart.functions
        self.start, self.to_principal, moments = _start(scene)
        self.placement = Placement(self.start, self.to_principal, scene._placed)
        self.coordinates = Coordinates(self.placement)
        self.coordinates.count(scene)
        pieces, self.laws = Pieces(), LawTable()
        self.elements = Elements(
            scene, self.coordinates, self.functions, pieces, start_sizes(scene)
        )
        if implicit:
            self.elements.add_springs(scene, self.placement)
        self.forces = ForceRows(
            scene, self.placement, self.coordinates, self.functions, pieces, self.laws, implicit
        )
        if scene._chart is None:
            self.chart = no_chart()
            self.joints, self.flipped, self.solver = _joints(
                scene, moments, self.placement, self.elements, options, loops
            )
        else:
            self.chart = scene._chart.arrays(options.drop_tolerance)
            self.joints, self.flipped, self.solver = _constraints(self.chart)
        self.forces.turn(self.flipped)
        alone, joined = _tethered(scene)
        loaded = np.append(self.forces.loaded, alone)
        self.bodies = _bodies(scene, moments, self.joints, self.elements, loaded, joined)
        self.bodies["axes"] = self.to_principal
        if len(scene.bodies) > 1:
            turns = map(tuple, self.to_principal.tolist())
            own = [(b.shape, q) for b, q in zip(scene.bodies, turns)]
            self.bodies["arm"] = [(0.0,) * 3 if s is None else arms_of(s, q) for s, q in own]

    def compiled(self, touching: Contacts, contacts: np.recarray, moving) -> Compiled:
        """Return the whole, with contacts and surfaces that move."""
        relations = self.elements.arrays(self.solver, self.forces)
        system = System(
            bodies=self.bodies, gravity=np.array(self.scene.gravity), joints=self.joints,
            relations=relations, forces=self.forces.tables, contacts=contacts, laws=self.laws.arrays(),
            vertices=touching.vertices, solids=touching.solids, hulls=touching.hulls,
            levels=touching.levels, solver=self.solver, moving=moving, chart=self.chart,
            flexible=flexible_bodies(self.scene),
        )  # fmt: skip
        refuse_others(self.scene, system)
        return Compiled(
            system=system, start=self.start, to_principal=self.to_principal, flipped=self.flipped,
            functions=self.functions, pairs=touching.pairs, surfaces=touching.surfaces,
            later=touching.later, numbers=self.coordinates.numbers,
            places=self.forces.places,
        )  # fmt: skip


def compiled_once(scene: Scene, options: Options, *ways: bool) -> Compiled:
    """Return what `compile_scene` does; the scene keeps the last result while it does not change."""
    key, template = scene._derived.get(Compiled, (None, None))
    if key == (options, ways):
        return template.make()._replace(functions=Functions())
    made = compile_scene(scene, options, *ways)
    if not uses_functions(made):
        scene._derived[Compiled] = (options, ways), Template(made)
    return made


def uses_functions(compiled: Compiled) -> bool:
    """Return whether a scene has functions or curves of the user, whose results may be others the next time."""
    return bool(compiled.functions._kept) or len(compiled.system.relations.pieces) > 0


def with_pairs(compiled: Compiled, scene: Scene, options: Options, found: np.ndarray) -> Compiled:
    """Return a compiled scene with rows of contacts for further pairs (K, 2) of bodies."""
    assert compiled.later is not None
    pairs, system = some_pairs(compiled.later, *found.T), compiled.system
    rows = more_contacts(scene, options, pairs, compiled.surfaces, len(compiled.pairs.body))
    contacts = np.concatenate([system.contacts, rows]).view(Columns)
    return compiled._replace(
        system=system._replace(contacts=contacts, laws=compiled.surfaces.laws.grown(system.laws)),
        pairs=joined_tables(compiled.pairs, pairs),
    )


def principal(inertia: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return principal moments (3,) and the quaternion principal -> body axes; identity if diagonal."""
    diagonal = inertia.diagonal().copy()
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = inertia.tolist()
    scale = max(xx, yy, zz)
    if scale - min(xx, yy, zz) <= EQUAL_MOMENTS * scale:
        diagonal[:] = diagonal.sum() / 3.0
    if max(map(abs, (xy, xz, yx, yz, zx, zy))) <= LAST_DIGIT * scale:
        return diagonal, np.array([1.0, 0.0, 0.0, 0.0])
    moments, axes = np.linalg.eigh(inertia)
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] *= -1.0
    if np.ptp(moments) <= EQUAL_MOMENTS * scale:
        return np.full(3, moments.mean()), np.array([1.0, 0.0, 0.0, 0.0])
    return moments, quaternion.from_matrix(axes)


def _start(scene):
    bodies = scene.bodies
    moments, to_principal = map(np.array, zip(*(principal(b.inertia) for b in bodies)))
    start = table(STATE, len(bodies))
    start["Q"] = attitudes(np.array([b.orientation for b in bodies]), to_principal)
    start["x"] = [b.position for b in bodies]
    start["v"] = [b.velocity for b in bodies]
    start["w"] = [b.angular_velocity for b in bodies]
    return start, to_principal, moments


def attitudes(orientation: np.ndarray, to_principal: np.ndarray) -> np.ndarray:
    """Return the quaternions (N, 4) from principal axes to the world of bodies with these orientations."""
    same = (to_principal[..., 0] == 1.0).all()
    Q = orientation + 0.0 if same else quaternion.multiply(orientation, to_principal)
    return Q / np.sqrt(np.add.reduce(Q * Q, axis=1, keepdims=True))


def _joints(scene, moments, placement, elements, options, loops):
    defined = scene.joints
    if not defined and not elements.kinds:
        return table(JOINT, 0), np.zeros(0, dtype=bool), solvers.no_joints()
    count, number = len(scene.bodies), len(defined)
    off = np.array([is_off(scene, j) for j in defined], dtype=bool)
    kind = np.array([KIND[type(j.definition)] for j in defined], dtype=np.int64)
    parent = np.array([j.parent.index for j in defined], dtype=np.int64)
    child = np.array([j.child.index for j in defined], dtype=np.int64)
    parent[off], child[off], there = -1, -1, np.flatnonzero(~off)
    flipped = np.zeros(number, dtype=bool)
    forest = not loops and not elements.present
    forest = forest and graph.is_forest(count, kind[there], parent[there], child[there])
    rotor = np.zeros((number, 6))
    order, carrier = np.arange(count), np.full(count, -1)
    if forest:
        order, carried, walked = graph.forest_order(count, parent[there], child[there])
        turned, carrier = np.zeros(number, dtype=bool), np.append(there, -1)[carried]
        turned[there] = walked
        rotor, along = rotors_in_tree(scene, kind, turned)
        forest = along and not np.any(turned & graph.cannot_flip(kind))
    if forest:
        flipped = turned
        parent, child = np.where(flipped, child, parent), np.where(flipped, parent, child)
    else:
        elements.add_rotors()
    joints = table(JOINT, number + len(elements.kinds))
    joints.parent[:number], joints.child[:number] = parent, child
    joints.kind = [*np.where(off, ABSENT, kind), *elements.kinds]
    joints.rows = [*(0 if is_off(scene, j) else j.definition.rows for j in defined), *elements.rows]
    for j, joint in enumerate(defined):
        definition = joint.definition
        first, second = definition.anchors(joint.anchor(), joint.child.position)
        world = definition.frame(bool(flipped[j]))
        sides = [(placement.side(joint, 0), first), (placement.side(joint, 1), second)]
        (p, a), (c, b) = sides[::-1] if flipped[j] else sides
        joints.parent_anchor[j], joints.child_anchor[j] = p.point(a), c.point(b)
        joints.parent_frame[j], joints.child_frame[j] = p.axes(world), c.axes(world)
        joints.length[j] = definition.scale()
        if joint.name in scene._placed:
            put_in(joint, scene._placed[joint.name], joints[j])
        if definition.guide == "curve" and not off[j]:
            joints.number[j] = elements.coordinates.number(joint, 0)
    touching = [[b for b in (c, p) if b >= 0] for p, c in zip(parent.tolist(), child.tolist())]
    for j, bodies in enumerate(elements.touching, start=number):
        joints.number[j] = elements.numbers[j - number]
        joints.child[j], joints.parent[j] = bodies[0] if bodies else -1, -1
    touching += elements.touching
    if forest:
        solver = solvers.tree_solver(joints, order, carrier, rotor)
    else:
        mass = np.array([b.mass for b in scene.bodies])
        ratio, light, heavy = solvers.spread(touching, mass, moments, _extents(elements, joints))
        if ratio > LARGEST_MASS_RATIO and not loops:
            names = scene.bodies[light].name, scene.bodies[heavy].name
            raise ValueError(
                f"masses, or moments over the squares of sizes, of bodies {names[0]!r} and {names[1]!r}, which "
                f"closed loops join, must not differ by more than {LARGEST_MASS_RATIO:g} times, "
                f"got {ratio:.3g} times"
            )
        solver = solvers.loop_solver(
            touching, options.drop_tolerance, 0 if elements.present else count,
            count if ratio > MASS_RATIO else 0,
        )  # fmt: skip
    return joints, flipped, solver


def _constraints(chart: Chart):
    """Return elements of the constraints of a system in coordinates of the user's own, as `_joints` does."""
    firsts = np.arange(0, chart.rows, ROWS_OF_ELEMENT)
    made = table(JOINT, len(firsts))
    made.kind, made.parent, made.rows = (
        CHART_CONSTRAINT,
        -1,
        np.minimum(ROWS_OF_ELEMENT, chart.rows - firsts),
    )
    return made, np.zeros(len(made), dtype=bool), solvers.metric_solver(len(made))


def rotors_in_tree(scene, kind, flipped) -> tuple[np.ndarray, bool]:
    """Return the inertia (J, 6) along each freedom of the joints of a forest, and whether this is possible.

    Freedoms are slides, then turns (`carom.dynamics.tree.freedoms`), along axes of the body nearer to the root.
    It is not possible for slides of a flipped planar joint, which are along axes of the other body.
    """
    out = np.zeros((len(kind), 6))
    for force in scene.forces:
        d = force.definition
        if not isinstance(d, JointInertia) or is_off(scene, force):
            continue
        j, names = d.joint.index, d.joint.definition.coordinates
        turns, slides = names.count("turn"), names.count("slide")
        which = names[: d.coordinate].count(names[d.coordinate])
        slide = names[d.coordinate] == "slide"
        if kind[j] == SCREW:
            out[j, 0] += d.inertia * (d.joint.definition.scale() ** 2 if slide else 1.0)
            continue
        if flipped[j] and slide and slides > 1:
            return out, False
        if flipped[j] and not slide:
            which = turns - 1 - which
        out[j, which if slide else slides + which] += d.inertia
    return out, True


def start_sizes(scene) -> np.ndarray:
    """Return the size (N,) of the shape of each body; without a shape, the radius r with tr J = 2 m r^2."""
    return np.array(
        [
            np.sqrt(0.5 * np.trace(b.inertia) / b.mass) if b.shape is None else b.shape.size
            for b in scene.bodies
        ]
    )


def _extents(elements: Elements, joints) -> np.ndarray:
    """Return a length (N,) of each body: the largest of the size of its shape and the arms of its joints.

    Without a shape its radius of gyration counts: a joint may be at its mass centre, or nearly so.
    """
    size = elements.sizes.copy()
    for side in ("parent", "child") if len(joints) else ():
        sides, anchors = joints[side], joints[f"{side}_anchor"]
        inside = sides >= 0
        np.maximum.at(size, sides[inside], np.linalg.norm(anchors[inside], axis=1))
    return size


def _tethered(scene) -> tuple[np.ndarray, np.ndarray]:
    """Return the bodies on tethers, -1 among them, and those that ropes join, more than two at once.

    Ropes that stretch are forces, which join nothing in an impact; dry friction does.
    """
    alone, joined = [], []
    for force in scene.forces:
        for one, _, _ in terms_of(getattr(force.definition, "joint", None), 0):
            if isinstance(one, Length) and not is_off(scene, force):
                ends = joined if isinstance(force.definition, DryFriction) else alone
                ends += [one.parent.index, one.child.index]
    for stop in scene.stops:
        for one, _, _ in terms_of(stop.joint, stop.coordinate):
            if isinstance(one, Length) and not is_off(scene, stop):
                ends = joined if isinstance(stop.joint, Combination) else alone
                ends += [one.parent.index, one.child.index]
    return np.array(alone, dtype=np.int64), np.array(joined, dtype=np.int64)


def _bodies(scene, moments, joints, elements, loaded, joined):
    bodies, number = table(BODY, len(scene.bodies)), np.arange(len(scene.bodies))
    ball = np.array([0.0 if b.shape is None else b.shape.size for b in scene.bodies])
    isolated = np.ones(len(bodies), dtype=np.int64)
    for side in ("parent", "child") if len(joints) else ():
        isolated[joints[side][joints[side] >= 0]] = 0
    for touched in (*elements.present, joined[joined >= 0]):
        isolated[touched] = 0
    flexible = bodies_of_modes(scene)
    for b in np.flatnonzero(flexible).tolist():  # an impulse on it moves its modes
        isolated[b : b + flexible[b] + 1] = 0
    bodies["modes"] = flexible
    bodies["flexible"] = np.where(flexible > 0, np.cumsum(flexible > 0), 0)
    ballistic = isolated.copy()
    ballistic[loaded[loaded >= 0]] = 0
    if scene._chart is not None:
        isolated[:] = ballistic[:] = 0
    bodies["mass"] = [b.mass for b in scene.bodies]
    bodies["inertia"], bodies["extent"], bodies["ball"] = moments, _extents(elements, joints), ball
    bodies["isotropic"] = (moments[:, 1:] == moments[:, :1]).all(axis=1)
    bodies["isolated"], bodies["ballistic"], bodies["number"] = isolated, ballistic, number
    bodies["component"] = np.where(isolated == 1, number, len(bodies))
    return bodies
