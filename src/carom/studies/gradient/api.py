"""Derivatives of a run: `sensitivities`."""

from __future__ import annotations

from carom import checks
from carom.dynamics.methods import METHODS
from carom.model.method import THREE_FIELD
from carom.results.solution import Solution
from carom.studies.gradient.parameters import make_parameters
from carom.studies.gradient.result import Sensitivities

WAYS = ("auto", "saltation", "differences")


def sensitivities(
    solution: Solution, with_respect_to, *, by: str = "auto", throw: bool = True
) -> Sensitivities:
    """Differentiate a run: its final state and its impacts, by its start and by numbers of its scene.

    Bodies that fly freely between impacts of one point each are differentiated along the exact motion, each
    impact by its saltation matrix, with the time at which it happens. With joints, forces or contacts that are
    held the run is taken again in pieces from event to event, each piece is differentiated by differences, and
    tangents are handed on: errors do not grow with the length of the run.

    Parameters
    ----------
    solution : Solution
        By any method but the paper's, with located impacts. By differences, with steps of one length.
    with_respect_to : str or sequence of str
        With the names of bodies and contacts of the scene before the dot:

        - ``"body.position"``, ``"body.velocity"``, ``"body.angular_velocity"``: three columns each, world axes;
        - ``"body.orientation"``: three, a rotation vector in world axes by which the body is turned, with
          velocities as they are. Where bodies are joined: what the joints let pass of it, nearest in the
          kinetic metric, the joints being where they are;
        - ``"body.mass"``, with the inertia as it is; ``"body.inertia"``: six, xx, yy, zz, xy, xz, yz in the
          axes of the body (not by differences);
        - ``"contact.restitution"``, ``"contact.friction"`` (in impacts);
        - ``"gravity"``: three; ``"restitution"`` and ``"friction"`` of all contacts together.
    by : str
        ``"saltation"``, ``"differences"`` or ``"auto"`` (default): differences if the scene has joints,
        constraints or forces.
    throw : bool
        True (default): if a part of the run has no derivative by one of the parameters, a ValueError says
        why. False: NaN there, and the reasons in `notes`.

    Returns
    -------
    Sensitivities

    Raises
    ------
    TypeError
        If `solution` is no `Solution`.
    ValueError
        For names that the scene does not know; for scenes and methods that are not as above; and if `throw`
        where there is no derivative: several points strike at once (except by parameters that keep them
        together), a contact is held (by saltation), slip starts from rest, an impact is about to take another
        course.

    Notes
    -----
    Mathematics page, part 5. The derivative belongs to the sequence of contact of this run; `margins` and
    `reach` say how far it is from another one.

    Examples
    --------
    By how much the second impact of a ball comes later for more restitution: it leaves the floor with e times
    2.8014 m/s, and is in the air for 2 e 2.8014 / g.

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
    parts = (*scene.joints, *scene.constraints, *scene.forces)
    if parts and by == "saltation":
        raise ValueError(
            f'solution must be of a scene of free bodies for by="saltation", got one with {parts[0]!r}; take '
            'by="differences"'
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
            + "; give throw=False to have NaN there, or a shorter duration"
        )
    return result
