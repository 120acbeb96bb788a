"""Measure everything, one script after the other; with --docs, put tables and figures into the documentation.

    python benchmarks/all.py                     tables and figures under out/benchmarks
    python benchmarks/all.py --docs              the same, then into docs/benchmarks.md and docs/_static
    python benchmarks/all.py --docs --keep       into the documentation what was measured before
    python benchmarks/all.py --few               fewer and smaller cases: to try the scripts out
    python benchmarks/all.py chain heaps         these alone

Each script runs in a process of its own. A table belongs between <!-- table: NAME --> and <!-- end --> on one
page: each number has one place, and `tests/test_pages.py` compares sentences with it.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parent
SCRIPTS = (
    "free_step", "impact", "corner", "coulomb", "location", "convergence", "accuracy", "work_precision",
    "chain", "loops", "methods", "heaps", "many", "many_bodies", "pairs", "ensembles", "scaling", "allocation",
    "startup", "short_calls", "user_functions", "cube_tosses", "real_impacts", "simbenchmark", "cenic",
    "comparison", "installed",
)  # fmt: skip
PICTURES = (
    "work_precision",
    "accuracy",
    "scaling",
    "convergence",
    "location",
    "simbenchmark",
    "cenic",
    "peers_asked",
    "peers_time",
)


def into_docs(out: Path) -> list[str]:
    """Put what was measured into the documentation; return what was put."""
    put = []

    def fill(found: re.Match) -> str:
        table = out / f"{found[1]}.md"
        if not table.exists():
            return found[0]
        put.append(found[1])
        inside = table.read_text(encoding="utf-8").split("\n", 2)[2].strip()  # without its title
        return f"<!-- table: {found[1]} -->\n{inside}\n<!-- end -->"

    for page in (ROOT / "docs").rglob("*.md"):
        text = page.read_text(encoding="utf-8")
        filled = re.sub(r"<!-- table: (\w+) -->\n.*?<!-- end -->", fill, text, flags=re.DOTALL)
        if filled != text:
            page.write_text(filled, encoding="utf-8")
    for name in PICTURES:
        if (out / f"{name}.png").exists():
            shutil.copy(out / f"{name}.png", ROOT / "docs" / "_static" / f"{name}.png")
            put.append(f"{name}.png")
    return put


def main() -> int:
    """Run the scripts; return 1 if one failed."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scripts", nargs="*", metavar="SCRIPT", help=", ".join(SCRIPTS))
    parser.add_argument("--docs", action="store_true")
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--few", action="store_true")
    given = parser.parse_args()
    unknown = set(given.scripts) - set(SCRIPTS)
    if unknown:
        parser.error(f"SCRIPT must be of {', '.join(SCRIPTS)}, got {min(unknown)!r}")
    if given.few and given.docs:
        parser.error("--few is to try the scripts out, its numbers are not for the documentation")
    out = ROOT / "out" / ("benchmarks_few" if given.few else "benchmarks")
    environment = {
        **os.environ, "CAROM_BENCH_OUT": str(out), "CAROM_BENCH_FEW": "1" if given.few else "",
    }  # fmt: skip
    failed = []
    for name in () if given.keep else given.scripts or SCRIPTS:
        begin = time.perf_counter()
        done = subprocess.run(
            [sys.executable, str(HERE / f"{name}.py")], env=environment, check=False
        )
        print(f"== {name}: {time.perf_counter() - begin:.0f} s, code {done.returncode}", flush=True)
        if done.returncode:
            failed.append(name)
    if given.docs:
        print(f"put into docs: {', '.join(into_docs(out))}")
    print(f"failed: {', '.join(failed)}" if failed else "all done")
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main())
