"""Derivatives of a run: `sensitivities`."""

from __future__ import annotations

import numpy as np

from carom import arguments, checks
from carom.dynamics.methods import METHODS
from carom.model.laws import law_of, with_slip
from carom.model.method import THREE_FIELD
from carom.results.solution import Solution
from carom.studies.gradient.parameters import make_parameters
from carom.studies.gradient.result import Sensitivities

WAYS = ("auto", "saltation", "differences")


@arguments.known
def sensitivities(
    solution: Solution, with_respect_to, *, by: str = "auto", throw: bool = True
) -> Sensitivities:
    """Differentiate the final state and the impacts of a run by its initial state and parameters of its scene.

    It is also called `carom.gradient`.

    There are two methods. "saltation": for bodies in free flight between impacts with one contact point; the
    exact motion is differentiated, and each impact by its saltation matrix, including the change of its time.
    "differences": for joints, forces or persistent contacts; the run is repeated in pieces from event to event,
    each piece is differentiated by finite differences, and the tangents are passed from piece to piece, so that
    errors do not grow with the length of the run.

    Parameters
    ----------
    solution : Solution
        A run with located impacts, by any method except those of the paper. For differences all steps must have
        the same length.
    with_respect_to : str or sequence of str
        Names of parameters. The names of bodies and contacts of the scene stand before the dot:

        - ``"body.position"``, ``"body.velocity"``, ``"body.angular_velocity"``: three columns each, world axes;
        - ``"body.orientation"``: three columns, a rotation vector in world axes by which the body is turned
          while velocities stay the same. For joined bodies, the rotation is projected onto the joints in the
          kinetic metric, and the joints do not move;
        - ``"body.mass"``, with constant inertia; ``"body.inertia"``: six columns xx, yy, zz, xy, xz, yz in the
          axes of the body (not by differences);
        - ``"contact.restitution"``, ``"contact.friction"`` (in impacts);
        - ``"gravity"``: three columns; ``"restitution"`` and ``"friction"``: those of all contacts together;
        - one column by its label: ``"body.velocity.x"``, ``"gravity.z"``, ``"body.inertia.xx"``.
          `carom.ensemble` and `carom.identify` take the same names.
    by : str
        ``"saltation"``, ``"differences"`` or ``"auto"`` (default): differences if the scene has joints,
        constraints or forces, otherwise saltation.
    throw : bool
        True (default): if a part of the run has no derivative by one of the parameters, raise a ValueError with
        the reason. False: return NaN for this part, and the reasons in `notes`.

    Returns
    -------
    Sensitivities
        The derivatives, and the margins to other sequences of contact.

    Raises
    ------
    TypeError
        If `solution` is not a `Solution`.
    ValueError
        If the scene does not have a parameter, or if the scene or the method is not supported. If `throw` is
        True, also if there is no derivative: in a multiple impact (except for parameters that keep its points
        together), for a persistent contact (by saltation), if slip starts from rest, or if an impact is on the
        boundary between two courses of slip and stick.

    Notes
    -----
    Mathematics page, part 5. The derivative is valid for the sequence of contact of this run; `margins` and
    `reach` give the distance to another sequence.

    Examples
    --------
    Derivative of the time of the second impact of a ball by its restitution. The ball leaves the floor with e
    times 2.8014 m/s and flies for 2 e 2.8014 / g:

    >>> scene = carom.Scene(gravity=(0, 0, -9.81))
    >>> floor = scene.add_half_space(point=(0, 0, 0), normal=(0, 0, 1), name="floor")
    >>> ball = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 0.5), name="ball")
    >>> contact = scene.add_contact(ball, floor, restitution=0.8)
    >>> solution = carom.simulate(scene, duration=0.8, step=0.01)
    >>> by_e = carom.sensitivities(solution, "ball-floor.restitution")
    >>> print(by_e.impact_time[:, 0].round(6), round(2 * 2.801428 / 9.81, 6))
    [0.       0.571137] 0.571137
    """
    checks.instance("solution", solution, (Solution,))
    checks.flag("throw", throw)
    checks.choice("by", by, WAYS)
    scene = solution.scene
    belts = [one for one in scene.half_spaces if one.moves]
    parts = (*scene.joints, *scene.constraints, *scene.forces, *belts)
    if parts and by == "saltation":
        raise ValueError(
            f'solution must be of a scene of free bodies for by="saltation", got one with {parts[0]!r}; use '
            'by="differences"'
        )
    if scene.switches:
        raise ValueError(
            f"solution must be of a scene without switches, got one with {scene.switches[0]!r}"
        )
    if scene.statics:
        raise ValueError(
            f"solution must be of a scene without static bodies, got one with {scene.statics[0]!r}"
        )
    differences = by == "differences" or bool(parts)
    settings, run = solution.settings, solution._run
    if METHODS[settings["method"]].kind == THREE_FIELD or settings["impact_location"] != "locate":
        raise ValueError(
            "solution must be of a run with located impacts and not by the paper's methods, got "
            f"method={settings['method']!r}, impact_location={settings['impact_location']!r}"
        )
    if run.options.add_layer_time:
        raise ValueError("solution must be of a run with Options(add_layer_time=False), got True")

    system = run.compiled.system
    number = 1 + int(max(system.contacts.number, default=-1))
    parameters = make_parameters(scene, with_respect_to, number, run.compiled.to_principal)
    laws = law_of(system, system.contacts)
    of_law = np.isnan(laws.restitution)
    if np.any(parameters.restitution[system.contacts.number[of_law]]):
        raise ValueError(
            "with_respect_to must not have the restitution of a contact whose restitution is a law, got "
            f"{checks.shown(with_respect_to)}; its numbers are varied by carom.ensemble"
        )
    if np.any(with_slip(laws)) or np.any(system.contacts.axis_of):
        raise ValueError(
            "solution must be of contacts whose friction is a number, got a law, whose impacts have no closed "
            "form; its numbers are varied by carom.ensemble"
        )
    if differences:
        from carom.studies.gradient.differences import differentiate

        result = differentiate(solution, parameters)
    else:
        from carom.studies.gradient.walk import Walk

        result = Walk(solution, parameters).result()
    if throw and result.notes:
        raise ValueError(
            "solution must be differentiable, got a run where "
            + "; ".join(result.notes)
            + "; use throw=False for NaN there, or a shorter duration"
        )
    return result
