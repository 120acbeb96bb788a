"""``carom bench``: measure the speed of this machine."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from carom.cli import show
from carom.cli.outcome import Refused, warn


def run(
    problems: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="PROBLEM", show_default="all", help="Problems to measure, by their names in the table."
        ),
    ] = None,
    rounds: Annotated[int, typer.Option(min=1, metavar="N", help="Measurements of each problem.")] = 5,
    peers: Annotated[
        bool, typer.Option("--peers", help="Also measure MuJoCo in the same run, if installed.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print everything as JSON.")] = False,
) -> int:  # fmt: skip
    """Measure standard problems on this machine.

    Prints the processor time of one thread (median and quartiles) and the error against the exact answer,
    because a time without an error means little. All tools use the same time step. This takes about a minute,
    and some minutes at the first time, because everything has to be compiled.

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
