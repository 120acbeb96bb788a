"""Every example runs, and its own assertion holds. Pictures are coarse, and films have two frames a second."""

import runpy
from pathlib import Path

import pytest

import carom
from carom.visual.plots import style

EXAMPLES = sorted((Path(__file__).parents[1] / "examples").rglob("*.py"))


#: what strikes in steps that are taken whole is of order 1, and the run says so
HEAPS = pytest.mark.filterwarnings("ignore::carom.AccuracyWarning")


#: less of what takes long
LESS = {"heap": {"count": 20}, "arch": {"halvings": 4}}


@pytest.mark.parametrize(
    "path",
    [pytest.param(p, marks=[HEAPS] if p.stem == "heap" else [], id=p.stem) for p in EXAMPLES],
)
def test_example(path, tmp_path, capsys, monkeypatch):
    def short(solution, path, *, fps, speed=1.0, **more):
        return film(solution, path, fps=2, speed=speed, **more)

    film = carom.film
    monkeypatch.setattr(carom, "film", short)
    monkeypatch.setattr(style, "DPI", 50)
    main = runpy.run_path(str(path))["main"]
    main(tmp_path, **LESS.get(path.stem, {}))
    assert capsys.readouterr().out
    assert (tmp_path / f"{path.stem}.png").stat().st_size > 2000
    lines = path.read_text().splitlines()
    code = [line for line in lines if line.strip() and not line.startswith("# ")]
    assert 25 <= len(code) <= 65  # text between blocks comes on top
