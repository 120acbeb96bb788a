"""`load_model`: make a scene from a model."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom import arguments, checks
from carom.io.models.actuators import add_actuators
from carom.io.models.build import Build, Names
from carom.io.models.contacts import add_contacts
from carom.io.models.coordinates import add_coordinate_parts, add_mounts
from carom.io.models.equalities import add_equalities
from carom.io.models.joints import join
from carom.io.models.leftovers import report_leftovers
from carom.io.models.links import Link, moving_links, name_of, possible_inertia
from carom.io.models.mocap import drive, first_velocity, motions_of
from carom.io.models.model import Model
from carom.io.models.overlaps import lift_out, pose
from carom.io.models.reading import compiled_model
from carom.io.models.report import Report
from carom.io.models.robot import robot_of
from carom.io.models.solids import (
    Solid,
    add_standing,
    colour,
    covering,
    geoms_of,
    look_of,
    world_look,
)
from carom.io.models.state import as_it_acts, is_off, point_velocity, starting_data
from carom.io.models.tendons import add_tendons, needs_link
from carom.io.models.touching import Filter
from carom.scene import forces
from carom.scene.materials import IMPACT_LAWS
from carom.scene.scene import Scene

RESTITUTION = (
    0.0  # where neither the caller nor the model has one: MuJoCo's own contacts hardly bounce
)
# masses and moments of links between two joints of one body, as a part of the body's: nothing to the solver of
# trees; that of loops takes five times as long with lighter ones (`carom.dynamics.light_bodies`)
LIGHT, LIGHT_IN_LOOPS = 1e-12, 1e-6


@arguments.known
def load_model(
    source: str | os.PathLike | Any,
    *,
    restitution: float | None = None,
    friction: float | None = None,
    impact_law: str = "newton",
    limit_restitution: float = 0.0,
    keyframe: int | str | None = None,
    qpos: ArrayLike | None = None,
    qvel: ArrayLike | None = None,
    free_root: bool = False,
    contacts: bool = True,
    armature: bool = True,
    overlaps: str = "repair",
    max_hull_vertices: int | None = 64,
    mocap: Mapping[str, Sequence] | None = None,
    package_dirs: Sequence[str | os.PathLike] = (),
) -> Model:
    """Read a model in MJCF or URDF and make a scene from it. Needs ``carom[models]``.

    The report of the model has an entry for each part that is left out or changed in the scene.

    Parameters
    ----------
    source : path, str, mujoco.MjSpec or mujoco.MjModel
        A file, an XML text, or a model of MuJoCo.
    restitution : float, optional
        Restitution of all contacts, 0 to 1. Default: ``<custom><numeric name="restitution" data="..."/>`` of
        the model, otherwise 0. (Neither format has an own element for it.)
    friction : float, optional
        Sliding friction of all contacts. Default: by MuJoCo's rule the larger value of the two geoms of a pair,
        or that of the geom with the higher priority.
    impact_law : {"newton", "poisson", "stronge", "moreau"}
        Law of restitution of contacts and of joint limits. Default ``"newton"``.
    limit_restitution : float
        Restitution of joint limits. Default 0.
    keyframe : int or str, optional
        Number or name of the keyframe with the initial state. Default: the default configuration, at rest.
    qpos : (nq,), optional
        Initial coordinates, as in MuJoCo.
    qvel : (nv,), optional
        Initial velocities, as in MuJoCo.
    free_root : bool
        True: give the one body that is attached to the world a free joint, for the URDF of a robot that walks
        or flies. Default False.
    contacts : bool
        False: leave out all contacts. Default True.
    armature : bool
        True (default): add the inertia of motors to the joints (`forces.JointInertia`). False: leave it out.
    overlaps : {"repair", "refuse"}
        Treatment of parts that penetrate each other at the start. ``"repair"`` (default): parts with a free
        joint are moved out of fixed parts, and other such pairs get no contact. ``"refuse"``: raise an error.
    max_hull_vertices : int or None
        Most corners of the convex hull of a mesh, at least 4. Default 64. A hull of more is replaced by that of
        some of its corners, and the report says how far it reaches beyond that. Masses and inertias stay those
        of the model. None: keep all corners.
    mocap : mapping, optional
        Motions of mocap bodies by name: up to six for a body, of its displacements along the world's x, y and
        z [m], then of its turns [rad] about x, y and z, one after the other, from where the model puts it. Each
        is a `motion` of `constraints.Driver`, or None: this coordinate stays. Other mocap bodies are fixed.
    package_dirs : sequence of path
        Folders in which ``package://`` paths of a URDF are searched, besides the folders above the file.

    Returns
    -------
    Model
        The model with its `scene`, its `report`, and its parts by name.

    Raises
    ------
    ModuleNotFoundError
        If the package mujoco is missing.
    FileNotFoundError
        If the file does not exist.
    TypeError, ValueError
        If the model cannot be read (with the message of MuJoCo), has no moving body, or an argument is outside
        its range.
    """
    if restitution is not None:
        checks.number("restitution", restitution, least=0.0, most=1.0)
    if friction is not None:
        friction = checks.number("friction", friction, least=0.0)
    checks.choice("impact_law", impact_law, IMPACT_LAWS)
    checks.number("limit_restitution", limit_restitution, least=0.0, most=1.0)
    checks.choice("overlaps", overlaps, ("repair", "refuse"))
    if max_hull_vertices is not None:
        max_hull_vertices = checks.integer("max_hull_vertices", max_hull_vertices, least=4)
    for name, value in (("free_root", free_root), ("contacts", contacts), ("armature", armature)):
        checks.flag(name, value)
    if isinstance(source, os.PathLike) or (isinstance(source, str) and "<" not in source):
        checks.path("source", source)
    package_dirs = [
        checks.path("each of package_dirs", one)
        for one in checks.listed("package_dirs", package_dirs, "paths")
    ]
    report = Report()
    model = compiled_model(source, free_root, package_dirs, report)
    motions = motions_of(model, mocap)
    acts = as_it_acts(model, motions)
    lines = any(needs_link(acts, t) for t in range(acts.ntendon))
    light = LIGHT_IN_LOOPS if lines or motions or np.any(acts.eq_active0) else LIGHT
    data = starting_data(acts, keyframe, qpos, qvel)
    build, links = _new_build(acts, data, report, light, max_hull_vertices)
    restitution = _restitution(model, restitution, report)
    rules, contacts = Filter(model), contacts and not is_off(model, "CONTACT", "CONSTRAINT")
    if contacts and friction is None:
        groups = [[g for g in geoms_of(build, one) if rules.touches_at_all(g)] for one in links]
        rules.tell_apart(groups, restitution)
    standing = add_standing(build, rules) if contacts else []
    covers = {link.body: covering(build, link, rules) for link in links}
    jointed = [link for link in links if link.body not in motions]
    if overlaps == "repair":
        lift_out(build, jointed, covers, standing, rules)
    for link in links:
        given = motions.get(link.body, [])
        shape, geoms = covers[link.body]
        material = rules.material(geoms[0]) if geoms else None
        _add_body(build, link, shape, material, given, look_of(build, link, covers[link.body]))
        if given:
            drive(build, link, given)
        else:
            join(build, link)
    _add_gravcomp(build)
    add_coordinate_parts(build, limit_restitution, impact_law, armature)
    add_mounts(build, jointed, limit_restitution, impact_law)
    motors = add_actuators(build, add_tendons(build, limit_restitution, impact_law))
    add_equalities(build)
    if contacts:
        moving = [
            Solid(build.moving(one.body), covers[one.body][1], one.body not in motions)
            for one in links
        ]
        solids = [*moving, *standing]
        add_contacts(build, solids, rules, restitution, friction, impact_law, overlaps == "refuse")
    report_leftovers(model, motions, report)
    build.scene.look = world_look(build, rules)
    build.scene._robot = robot_of(build, links, motors)
    return _finished(build, model, links, covers, restitution)


def _new_build(
    model, data, report: Report, light: float, most_corners: int | None
) -> tuple[Build, list[Link]]:
    """Return a new `Build`, with the fixed and the moving bodies of the model."""
    links = moving_links(model)
    if not links:
        raise ValueError(
            "the model must have a body that moves, got no body with a joint; give free_root=True if it is a "
            "robot that walks or flies"
        )
    scene = Scene(gravity=np.zeros(3) if is_off(model, "GRAVITY") else model.opt.gravity)
    names = Names(link.name for link in links)
    return Build(model, data, scene, report, names, light, most_corners), links


def _restitution(model, given: float | None, report: Report) -> float:
    """Return the restitution of all contacts: that of the caller, of the model, or the default."""
    if given is not None:
        return float(given)
    for k in range(model.nnumeric):
        if model.numeric(k).name == "restitution":
            return checks.number(
                "restitution of the model", float(model.numeric(k).data[0]), least=0.0, most=1.0
            )
    report.add("contacts", "the model has no restitution", f"restitution={RESTITUTION:g} for all")
    return RESTITUTION


def _add_body(build: Build, link: Link, shape, material, motions, look) -> None:
    """Add the body of a link, with its position and motion."""
    centre, orientation = pose(build, link)
    motion = point_velocity(build.model, build.data, link.body, centre)
    motion += first_velocity(motions, centre - build.data.xpos[link.body])
    inertia, change = possible_inertia(link.inertia)
    if change > 1e-11:
        what = "its inertia is impossible for a rigid body"
        instead = f"the nearest possible one, with a relative change of {change:.1e}"
        build.report.add(f"body {link.name!r}", what, instead)
    build.bodies[link.body] = build.scene.add_body(
        shape,
        mass=link.mass,
        inertia=inertia,
        position=centre,
        orientation=orientation,
        velocity=motion[:3],
        angular_velocity=motion[3:],
        material=material,
        color=colour(build, geoms_of(build, link)),
        look=look,
        name=link.name,
    )


def _add_gravcomp(build: Build) -> None:
    """Add the forces that compensate a part of the weight of bodies."""
    model = build.model
    for b in np.flatnonzero(model.body_gravcomp):
        lift = -model.body_gravcomp[b] * model.body_mass[b] * build.scene.gravity
        if model.body_weldid[b] == 0 or not np.any(lift):
            continue
        name = build.names.new(f"{name_of(model, 'body', int(b))}:gravcomp", "force")
        force = forces.Force(lift, anchor=build.data.xipos[b])
        build.scene.add_force(force, build.carrier(int(b)), name=name)


def _finished(build: Build, m, links, covers, restitution: float) -> Model:
    """Return the model, with all parts by name."""
    for link in links:
        for g in covers[link.body][1]:
            build.geoms[g] = build.moving(link.body)
    robot = build.scene.robot
    assert robot is not None
    return Model(
        scene=build.scene,
        report=build.report,
        bodies={name_of(m, "body", b): build.carrier(b) for b in range(m.nbody)},
        joints=robot.joints,
        geoms={name_of(m, "geom", g): part for g, part in sorted(build.geoms.items())},
        restitution=restitution,
        mujoco=m,
    )
