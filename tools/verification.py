"""Write the page of what is verified from the rows that tests have recorded.

    make verify                        # runs the marked tests, and writes the rows and the page
    python tools/verification.py       # writes the page anew

A row is a feature, the equation of its right value, where that comes from, the error that a test reached, and
what the test asked (`tests/verified.py`). What needs a row is taken from the pages of the reference, the
arguments of functions that state scenes, and the registries of words.
"""

from __future__ import annotations

import inspect
import json
import re
import sys
from inspect import getattr_static
from pathlib import Path

ROOT = Path(__file__).parents[1]
ROWS = ROOT / "docs" / "_static" / "verification.json"
PAGE = ROOT / "docs" / "verification.md"
API = ROOT / "docs" / "api"
sys.path.insert(0, str(ROOT / "docs"))

#: pages of the reference of which nothing needs a row
NO_ROWS_OF = {
    "pictures": "pictures and views, whose numbers are those of a solution",
    "results": "tables and views that a run hands back, which all other rows read",
}
#: names that need no row
NO_ROW = {
    "Scene": "its parts and methods have rows of their own",
    "GROUND": "a name of the ground",
    "Look": "a picture",
    "Part": "a part of a `Compound`",
    "Options": "settings of accuracy; [true errors](howto/accuracy.md) are measured",
    "add_body": "adds a shape, which has a row", "add_joint": "adds a joint, which has a row",
    "add_force": "adds a force, which has a row", "add_constraint": "adds a relation, which has a row",
    "add_contact": "its laws have rows", "add_surface": "adds ground, which has a row",
    "contact_sequence": "words, which `sensitivities` has",
    "studies.identify.Recording": "data", "studies.identify.State": "data",
    "studies.identify.Parameter": "data",
}  # fmt: skip
#: arguments that name, place, draw or measure a part, bound or time it, or say how a run is computed and saved;
#: numbers of the laws of contacts, whose laws have rows, and words, of which each has one
PLAIN = {
    "self", "name", "replace", "definition", "shape", "mass", "density", "inertia", "position", "orientation",
    "velocity", "angular_velocity", "material", "color", "look", "point", "normal", "parent", "child",
    "parent_frame", "child_frame", "joint", "over", "part", "body", "other", "scene", "duration", "save_every",
    "progress", "options", "throw", "save", "save_seconds", "restitution", "friction", "method", "impact_law",
    "impact_location", "multiple", "length", "lower", "upper", "at", "off", "atol",
}  # fmt: skip
#: titles of the parts of the page, in its order, by the pages of the reference
TITLES = {
    "joints": "Joints and relations", "forces": "Forces", "scene": "Scenes and laws of contacts",
    "shapes": "Shapes and ground", "flexible": "Flexible bodies", "impacts": "Impacts", "simulate": "Runs",
    "coordinates": "Your own coordinates",
    "derivatives": "Derivatives", "identify": "Fits to recorded motion", "ensembles": "Many runs",
    "models": "Models", "geometry": "Geometry", "baselines": "Baselines",
}  # fmt: skip


