"""``carom bench``: how fast this machine is."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from carom.cli import show
from carom.cli.outcome import Refused, warn


def run(
    problems: Annotated[
        list[str] | None,
        typer.Argument(metavar="PROBLEM", show_default="all", help="Only these, by their names in the table."),
    ] = None,
    rounds: Annotated[int, typer.Option(min=1, metavar="N", help="Measurements of each.")] = 5,
    peers: Annotated[
        bool, typer.Option("--peers", help="Measure MuJoCo too (if installed), in the same run.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print everything as JSON.")] = False,
) -> int:  # fmt: skip
    """Measure standard problems on this machine.

    Processor time of one thread, medians and quartiles, with the error against the exact answer: a
    time says nothing without it. Both tools take the same step. Takes about a minute, and some minutes the
    first time, while everything is compiled.

    For example:
      carom bench
      carom bench chain_10 four_bar --rounds 11
      carom bench --peers --json > here.json
    """
    from carom.bench import measure, standard

    known = [problem.name for problem in standard.problems()]
    for name in problems or []:
        if name not in known:
            raise Refused(f"PROBLEM must be one of {', '.join(known)}, got {name!r}")
    module = measure.peer("mujoco") if peers else None
    if peers and module is None:
        warn("bench", "MuJoCo is not installed (pip install mujoco): its columns are left out")
    with show.progress("bench") as bar:

        def tell(done: int, total: int, name: str) -> None:
            bar(done, total)
            bar.tell(name)

        rows = list(standard.run(problems, rounds, module, tell))
    if json:
        show.as_json({"machine": measure.machine(), "problems": [row.as_dict() for row in rows]})
    else:
        _print(rows, rounds, module is not None)
        print(f"\n{measure.machine_line()}")
    return 0


def _print(rows: list[Any], rounds: int, beside: bool) -> None:
    head = ["", "unit", "carom", "error"] + ["MuJoCo", "error"] * beside
    table = []
    for row in rows:
        cells = [row.problem.name, row.problem.unit, *_cells(row.ours)]
        table.append([*cells, *(_cells(row.theirs) if beside else ())])
    show.table(head, table, left=2)
    print(f"\nmedian and quartiles of {rounds}")
    show.table(
        ["", "", "error is"],
        [(r.problem.name, r.problem.what, r.problem.error or "none") for r in rows], left=3,
    )  # fmt: skip


def _cells(side: Any) -> tuple[str, str]:
    if side is None:
        return "", ""
    return side.time.text(), "" if side.error is None else f"{side.error:.0e}"
