"""Links of the pages lead somewhere, and a number that stands in a sentence is that of its table."""

import re
from functools import cache
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
MADE = {"gallery", "generated"}  # folders of pages that are made with the documentation
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", ROOT / "CHANGELOG.md"]
PAGES += [p for p in (ROOT / "docs").rglob("*.md") if not MADE & set(p.parts)]
DEVELOPMENT = ROOT / "docs" / "development"
FENCED = re.compile(r"^(```|~~~).*?^\1", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\(([^)\s]+)\)")


@cache
def anchors(page: Path) -> set[str]:
    """Anchors of the headings and labels of a page, as GitHub and myst form them."""
    text = FENCED.sub("", page.read_text(encoding="utf-8"))
    found = set(re.findall(r"^\(([\w-]+)\)=$", text, re.MULTILINE))
    for title in re.findall(r"^#+ (.*)$", text, re.MULTILINE):
        words = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", title).lower()
        found.add(re.sub(r"[^\w\- ]", "", words).strip().replace(" ", "-"))
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda p: str(p.relative_to(ROOT)))
def test_links_lead_somewhere(page):
    lost = []
    for link in LINK.findall(FENCED.sub("", page.read_text(encoding="utf-8"))):
        if re.match(r"[a-z]+:", link):
            continue  # of the web
        path, _, anchor = link.partition("#")
        other = (page.parent / path).resolve() if path else page
        if MADE & set(other.parts) or "api" in other.parts or other.suffix == ".html":
            continue
        if not other.exists() or (
            anchor and other.suffix == ".md" and anchor not in anchors(other)
        ):
            lost.append(link)
    assert not lost


def test_decisions_are_short_and_dated():
    text = (DEVELOPMENT / "decisions.md").read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 300
    entries = re.findall(r"^- .*$", text, re.MULTILINE)
    assert entries
    assert not [e for e in entries if not re.search(r"\(20\d\d-\d\d-\d\d.*, \[.*\]\(.*\)\)$", e)]


def test_open_ends_are_an_item_a_line():
    lines = (DEVELOPMENT / "open.md").read_text(encoding="utf-8").splitlines()
    items = [line for line in lines if line and not line.startswith("#")][1:]
    assert not [item for item in items if not item.startswith("- **") or len(item) > 200]


def cell(table: str, row: tuple[str, ...], column: str) -> float:
    """The first number of a cell of a table of the benchmarks; `row` are the first cells of its row."""
    text = (ROOT / "docs" / "benchmarks.md").read_text(encoding="utf-8")
    inside = text.split(f"<!-- table: {table} -->")[1].split("<!-- end -->")[0]
    rows = [
        [part.strip() for part in line.strip("|").split("|")]
        for line in inside.splitlines()
        if line.startswith("|")
    ]
    (found,) = [r for r in rows if tuple(r[: len(row)]) == row]
    return float(found[rows[0].index(column)].split()[0])


STACK = ("contacts", "a stack", "180")
THEIRS = ("contacts", "a stack, MuJoCo", "180")
SECOND = "throws a second of wall time"
#: page, sentence with the number, table, row, column
NUMBERS = [
    ("comparison", r"takes (\S+) s to pour 500", "heaps_rest", ("500",), "processor time / s"),
    ("comparison", r"(\S+) microseconds a step by MuJoCo", "scaling", THEIRS, "cost"),
    ("comparison", r"by MuJoCo, (\S+) by carom", "scaling", STACK, "cost"),
    ("comparison", r"carom made (\S+) throws", "ensembles", ("carom", "1 ms", "1"), SECOND),
    ("comparison", r"beside (\S+) of MuJoCo", "ensembles", ("MuJoCo", "1 ms", "1"), SECOND),
    ("comparison", r"and (\S+) with steps of 5 ms", "ensembles", ("carom", "5 ms", "1"), SECOND),
    ("comparison", r"`rtol=1e-8` it made (\d+)", "ensembles", ("carom", "rtol 1e-08", "1"), SECOND),
    ("comparison", r"first run: (\S+) s of processor", "startup", ("free body",), "cold, once [s]"),
    ("limits", r"throws some (\S+) dice", "ensembles", ("carom", "rtol 1e-08", "1"), SECOND),
]  # fmt: skip


@pytest.mark.parametrize("number", NUMBERS, ids=lambda n: n[1])
def test_numbers_of_sentences_are_those_of_the_tables(number):
    """To 5 %: a sentence may round."""
    page, sentence, *place = number
    text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
    (said,) = re.findall(sentence, text)
    assert float(said) == pytest.approx(cell(*place), rel=0.05)


def test_the_mark_is_that_of_its_script_and_its_ball_obeys_the_law():
    spec = spec_from_file_location("logo", ROOT / "docs" / "pictures" / "logo.py")
    logo = module_from_spec(spec)
    spec.loader.exec_module(logo)
    assert logo.OUT.read_text(encoding="utf-8") == logo.svg()
    (x0, y0), (x, y), (x1, y1) = logo.path()
    before, after = (x0 - x) / (y - y0), (x1 - x) / (y1 - y)  # speed across by speed along
    assert after / before == pytest.approx(logo.RESTITUTION)
    assert logo.MIDDLE - x + logo.RADIUS == logo.OUTER - logo.WIDTH / 2  # it touches the letter
