"""Run all programs in interleaved rounds, each in a process of its own, and keep what they gave.

    python benchmarks/peers/run.py --environments DIR [--rounds 3] [--only drake exudyn]

DIR has a virtual environment for each program, made from its lock file:
`python -m venv DIR/drake; DIR/drake/bin/pip install -r benchmarks/peers/locks/drake.txt`.
carom runs in the interpreter of this script, Siconos in that of Debian (`apt-get install python3-siconos`).
With --only, rows of the other programs are kept as they are.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path
from statistics import median

HERE = Path(__file__).parent
RESULTS = HERE / "results.json"
PROGRAMS = (
    "carom", "siconos", "mujoco", "drake", "exudyn", "dart", "pybullet", "rapier", "newton",
)  # fmt: skip


def interpreter(program: str, environments: Path) -> str:
    """Return the interpreter that has a program."""
    if program == "carom":
        return sys.executable
    if program == "siconos":
        return "/usr/bin/python3"
    return str(environments / program / "bin" / "python")


def solved(program: str, python: str) -> tuple[str, list[dict]]:
    """Return the version of a program, and its rows."""
    done = subprocess.run(
        [python, str(HERE / f"by_{program}.py")], capture_output=True, text=True, check=True
    )
    lines = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    return lines[0]["version"], [{"program": program, **row} for row in lines[1:]]


def main() -> None:
    """Run, and write the file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--environments", type=Path, required=True)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--only", nargs="*", default=PROGRAMS)
    given = parser.parse_args()
    from carom.bench.measure import machine_line

    kept = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {"rows": []}
    rows = [row for row in kept["rows"] if row["program"] not in given.only]
    versions = kept.get("versions", {})
    found: dict[tuple, dict] = {}
    for count in range(given.rounds):
        for program in given.only:
            print(f"round {count + 1}: {program}", flush=True)
            versions[program], got = solved(program, interpreter(program, given.environments))
            for row in got:
                key = (row["program"], row["variant"], row["problem"], row.get("setting"))
                found.setdefault(key, {**row, "times": []})["times"].append(row.get("time"))
    for row in found.values():
        times = [t for t in row.pop("times") if t is not None]
        if times:
            row |= {"time": float(f"{median(times):.3g}"), "error": float(f"{row['error']:.3g}")}
        rows.append(row)
    rows.sort(key=lambda row: PROGRAMS.index(row["program"]))
    kept = {
        "machine": machine_line().rstrip(), "rounds": given.rounds, "versions": versions, "rows": rows,
    }  # fmt: skip
    text = json.dumps(kept, indent=0).replace("\n", " ").replace('{ "program"', '\n{"program"')
    RESULTS.write_text(text + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
