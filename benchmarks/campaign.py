"""Run thousands of random scenes, look for what is wrong with their results, and tell it in a table.

    python benchmarks/campaign.py throws 1000             1000 throws
    python benchmarks/campaign.py throws 1000 --first 5000  others
    python benchmarks/campaign.py all 300 --workers 2     300 of each family
    python benchmarks/campaign.py throws 1 --first 77     one again
    python benchmarks/campaign.py --report out/campaign   tables of what was run before

A run that takes longer than `--limit` seconds is ended from outside, and counted. Each case is a line of
JSON in ``out/campaign/FAMILY.jsonl``: run again, it is replaced.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import sys
import time
from collections import Counter, defaultdict
from pathlib import Path

import numpy as np

from campaigns import FAMILIES
from campaigns.case import as_row, run, wrong

#: processor time that a run may take [s]
LIMIT = 20.0


def work(tasks, results, tolerances: bool) -> None:
    """Run cases until there are none: in a process of its own, which may be ended at any time."""
    for family, seed in iter(tasks.get, None):
        try:
            case = FAMILIES[family](seed)
            results.put(as_row(family, seed, case, run(case, tolerances)))
        except Exception as error:
            results.put(
                {"family": family, "seed": seed, "error": f"{type(error).__name__}: {error}"}
            )


class Worker:
    """A process that runs one case at a time."""

    def __init__(self, context, tolerances: bool):
        self.context, self.tolerances = context, tolerances
        self.begin()

    def begin(self) -> None:
        """Start the process."""
        self.tasks, self.results = self.context.SimpleQueue(), self.context.SimpleQueue()
        self.process = self.context.Process(
            target=work, args=(self.tasks, self.results, self.tolerances), daemon=True
        )
        self.process.start()
        self.at, self.since = None, 0.0

    def give(self, family: str, seed: int) -> None:
        """Hand on the next case."""
        self.at, self.since = (family, seed), time.monotonic()
        self.tasks.put(self.at)

    def end(self) -> None:
        """End the process, whatever it does."""
        self.process.kill()
        self.process.join()


def campaign(jobs: list[tuple[str, int]], workers: int, limit: float, tolerances: bool = False):
    """Yield a row for each job, in the order in which they end."""
    context = multiprocessing.get_context("spawn")
    waiting, pool = list(reversed(jobs)), [Worker(context, tolerances) for _ in range(workers)]
    while waiting or any(worker.at for worker in pool):
        for worker in pool:
            if worker.at is None:
                if waiting:
                    worker.give(*waiting.pop())
            elif not worker.results.empty():
                yield worker.results.get()
                worker.at = None
            elif time.monotonic() - worker.since > limit or not worker.process.is_alive():
                died = "took too long" if worker.process.is_alive() else "the process died"
                family, seed = worker.at
                yield {"family": family, "seed": seed, "error": died}
                worker.end()
                worker.begin()
        time.sleep(0.002)
    for worker in pool:
        worker.end()


def faults(row: dict) -> list[str]:
    """Return what is wrong with a case."""
    if "error" in row:
        return [row["error"].split(":")[0]]
    return wrong(row) + (["slow"] if not row["seconds"] <= LIMIT else [])


def table(rows: list[dict], by: str) -> str:
    """Return a Markdown table: how many of each kind, and what is wrong with how many."""
    groups = defaultdict(list)
    for row in rows:
        groups[str(row.get(by, "?"))].append(row)
    groups["all"] = rows
    columns = (
        by, "runs", "wrong", "residual > 1e-6", "> 1e-4", "greatest", "depth", "median s", "greatest s", "what",
    )  # fmt: skip
    lines = [f"| {' | '.join(columns)} |", "|" + " --- |" * len(columns)]
    for name, group in sorted(groups.items()):
        ran = [row for row in group if "error" not in row]
        what = Counter(fault for row in group for fault in faults(row))
        residual = np.array([row["residual"] for row in ran] or [0.0])
        seconds = np.array([row["seconds"] for row in ran] or [0.0])
        lines.append(
            f"| {name} | {len(group)} | {sum(bool(faults(row)) for row in group)} | "
            f"{np.mean(residual > 1e-6):.2%} | {np.mean(residual > 1e-4):.2%} | {np.max(residual):.0e} | "
            f"{max((row['depth'] for row in ran), default=0.0):.0e} | {np.median(seconds):.3f} | "
            f"{np.max(seconds):.1f} | {', '.join(f'{k} {n}' for k, n in what.most_common())} |"
        )
    return "\n".join(lines)


def report(rows: list[dict], most: int = 12) -> None:
    """Print tables of a family, and the seeds of the worst."""
    for by in ("kind", "step", "impact_law"):
        print(f"\n{table(rows, by)}")
    bad = [row for row in rows if faults(row)]
    bad.sort(key=lambda row: -row.get("residual", np.inf))
    for row in bad[:most]:
        print(json.dumps(row))


def main() -> int:
    """Run, or report; return 1 if anything is wrong."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("family", nargs="?", choices=[*FAMILIES, "all"])
    parser.add_argument("count", nargs="?", type=int, default=100)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--seeds", help="these seeds alone, with commas")
    parser.add_argument("--workers", type=int, default=1)
    parser.add_argument(
        "--limit", type=float, default=3 * LIMIT, help="seconds that a run may take"
    )
    parser.add_argument("--out", type=Path, default=Path("out") / "campaign")
    parser.add_argument(
        "--tolerances",
        action="store_true",
        help="steps by the default tolerances, not those of the cases",
    )
    parser.add_argument("--report", action="store_true", help="tables of what was run before")
    given = parser.parse_args()
    seeds = range(given.first, given.first + given.count)
    if given.seeds:
        seeds = [int(seed) for seed in given.seeds.split(",")]
    families = list(FAMILIES) if given.family in (None, "all") else [given.family]
    given.out.mkdir(parents=True, exist_ok=True)
    bad = 0
    for family in families:
        path, known = given.out / f"{family}.jsonl", {}
        if path.exists():
            known = {row["seed"]: row for row in map(json.loads, path.open(encoding="utf-8"))}
        if not given.report:
            jobs = [(family, s) for s in seeds]
            with path.open("a", encoding="utf-8") as file:
                for row in campaign(jobs, given.workers, given.limit, given.tolerances):
                    known[row["seed"]] = row
                    file.write(json.dumps(row) + "\n")
                    file.flush()
        rows = [row for s, row in sorted(known.items()) if given.report or s in set(seeds)]
        if rows:
            print(f"\n## {family}")
            report(rows)
            bad += sum(bool(faults(row)) for row in rows)
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
