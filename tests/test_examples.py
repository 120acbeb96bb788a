"""Every example runs, and its own assertion holds."""

import runpy
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").rglob("*.py"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example(path, tmp_path, capsys):
    main = runpy.run_path(str(path))["main"]
    main(tmp_path)
    assert capsys.readouterr().out
    assert (tmp_path / f"{path.stem}.png").stat().st_size > 5000
    assert 30 <= len(path.read_text().splitlines()) <= 65