def features() -> dict[str, list[str]]:
    """Return the names of all that needs a row, by the pages of the reference."""
    import api_pages

    import carom
    from carom.dynamics.methods import METHODS
    from carom.scene.materials import IMPACT_LAWS, MULTIPLE

    found: dict[str, list[str]] = {}
    for page in sorted(API.glob("*.rst")):
        names = re.findall(r"^   carom\.([\w.]+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
        for name in names if page.stem not in NO_ROWS_OF else ():
            one = api_pages.find(f"carom.{name}")
            others = [f"{name}.{other}" for other in constructors(one)]
            itself = not (inspect.isclass(one) and api_pages.handed_back(one))
            found.setdefault(page.stem, []).extend([name] * itself + others)
    scene = [getattr(carom.Scene, name) for name in vars_of(carom.Scene) if name.startswith("add_")]
    for method in (*scene, carom.Scene.switch):
        found["scene"] += [method.__name__, *arguments(method)]
    found["scene"] += [f'impact_law="{word}"' for word in IMPACT_LAWS]
    found["scene"] += [f'multiple="{word}"' for word in MULTIPLE]
    found["simulate"] += arguments(carom.simulate)
    found["simulate"] += [f'method="{word}"' for word in METHODS]
    located = inspect.getdoc(carom.simulate).partition("impact_location : {")[2].partition("}")[0]
    found["simulate"] += [f"impact_location={word}" for word in located.split(", ")]
    return {page: [name for name in names if name not in NO_ROW] for page, names in found.items()}


def vars_of(cls: type) -> list[str]:
    """Return the public names of a class and its bases."""
    return [name for name in dir(cls) if not name.startswith("_")]


def constructors(one) -> list[str]:
    """Return the other ways to make an object of a class, but for `load`, which tests of files compare."""
    if not inspect.isclass(one):
        return []
    kinds = classmethod, staticmethod
    return [n for n in vars_of(one) if n != "load" and isinstance(getattr_static(one, n), kinds)]


def arguments(function) -> list[str]:
    """Return the arguments of a function that need a row, as ``add_joint(breaks_at=)``."""
    names = inspect.signature(function).parameters
    return [f"{function.__name__}({name}=)" for name in names if name not in PLAIN]


def kept() -> list[dict]:
    """Return the rows of the file."""
    return json.loads(ROWS.read_text(encoding="utf-8")) if ROWS.exists() else []


def is_stated(row: dict) -> bool:
    """Whether the test of a row is still there, in a file that states the equation of the row."""
    path, _, name = row["test"].partition("::")
    text = (ROOT / path).read_text(encoding="utf-8") if (ROOT / path).exists() else ""
    return f"def {name}(" in text and row["equation"] in text


def update(path: Path, new: list[dict]) -> None:
    """Write rows into a file, in which tests that did not run keep theirs, and make the page."""
    from carom.bench.measure import machine

    facts = machine()
    versions = ", ".join(f"{name} {version}" for name, version in facts["versions"].items())
    where = f"{facts['processor']}; {facts['system']}; {versions}"
    old = json.loads(path.read_text(encoding="utf-8")) if path.exists() else []
    ran = {row["test"] for row in new}
    rows = {key(row): row for row in old if row["test"] not in ran and is_stated(row)}
    for row in new:
        row |= {"date": facts["date"], "machine": where}
        other = rows.get(key(row))
        if other is not None:  # another case of the same test
            worse = max(row, other, key=share)
            row = worse | {n: row[n] + other[n] for n in ("cases", "comparisons")}
        rows[key(row)] = row
    text = json.dumps(sorted(rows.values(), key=key), indent=1, ensure_ascii=False)
    path.write_text(text + "\n", encoding="utf-8")
    PAGE.write_text(page(), encoding="utf-8")


def key(row: dict) -> tuple[str, str, str]:
    """Return what distinguishes rows."""
    return row["feature"], row["test"], row["equation"]


def share(row: dict) -> float:
    """Return the error of a row as a part of what was asked."""
    return row["reached"] / row["asked"] if row["asked"] else 0.0


def validated(row: dict) -> bool:
    """Whether a row compares with an experiment."""
    return row["source"].startswith("experiment")


def missing() -> dict[str, list[str]]:
    """Return the features without a row, by pages."""
    known = {row["feature"] for row in kept() if not validated(row)}
    found = {page: [n for n in names if n not in known] for page, names in features().items()}
    return {page: names for page, names in found.items() if names}


HEAD = """\
---
html_theme.sidebar_secondary.remove: true
---

# Verification

What the tests verify: for each feature its right value, where this value comes from, the error that a test
reached, and what the test asked. A test writes its row itself, from the comparisons that it makes
(`tests/verified.py`), so a row says nothing that was not checked. `make verify` runs these tests and makes this
page anew; the same rows are [a file](_static/verification.json).

*Verified* means that the equations of the model are solved correctly. Whether the model is that of the world is
another question: [validated](#validated) has the comparisons with measurements.

A test makes many comparisons, and may have many cases: its row has the error that was nearest to what was
asked. Errors are absolute, in SI units, or relative to the right value (*rel.*). An error of 0 where 0 was
asked means equal numbers. Right values come from a *closed form*; an *own integration*, a computation of ours
that is no part of carom, such as SciPy's integrators or a quadrature; an *other program*; a *publication*; or
an *invariant*: what a motion must keep, or two descriptions of one thing.
"""
VALIDATED = """\
## Validated

Compared with measurements. The errors are those of the model, of its fitted numbers and of the measurement.
[Tosses of a real cube](development/cube_toss.md) has more.
"""
WITHOUT = """\
## Without a row

A row is asked of each public class and function that states or computes mechanics, of the arguments of
functions that state scenes and of `simulate`, and of each word of `method`, `impact_law`, `multiple` and
`impact_location`. None is asked of:
"""


def page() -> str:
    """Return the text of the page."""
    rows, named = kept(), features()
    verified = {}
    for row in rows:
        if not validated(row):
            verified.setdefault(row["feature"], []).append(row)
    machines = dict.fromkeys(row["machine"] for row in rows)
    tests = len({row["test"] for row in rows})
    latest = max((row["date"] for row in rows), default="")
    parts = [
        HEAD,
        f"{len(verified)} features, {tests} tests, run on {latest} where a row has no other date. "
        f"Machine: {'. '.join(machines)}.\n",
    ]
    untitled = {name for name, those in named.items() if those} - TITLES.keys()
    assert not untitled, f"pages of the reference without a title: {untitled}"
    for name, title in TITLES.items():
        here = [row for feature in named.get(name, ()) for row in verified.get(feature, ())]
        if here:
            parts.append(f"## {title}\n\n{table(here, latest)}")
    measured = [row for row in rows if validated(row)]
    parts += [VALIDATED, table(measured, latest)] if measured else []
    of_pages = [f"- what is on [{name}](api/{name}.rst): {why}" for name, why in NO_ROWS_OF.items()]
    parts.append(
        WITHOUT + "\n" + "\n".join([*of_pages, *(f"- `{n}`: {why}" for n, why in NO_ROW.items())])
    )
    left = ", ".join(f"`{name}`" for names in missing().values() for name in names)
    parts.append(f"Still without a row: {left}.\n" if left else "")
    return "\n".join(parts).rstrip() + "\n"


def words(test: str) -> str:
    """Return the name of a test in words: ``mechanisms/belt: tensions and bearings``."""
    file, _, name = test.removeprefix("tests/").partition("::")
    return f"{file.replace('test_', '').removesuffix('.py')}: {name.removeprefix('test_').replace('_', ' ')}"


def table(rows: list[dict], latest: str) -> str:
    """Return rows as a table, with the date of those that are older than the latest."""
    lines = [
        "| feature | right value | source | reached | asked | test |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    above = ""
    for row in rows:
        name = "" if row["feature"] == above else f"`{row['feature']}`"
        above, rel = row["feature"], " rel." if row["relative"] else ""
        cases = f", {row['cases']} cases" if row["cases"] > 1 else ""
        digits = ".2g" if validated(row) else ".0e"
        cells = (
            name, row["equation"], row["source"], f"{row['reached']:{digits}}{rel}", f"{row['asked']:{digits}}",
            f"{words(row['test'])}{cases}{'' if row['date'] == latest else ', ' + row['date']}",
        )  # fmt: skip
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(missing() or "each feature has a row")
