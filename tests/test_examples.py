"""Every example runs, and its own assertion holds."""

import runpy
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").rglob("*.py"))


#: what strikes in steps that are taken whole is of order 1, and the run says so
HEAPS = pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")


@pytest.mark.parametrize(
    "path",
    [
        pytest.param(p, marks=[HEAPS] if p.stem in ("heap", "arch") else [], id=p.stem)
        for p in EXAMPLES
    ],
)
def test_example(path, tmp_path, capsys):
    main = runpy.run_path(str(path))["main"]
    main(tmp_path)
    assert capsys.readouterr().out
    assert (tmp_path / f"{path.stem}.png").stat().st_size > 5000
    assert 30 <= len(path.read_text().splitlines()) <= 65
