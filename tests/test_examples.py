"""Every example runs, and its own assertion holds."""

import runpy
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").rglob("*.py"))


#: what strikes in steps that are taken whole is of order 1, and the run says so
HEAPS = pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")


#: less of what takes long
LESS = {"heap": {"count": 30}, "arch": {"halvings": 4}}


@pytest.mark.parametrize(
    "path",
    [pytest.param(p, marks=[HEAPS] if p.stem == "heap" else [], id=p.stem) for p in EXAMPLES],
)
def test_example(path, tmp_path, capsys):
    main = runpy.run_path(str(path))["main"]
    main(tmp_path, **LESS.get(path.stem, {}))
    assert capsys.readouterr().out
    assert (tmp_path / f"{path.stem}.png").stat().st_size > 5000
    lines = path.read_text().splitlines()
    code = [line for line in lines if line.strip() and not line.startswith("# ")]
    assert 25 <= len(code) <= 65  # text between blocks comes on top
