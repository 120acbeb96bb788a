"""``carom info``: print a summary of a result file."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any

import typer

from carom.cli import show


def run(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE", exists=True, show_default=False,
            help="Result file of 'carom simulate' or Solution.save.",
        ),
    ],
    scene: Annotated[
        bool, typer.Option("--scene", help="Print the scene as JSON; 'carom simulate' can read it.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print everything as JSON.")] = False,
) -> int:  # fmt: skip
    """Print a summary of a result file.

    The summary has the scene and its bodies, the settings and the end of the run, impacts and persistent
    contacts, the energy balance, the version of carom that wrote the file, and the references to cite.

    For example:
      carom info die.h5
      carom info die.h5 --json | jq .impacts
      carom info die.h5 --scene > die.json
    """
    import carom

    solution = carom.Solution.load(file)
    if scene:
        from carom.io.files.scene_parts import scene_to_text

        print(scene_to_text(solution.scene))
        return 0
    found = facts(solution, file)
    if json:
        show.as_json(found)
    else:
        _print(found)
    return 0


def facts(solution, file: Path) -> dict[str, Any]:
    """Return the contents of a solution as plain values."""
    from carom.scene.summary import KINDS

    attributes = {k: solution._run.attributes[k] for k in ("source", "citation", "references")}
    made, ledger = solution.scene, solution.ledger
    energy = {
        name: float(getattr(ledger, name)[-1])
        for name in ("kinetic", "potential", "loads", "impacts", "friction", "bounces")
    }
    energy["start"] = float(ledger.kinetic[0] + ledger.potential[0])
    energy["greatest_residual"] = float(abs(ledger.residual).max())
    return {
        "file": str(file), "bytes": file.stat().st_size, **attributes,
        "status": solution.status.name, "message": solution.message, "warnings": solution.warnings,
        "reached": float(solution.t[-1]), "saved_steps": len(solution.t),
        "settings": solution.settings, "stats": solution.stats,
        "gravity": made.gravity,
        "bodies": [
            {
                "name": body.name, "mass": body.mass,
                "shape": "no shape" if body.shape is None else repr(body.shape),
                "position": solution.position[-1, k], "speed": math.hypot(*solution.velocity[-1, k]),
            }
            for k, body in enumerate(made.bodies)
        ],
        "joints": [f"{one.name}: {type(one.definition).__name__}" for one in made.joints],
        "parts": {kind: len(getattr(made, kind)) for kind in KINDS}, "summary": _summary(made),
        "impacts": _impacts(solution), "held": _held(solution), "energy": energy,
    }  # fmt: skip


def _summary(made) -> str:
    from carom.scene.summary import counts

    there = [part for part in counts(made).split(", ") if not part.startswith("0 ")]
    if made._pairs.default is not None:
        there.append("all pairs may touch")
    return ", ".join(there)


def _impacts(solution) -> dict[str, Any]:
    found = solution.impacts
    if not len(found):
        return {"count": 0}
    return {
        "count": len(found), "first": float(found.time[0]), "last": float(found.time[-1]),
        "energy": float(found.energy_change.sum()),
        "greatest_normal_impulse": float(found.impulse[:, 0].max()),
        "located": int(found.located.sum()),
    }  # fmt: skip


def _held(solution) -> dict[str, Any]:
    found = solution.contacts
    return {
        "intervals": len(found), "points_at_end": int((solution.forces.saved == len(solution.t) - 1).sum()),
        "greatest_residual": float(solution.held_residual.max(initial=0.0)),
    }  # fmt: skip


def _print(found: dict[str, Any]) -> None:
    settings, impacts, held, energy = (found[k] for k in ("settings", "impacts", "held", "energy"))
    span = ""
    if impacts["count"]:
        span = (
            f", t = {impacts['first']:.6g} to {impacts['last']:.6g} s, energy {impacts['energy']:.4g} J, "
            f"greatest normal impulse {impacts['greatest_normal_impulse']:.4g} N s"
        )
        late = impacts["count"] - impacts["located"]
        span += f", {late} of them at the ends of steps" if late else ""
    given = ", ".join(
        f"{name} {value:g}" if isinstance(value, float) else f"{name} {value}"
        for name, value in settings.items()
        if value is not None
    )
    counted = ", ".join(f"{n} {name.replace('_', ' ')}" for name, n in found["stats"].items() if n)
    show.table(
        ["", ""],
        [
            ("file", f"{found['file']}, {found['bytes'] / 1e6:.2f} MB, written by {found['source']}"),
            ("ended", f"{found['status']}: {found['message']}"),
            *(("warning", one) for one in found["warnings"] if found["status"] != "INACCURATE"),
            ("time", f"0 to {found['reached']:g} s in {found['saved_steps']} saved steps"),
            ("settings", given), ("counts", counted), ("scene", found["summary"]),
            ("impacts", f"{impacts['count']}{span}"),
            ("persistent contact", f"{held['intervals']} intervals, {held['points_at_end']} points at the end, "
                                   f"greatest residual {held['greatest_residual']:.1e} m/s"),
            ("cite", f"{found['source']}, and its method: {found['citation']}"),
        ],
        left=2,
    )  # fmt: skip
    print()
    show.table(
        ["energy / J", ""],
        [
            ("at the start", f"{energy['start']:.6g}"), ("loads", f"{energy['loads']:.6g}"),
            ("impacts", f"{energy['impacts']:.6g}"), ("friction", f"{energy['friction']:.6g}"),
            ("dropped bounces", f"{energy['bounces']:.6g}"),
            ("at the end", f"{energy['kinetic'] + energy['potential']:.6g}"),
            ("greatest residual", f"{energy['greatest_residual']:.1e}"),
        ],
    )  # fmt: skip
    print()
    rows = [
        (
            body["name"], body["shape"], f"{body['mass']:.4g}",
            " ".join(f"{x:.4g}" for x in body["position"]), f"{body['speed']:.3g}",
        )
        for body in found["bodies"][:SHOWN]
    ]  # fmt: skip
    show.table(["body", "shape", "mass / kg", "at the end / m", "speed / m/s"], rows, left=2)
    if len(found["bodies"]) > SHOWN:
        print(f"and {len(found['bodies']) - SHOWN} more (all with --json)")


SHOWN = 20  # bodies in the table
