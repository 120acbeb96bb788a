"""The `Robot` of a scene: what the model calls its coordinates, controls, sensors and keyframes."""

from __future__ import annotations

from carom.io.models.build import Build
from carom.io.models.links import Link, name_of
from carom.io.models.report import need_mujoco
from carom.io.models.sensors import sensors_of
from carom.results.robot import Ball, FreeBody, Keyframe, Motor, Robot


def robot_of(build: Build, links: list[Link], motors: list[Motor]) -> Robot:
    """Return the robot of a scene in the making."""
    m, free = build.model, need_mujoco().mjtJoint.mjJNT_FREE
    places = {j: (int(m.jnt_qposadr[j]), int(m.jnt_dofadr[j])) for j in range(m.njnt)}
    balls = [Ball(name_of(m, "joint", j), joint, *places[j]) for j, joint in build.balls.items()]
    frees = [
        FreeBody(
            link.name, build.moving(link.body), link.centre, *places[int(m.body_jntadr[link.body])]
        )
        for link in links
        if m.body_jntnum[link.body] and m.jnt_type[m.body_jntadr[link.body]] == free
    ]
    keys = [
        Keyframe(name_of(m, "key", k), m.key_qpos[k], m.key_qvel[k], m.key_ctrl[k])
        for k in range(m.nkey)
    ]
    return Robot(
        build.data.qpos, tuple(build.coordinates.values()), tuple(balls), tuple(frees), tuple(keys),
        tuple(motors), tuple(sensors_of(build, links, motors)), tuple(build.lines),
    )  # fmt: skip
