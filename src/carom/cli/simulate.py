"""``carom simulate``: run a scene and save the result."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated, Any

import typer

from carom.cli import CTRL_C, FAILED, scenes, show
from carom.cli.outcome import Refused, warn


def run(
    scene: Annotated[
        Path | None,
        typer.Argument(
            metavar="SCENE", exists=True, dir_okay=False, show_default=False,
            help="A Python file that defines 'scene' (a carom.Scene, or a function that returns one), a scene"
            " as JSON, a result file (for its scene and settings), or a model (MJCF, URDF).",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", "-o", metavar="FILE", show_default=False,
            help="Result file: .nc or .h5 (the whole result, written repeatedly during the run), .csv or"
            " .parquet (its tables, written at the end). Without it nothing is saved.",
        ),
    ] = None,
    duration: Annotated[
        float | None,
        typer.Option("--duration", "-d", metavar="S", help="Time to simulate [s].", show_default=False),
    ] = None,
    until: Annotated[
        list[str] | None,
        typer.Option(
            metavar="EVENT", show_default=False,
            help="End the run at an event: 'at rest', or 'first impact of A and B' with the names of two parts."
            " May be given several times. The file is then written at the end only.",
        ),
    ] = None,
    step: Annotated[
        str | None,
        typer.Option(
            metavar="S|auto", show_default="auto", help="Time step [s]; 'auto': chosen by the tolerances."
        ),
    ] = None,
    method: Annotated[
        str | None,
        typer.Option(
            show_default="rk5 or rk8 by the tolerance; rk4 with a given step",
            help="Time integrator of the smooth motion: rk4, rk5, rk8, rattle, rattle4, rattle6, implicit,"
            " paper, paper-ode.",
        ),
    ] = None,
    impact_location: Annotated[
        str | None,
        typer.Option(show_default="locate", help="Impacts: locate, project (as in the paper) or work."),
    ] = None,
    rtol: Annotated[float | None, typer.Option(show_default="1e-8", help="Relative tolerance.")] = None,
    atol: Annotated[
        float | None, typer.Option(show_default="rtol of the smallest body", help="Absolute tolerance [m].")
    ] = None,
    save_at: Annotated[
        float | None,
        typer.Option(metavar="S", show_default="duration / 200", help="Interval between saved states [s]."),
    ] = None,
    save_every: Annotated[
        int | None,
        typer.Option(metavar="N", show_default="1", help="Save every N-th of these states, or of the steps."),
    ] = None,
    save_seconds: Annotated[
        float, typer.Option(metavar="S", help="Interval between two savings of the file [s of real time].")
    ] = 60.0,
    resume: Annotated[
        Path | None,
        typer.Option(
            exists=True, dir_okay=False, metavar="FILE", show_default=False,
            help="Continue the interrupted run in this file; with --duration also a finished run, beyond its"
            " end. SCENE is needed only if the scene has user-defined functions, which files cannot contain.",
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing FILE.")] = False,
    restitution: Annotated[
        float | None, typer.Option(show_default=False, help="For a model: restitution of all contacts.")
    ] = None,
    friction: Annotated[
        float | None, typer.Option(show_default=False, help="For a model: friction of all contacts.")
    ] = None,
    impact_law: Annotated[
        str | None, typer.Option(show_default=False, help="For a model: newton, poisson or stronge.")
    ] = None,
    keyframe: Annotated[
        str | None,
        typer.Option(show_default=False, help="For a model: keyframe to start from, by name or number."),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print the summary as JSON.")] = False,
) -> int:  # fmt: skip
    """Run a scene and save the result.

    The file is written repeatedly during the run. If the run is stopped (by Ctrl-C, kill or a power cut), the
    file has the results up to then, and --resume continues from there, bit for bit as without interruption. The
    result of a run that fails is saved up to the failure.

    For example:
      carom simulate die.py -o die.h5 --duration 2
      carom simulate die.py -o die.h5 --duration 9 --until "at rest"
      carom simulate die.py -o die.h5 --duration 2 --rtol 1e-10 --save-at 0.001
      carom simulate --resume die.h5
      carom simulate --resume die.h5 --duration 4        continue to 4 s
      carom simulate die.h5 -o finer.h5 --rtol 1e-10     run the same scene again
      carom simulate robot.xml -o robot.h5 -d 5 --restitution 0.3 --friction 0.5

    die.py:
      import carom
      scene = carom.Scene()
      scene.add_half_space((0, 0, 0), (0, 0, 1))
      scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.3))
      scene.set_contact_default(restitution=0.5, friction=0.2)
    """
    model = {
        "restitution": restitution, "friction": friction, "impact_law": impact_law, "keyframe": keyframe,
    }  # fmt: skip
    given = {
        "duration": duration, "step": _step(step), "method": method, "impact_location": impact_location,
        "rtol": rtol, "atol": atol, "save_every": save_every, "save_at": save_at, "until": until or None,
    }  # fmt: skip
    begin = time.perf_counter()
    if resume is not None:
        out = resume
        solution, lost = _go_on(resume, scene, duration, {**given, **model}, save_seconds)
    else:
        solution, lost = _start(scene, out, {k: v for k, v in given.items() if v is not None}, model,
                                save_seconds, force)  # fmt: skip
    if lost is None:
        return _end(solution, out, scene, time.perf_counter() - begin, json)
    _end(solution, None, scene, time.perf_counter() - begin, json)
    warn("simulate", lost)
    return FAILED


def _step(given: str | None) -> float | str | None:
    if given is None or given == "auto":
        return given
    try:
        return float(given)
    except ValueError:
        raise Refused(f"--step must be a number [s] or 'auto', got {given!r}") from None


def _start(scene, out, given: dict[str, Any], model, save_seconds: float, force: bool):
    import carom
    from carom.io.files.convert import is_table

    if scene is None:
        raise Refused(
            "SCENE is missing: a file with a scene, or --resume FILE (see 'carom simulate --help')"
        )
    if out is not None and out.exists() and not force:
        raise Refused(
            f"--out must be a new file, got {str(out)!r}; --force overwrites it, and "
            f"'carom simulate --resume {out}' continues an interrupted run"
        )
    try:
        tables = out is not None and is_table(out)
    except ValueError as error:
        raise Refused(str(error).replace("path must", "--out must", 1)) from None
    found = scenes.load(scene, **model)
    kept = {k: v for k, v in found.settings.items() if k in _SETTINGS and v is not None}
    for name, others in _INSTEAD.items():
        if name in given:
            kept = {k: v for k, v in kept.items() if k not in others}
    settings = {**kept, **given}
    if "duration" not in settings:
        raise Refused("--duration must be given [s]")
    duration, until = settings.pop("duration"), settings.pop("until", None)
    at_end = out is not None and (tables or until is not None)
    with show.progress("simulate") as bar:
        solution, lost = _with_its_loss(
            carom.simulate, found.scene, duration, progress=bar, save=None if at_end else out,
            save_seconds=save_seconds, events=until, **settings,
        )  # fmt: skip
    if at_end:
        solution.save(out)
    return solution, lost


def _with_its_loss(call, *given, **settings):
    """Run; return the solution, and a message if it succeeded and could not be saved, or None."""
    from carom import SimulationError

    try:
        return call(*given, **settings), None
    except (SimulationError, KeyboardInterrupt) as error:
        solution = getattr(error, "solution", None)
        if solution is None:
            raise
        return solution, str(error) if solution.success else None


#: settings in a result file that a new run takes over
_SETTINGS = (
    "duration", "step", "method", "impact_location", "rtol", "atol", "save_every", "save_at",
)  # fmt: skip
#: settings that a new run does not take over if another setting replaces them
_INSTEAD = {
    "step": ("rtol", "atol", "method"), "rtol": ("step", "method", "atol"), "atol": ("step", "method"),
    "save_at": ("save_every",), "save_every": ("save_at",),
}  # fmt: skip


def _go_on(path: Path, scene, duration: float | None, given: dict[str, Any], save_seconds: float):
    import carom

    names = [k for k, v in given.items() if v is not None and k != "duration"]
    if names:
        name = names[0].replace("_", "-")
        raise Refused(
            f"--{name} must be left out with --resume: the settings of the run stay the same"
        )
    mine = scenes.functions(scenes.load(scene).scene) if scene is not None else None
    with show.progress("resume") as bar:
        try:
            return _with_its_loss(
                carom.resume, path, until=duration, functions=mine or None, progress=bar,
                save_seconds=save_seconds,
            )  # fmt: skip
        except ValueError as error:
            raise ValueError(str(error).replace("until must", "--duration must")) from error


def _end(solution, out: Path | None, scene: Path | None, seconds: float, json: bool) -> int:
    """Print the outcome of the run; return the exit code."""
    from carom.io.files.convert import TABLES
    from carom.status import Status

    facts = {
        "status": solution.status.name, "message": solution.message,
        "warnings": solution.warnings, "reached": float(solution.t[-1]),
        "duration": solution.settings["duration"], "saved_steps": len(solution.t),
        "impacts": len(solution.impacts), "seconds": seconds, "file": None if out is None else str(out),
    }  # fmt: skip
    if json:
        show.as_json(facts)
    else:
        place = f", in {out}" if out is not None else ""
        print(
            f"t = 0 to {facts['reached']:g} s in {facts['saved_steps']} saved steps, "
            f"{facts['impacts']} impacts, {seconds:.1f} s{place}"
        )
        if solution.success and getattr(solution, "t_events", None) is not None:
            print(solution.message)
    if solution.success:
        return 0
    if solution.status is not Status.INTERRUPTED:
        warn("simulate", solution.message)
        return FAILED
    more = "the run cannot be continued, because it has no file: use -o FILE.nc"
    if getattr(solution, "t_events", None) is not None:
        more = "a run with --until cannot be continued"
    elif out is not None and out.suffix.lower() not in TABLES:
        also = f" {scene}" if scene is not None and _has_functions(solution) else ""
        more = f"continue with: carom simulate --resume {out}{also}"
    warn("simulate", f"interrupted at t = {facts['reached']:g} s; {more}")
    return CTRL_C


def _has_functions(solution) -> bool:
    return bool(getattr(solution, "scene", None) is not None and scenes.functions(solution.scene))
