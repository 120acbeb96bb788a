"""The contact of a profile that ends a run: the two bodies are no longer in one plane."""

from __future__ import annotations

import math

import numpy as np

from carom.geometry import quaternion
from carom.results.names import contact_name
from carom.scene.profile_pairs import slant
from carom.status import Status


def tipped(run, status: Status) -> str:
    """Return a sentence about the profile and the near body that are tipped most; "" for another status."""
    if status is not Status.OUT_OF_PLANE:
        return ""
    scene, pairs, now = run.scene, run.pairs, run.now
    turns = quaternion.multiply(now["Q"], quaternion.conjugate(run.compiled.to_principal))
    most, number = 0.0, -1
    for k, (b, other, plane) in enumerate(zip(pairs.body, pairs.other, pairs.plane)):
        one, two = scene.bodies[b], scene.fixed[plane] if plane >= 0 else scene.bodies[other]
        there = (two.position, two.orientation) if plane >= 0 else (now["x"][other], turns[other])
        if (
            hasattr(two, "normal")
            or math.dist(now["x"][b], there[0]) > one.shape.size + two.shape.size
        ):
            continue
        angle = slant(one.shape, turns[b], two.shape, there[1])
        if angle > most:
            most, number = angle, k
    if number < 0:
        return ""
    return (
        f"the bodies of the contact {contact_name(scene, pairs, number)!r} tip out of one plane by more than "
        "the degree within which a Profile touches its partners "
        f"({np.degrees(most):.1f} degrees at the end of the last step). Hold both in this plane by joints "
        "(Planar, Revolute, Prismatic), or leave the contact out by Scene.ignore_contact"
    )
