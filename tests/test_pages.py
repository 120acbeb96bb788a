"""Links of the pages lead somewhere, and a number that stands in a sentence is that of its table."""

import re
import runpy
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
TABLE = re.compile(r"^<!-- table: (\w+) -->\n(.*?)^<!-- end -->", re.MULTILINE | re.DOTALL)
MEASURED = re.compile(r"processor time|\b(ms|us|ns|MiB)\b")  # in the head of a table
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


def lost_links(page: Path) -> list[str]:
    """Return the links of a page that lead nowhere."""
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
    return lost


def test_links_lead_somewhere():
    lost = {str(page.relative_to(ROOT)): lost_links(page) for page in PAGES}
    assert not {page: links for page, links in lost.items() if links}


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


@cache
def tables() -> dict[str, list[str]]:
    """Return the tables that scripts fill in, all of them with this name on all pages."""
    found: dict[str, list[str]] = {}
    for page in PAGES:
        for name, inside in TABLE.findall(page.read_text(encoding="utf-8")):
            found.setdefault(name, []).append(inside)
    return found


def column(table: str, name: str, row: tuple[str, ...] = ()) -> list[float]:
    """Return the first numbers of the cells of a column; `row` are the first cells of its rows."""
    (inside,) = tables()[table]
    head, _, *rows = [
        [part.strip() for part in line.strip().strip("|").split("|")]
        for line in inside.splitlines()
        if line.startswith("|")
    ]
    found = [r[head.index(name)] for r in rows if tuple(r[: len(row)]) == row]
    return [float(one.split()[0].replace(",", "")) for one in found]


def only(values: list[float]) -> float:
    (value,) = values
    return value


STACK = ("contacts", "a stack", "180")
THEIRS = ("contacts", "a stack, MuJoCo", "180")
THROWS, PLAIN = "throws a second of wall time", "a call, plain / us"
CUBE = ("cube_tosses", "position, mean / %", ())
#: page, sentence with the number, table, column, first cells of the row, and which of several rows
NUMBERS = [
    ("comparison", r"takes (\S+) s to pour 500", "heaps_rest", "processor time / s", ("500",), only),
    ("comparison", r"(\S+) microseconds a step by MuJoCo", "scaling", "cost", THEIRS, only),
    ("comparison", r"by MuJoCo, (\S+) by carom", "scaling", "cost", STACK, only),
    ("comparison", r"carom made (\S+) throws", "ensembles", THROWS, ("carom", "1 ms", "1"), only),
    ("comparison", r"beside (\S+) of MuJoCo", "ensembles", THROWS, ("MuJoCo", "1 ms", "1"), only),
    ("comparison", r"and (\S+) with steps of 5 ms", "ensembles", THROWS, ("carom", "5 ms", "1"), only),
    ("comparison", r"`rtol=1e-8` it made (\d+)", "ensembles", THROWS, ("carom", "rtol 1e-08", "1"), only),
    ("comparison", r"first run: (\S+) s of processor", "startup", "cold, once [s]", ("free body",), only),
    ("comparison", r"\| carom \| pip \| (\d+) \|", "installed", "size / MiB", ("carom",), only),
    ("comparison", r"\| MuJoCo \| pip \| (\d+) \|", "installed", "size / MiB", ("MuJoCo",), only),
    ("comparison", r"\| carom \| pip \| \d+ \| (\S+) \|", "startup", "import carom [s]", ("free body",), only),
    ("comparison", r"average error of (\S+) to", *CUBE, min),
    ("comparison", r"average error of \S+ to (\S+) %", *CUBE, max),
    ("limits", r"throws some (\S+) dice", "ensembles", THROWS, ("carom", "rtol 1e-08", "1"), only),
    ("start", r"in all (\d+) MiB", "installed", "size / MiB", ("carom",), only),
    ("start", r"everything (\d+) MiB", "installed", "size / MiB", ("carom[all]",), only),
    ("howto/own_constraint", r"takes (\d+) times as long", "user_functions", "ratio", ("Rows",), only),
    ("howto/mechanisms", r"(\S+) microseconds a call", "user_functions", PLAIN, ("UserForce",), only),
]  # fmt: skip


def test_numbers_of_sentences_are_those_of_the_tables():
    """To 5 %: a sentence may round."""
    wrong = []
    for page, sentence, table, name, row, of in NUMBERS:
        text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
        said = [float(one.replace(",", "")) for one in re.findall(sentence, text)]
        there = of(column(table, name, row))
        if len(said) != 1 or said[0] != pytest.approx(there, rel=0.05):
            wrong.append((page, sentence, said, there))
    assert not wrong


def test_a_number_has_one_place_and_a_script():
    """Tables that a script fills stand once; other tables have no times or sizes of carom."""
    scripts = runpy.run_path(str(ROOT / "benchmarks" / "all.py"))["SCRIPTS"]
    texts = [(ROOT / "benchmarks" / f"{name}.py").read_text(encoding="utf-8") for name in scripts]
    reported = [name for text in texts for name in re.findall(r'\breport\(\s*"(\w+)"', text)]
    assert len(reported) == len(set(reported))
    assert not {name for name, found in tables().items() if len(found) > 1}
    assert set(tables()) <= set(reported)
    by_hand = []
    for page in [ROOT / "docs" / "benchmarks.md", *(ROOT / "docs" / "howto").glob("*.md")]:
        rest = TABLE.sub("", page.read_text(encoding="utf-8"))
        heads = re.findall(r"^(\|.*\|)\n\|[ :|-]*\|$", rest, re.MULTILINE)
        by_hand += [(page.name, head) for head in heads if MEASURED.search(head)]
    assert not by_hand


def test_the_mark_is_that_of_its_script_and_its_ball_obeys_the_law():
    spec = spec_from_file_location("logo", ROOT / "docs" / "pictures" / "logo.py")
    logo = module_from_spec(spec)
    spec.loader.exec_module(logo)
    assert logo.OUT.read_text(encoding="utf-8") == logo.svg()
    (x0, y0), (x, y), (x1, y1) = logo.path()
    before, after = (x0 - x) / (y - y0), (x1 - x) / (y1 - y)  # speed across by speed along
    assert after / before == pytest.approx(logo.RESTITUTION)
    assert logo.MIDDLE - x + logo.RADIUS == logo.OUTER - logo.WIDTH / 2  # it touches the letter
