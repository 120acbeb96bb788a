"""The code of README, pages and docstrings runs, and prints what they say; names in them exist."""

import contextlib
import doctest
import importlib
import inspect
import io
import re
from pathlib import Path

import numpy as np
import pytest

import carom

ROOT = Path(__file__).parents[1]
FOLDERS = tuple(ROOT / "docs" / name for name in ("tutorial", "howto", "published"))
PAGES = ["README.md", "docs/index.md", "docs/start.md"]
PAGES += sorted(str(p.relative_to(ROOT)) for folder in FOLDERS for p in folder.glob("*.md"))
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def blocks(page: str) -> list[tuple[str, str]]:
    """Return (language, text) of all fenced blocks of a page."""
    return BLOCK.findall((ROOT / page).read_text(encoding="utf-8"))


def words(text: str) -> list[str]:
    """Return the words of an output; spaces, line breaks and brackets do not matter."""
    return re.sub(r"[\[\](),;<>]", " ", text).split()


def same(shown: str, printed: str) -> bool:
    """Whether two words are equal; numbers to 1e-6, or both round-off."""
    if shown == printed:
        return True
    try:
        a, b = float(shown), float(printed)
    except ValueError:
        return False
    return abs(a - b) <= 1e-6 * max(abs(a), abs(b)) or max(abs(a), abs(b)) < 1e-12


#: a heap is stepped with order 1, and the run says how deep bodies get into each other
HEAPS = pytest.mark.filterwarnings("ignore:Body:carom.AccuracyWarning")


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(p, marks=[HEAPS] if "heaps" in p else [])
        for p in PAGES
        if any(k == "python" for k, _ in blocks(p))
    ],
)
def test_code_of_a_page_prints_what_is_shown(page, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    space, printed = {"__name__": "__main__"}, ""  # a module that Numba finds
    for language, text in blocks(page):
        if language == "python":
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                exec(compile(text, page, "exec"), space)
            printed = output.getvalue()
        elif language == "text":
            shown, got = words(text), words(printed)
            assert len(shown) == len(got), f"shown:\n{text}\nprinted:\n{printed}"
            wrong = [pair for pair in zip(shown, got) if not same(*pair)]
            assert not wrong, f"(shown, printed): {wrong}"


NAME = re.compile(r"`((?:[A-Za-z_]\w*\.)*[A-Za-z_]\w*)(?:\([^`]*\))?`")
TEXTS = [
    p for p in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")] if "generated" not in p.parts
]


def member(value, name: str):
    """Return a part of a module or class; of an attribute that has no value yet, its annotation."""
    if hasattr(value, name):
        return getattr(value, name)
    notes = [vars(base).get("__annotations__", {}) for base in getattr(value, "__mro__", ())]
    for note in notes:
        if name in note:
            return note[name]
    return importlib.import_module(f"{value.__name__}.{name}")


def named(dotted: str):
    """Return what a name in the pages stands for: `carom...`, or `Class.member` of a public class."""
    first, *rest = dotted.split(".")
    value = carom if first == "carom" else getattr(carom, first)
    for name in rest:
        value = member(value, name)
    return value


def exists(dotted: str) -> bool:
    try:
        named(dotted)
    except (AttributeError, ModuleNotFoundError):
        return False
    return True


def test_a_name_that_is_not_there_is_found_out():
    assert exists("carom.impact.resolve.resolve")
    assert exists("Options.layer_width")
    assert exists("Solution.position")
    assert not exists("carom.impact.resolve.nothing")
    assert not exists("Options.nothing")


def missing_names(path: Path) -> list[str]:
    """Return the names in a page that do not exist.

    All that begin with `carom.` or a public class; after "In code:" also short ones, by the one before.
    """
    text = re.sub(r"^```.*?^```", "", path.read_text(encoding="utf-8"), flags=re.M | re.S)
    missing = []
    for paragraph in text.split("\n\n"):
        code, package = False, None
        for part in re.split(r"(In code:)", paragraph):
            code = code or part == "In code:"
            for name in NAME.findall(part):
                first = name.split(".")[0]
                if name.endswith(".py"):
                    continue
                if first == "carom" or (first in carom.__all__ and "." in name):
                    missing += [] if exists(name) else [name]
                    package = name if first == "carom" else package
                elif code and package and first not in carom.__all__:
                    levels = package.split(".")
                    tried = [".".join([*levels[:k], name]) for k in range(1, len(levels) + 1)]
                    asked = getattr(
                        inspect.unwrap(named(package)), "__code__", None
                    )  # or an argument of a function
                    tried = [] if asked and name in asked.co_varnames else tried
                    missing += (
                        [] if not tried or any(map(exists, tried)) else [f"{name} after {package}"]
                    )
    return missing


def test_names_in_a_page_exist():
    missing = {str(path.relative_to(ROOT)): missing_names(path) for path in TEXTS}
    assert not {page: names for page, names in missing.items() if names}


ASKED = re.compile(r">>> (?!.*\+SKIP)")
SHOWN = [
    "Scene", "Scene.add_body", "Scene.add_contact", "Scene.add_joint", "Scene.check", "simulate",
    "Solution", "results.ImpactTable", "results.JointImpulseTable", "resolve_impact", "impact_layer",
    "ensemble",
    "sensitivities", "solve_contacts", "euler", "axis_angle", "Scene.ignore_contact",
    "Scene.add_static", "Scene.add_surface", "Scene.replace", "Run", "contact_inverse_mass", "curves.Curve",
    "curves.Spline", "Restitution", "Restitution.fit", "Friction",
    "Friction.fit", "Look", "Part", "Profile", "surfaces.HeightField", "surfaces.Surface",
    "Modes", "flexible.beam",
]  # fmt: skip


@pytest.mark.parametrize("name", SHOWN)
def test_example_of_a_docstring(name):
    finder = doctest.DocTestFinder(recurse=False)
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    (test,) = finder.find(named(f"carom.{name}"), name, globs={"carom": carom, "np": np})
    assert test.examples
    output = io.StringIO()
    runner.run(test, out=output.write)
    assert runner.failures == 0, output.getvalue()


def test_all_examples_are_run():
    """An example that is added to a docstring of the reference is added to the list above."""
    pages = [page.read_text(encoding="utf-8") for page in (ROOT / "docs/api").glob("*.rst")]
    names = [name for page in pages for name in re.findall(r"^   carom\.([\w.]+)$", page, re.M)]
    assert len(names) > 100
    with_examples = set()
    for name in names:
        value = named(f"carom.{name}")
        methods = vars(value) if isinstance(value, type) else {}
        for label, part in {name: value, **{f"{name}.{k}": v for k, v in methods.items()}}.items():
            if (
                label[-1] != "_"
                and callable(part)
                and ASKED.search(getattr(part, "__doc__", None) or "")
            ):
                with_examples.add(label)
    assert with_examples <= set(SHOWN)


def test_every_status_is_explained():
    page = (ROOT / "docs/howto/failure.md").read_text(encoding="utf-8")
    assert not [
        s.name for s in carom.Status if s.name != "SUCCESS" and f"| `{s.name}` |" not in page
    ]
