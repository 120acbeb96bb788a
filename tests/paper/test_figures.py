"""Figures are made, in the one style, and leave matplotlib as it was."""

import matplotlib as mpl
import pytest

from carom.paper import book
from carom.visual.plots import style


@pytest.fixture(scope="module")
def figures():
    return book.figures()


def test_names_are_those_of_the_paper(figures):
    assert tuple(figures) == book.names()
    paper = {
        f"fig{n}" for n in ("2a", "2b", "3a", "3b", "4a", "4b", "4c", "4d", "5a", "5b", "6a", "6b")
    }
    assert set(figures) == paper


def test_two_files_and_no_state_left_behind(tmp_path):
    before = dict(mpl.rcParams)
    seen = []
    written = book.make(tmp_path / "new", ["fig3a"], seen.append)
    assert [path.name for path in written] == ["fig3a.pdf", "fig3a.png"]
    assert all(path.stat().st_size > 8000 for path in written)
    assert seen == ["fig3a"]
    assert dict(mpl.rcParams) == before


def test_the_same_run_writes_the_same_bytes(tmp_path):
    first, second = (book.make(tmp_path / name, ["fig4b"]) for name in "ab")
    for a, b in zip(first, second):
        assert a.read_bytes() == b.read_bytes()


def assert_units_on_axes(figure):
    assert figure.get_figwidth() in (style.COLUMN, style.PAGE)
    for axes in figure.axes:
        assert axes.lines
        if axes.get_subplotspec().is_last_row():
            assert "[" in axes.get_xlabel()
        assert "[" in axes.get_ylabel() or axes.get_subplotspec().colspan.start > 0


def test_the_whole_book(tmp_path, monkeypatch):
    """Every figure is drawn, with units on its axes; coarse ones, which are written in less time."""
    seen, drawn, save = [], {}, style.save

    def kept(figure, folder, name):
        drawn[name] = figure
        return save(figure, folder, name)

    monkeypatch.setattr(style, "save", kept)
    monkeypatch.setattr(style, "DPI", 50)
    monkeypatch.setitem(style.SETTINGS, "pdf.fonttype", 3)
    written = book.make(tmp_path, None, seen.append)
    assert len(seen) == book.parts()
    assert tuple(drawn) == book.names()
    for name, figure in book.figures().items():
        assert_units_on_axes(drawn[name])
        assert figure.caption
        assert figure.seen()
    names = {path.name for path in written}
    assert {"index.md", "table.md", "table.csv", "hht.csv"} <= names
    assert len(list(tmp_path.glob("*.pdf"))) == len(list(tmp_path.glob("*.png"))) == 12
    index = (tmp_path / "index.md").read_text()
    assert all(f"({name}.png)" in index for name in book.names())
    assert "{" not in index
    head, rule, *body = [x for x in (tmp_path / "table.md").read_text().splitlines() if "|" in x]
    columns = head.count("|")
    assert rule.count("---") == columns - 1
    assert sum(line.count("|") == columns for line in body) > 35
