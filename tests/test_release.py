"""The wheel has the whole package, its data and licences, and nothing else; one version everywhere."""

import re
import runpy
import tomllib
from pathlib import Path

from hatchling.builders.wheel import WheelBuilder

import carom

ROOT = Path(__file__).parents[1]
RELEASE = runpy.run_path(str(ROOT / "tools" / "check_release.py"))


def test_files_of_the_wheel():
    """What `make release-check` finds out by building, asked of the builder alone."""
    names = {file.distribution_path for file in WheelBuilder(str(ROOT)).recurse_included_files()}
    package = RELEASE["sources"]()
    assert names == package
    assert "carom/py.typed" in names
    assert any(name.startswith("carom/paper/data/LICENSE.") for name in names)
    assert any(name.endswith(".npz") for name in names)


def test_faults_are_found():
    package = {"carom/__init__.py", "carom/data/LICENSE.x"}
    rest = {
        f"carom-1.dist-info/{end}" for end in ("METADATA", "entry_points.txt", "licenses/LICENSE")
    }
    whole = package | rest | {"carom-1.dist-info/licenses/LICENSE.x"}
    faults = RELEASE["wheel_faults"]
    assert faults(whole, package) == []
    for extra in ("tests/test_a.py", "carom/__pycache__/a.py311.1.nbc"):
        assert any(extra in fault for fault in faults(whole | {extra}, package))
    for name in whole:
        assert faults(whole - {name}, package)


def test_one_version_everywhere():
    version = carom.__version__
    assert project()["version"] == version
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(r"^version: (.*)$", citation, re.M)[1] == version
    assert f"\n## {version}\n" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"version {version}." in (ROOT / "docs/cite.md").read_text(encoding="utf-8")


def project() -> dict:
    """Return the table of the project in `pyproject.toml`."""
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def test_versions_of_python_are_the_same_everywhere():
    known = [one.rpartition(" ")[2] for one in project()["classifiers"] if ":: 3." in one]
    assert project()["requires-python"] == f">={known[0]}"
    for path in (ROOT / ".github" / "workflows").glob("*.yml"):
        for matrix in re.findall(r"^ +python: \[(.*)\]$", path.read_text(encoding="utf-8"), re.M):
            assert re.findall(r'"(.*?)"', matrix) == known, path.name
    support = (ROOT / "docs" / "support.md").read_text(encoding="utf-8")
    assert f"| Python | {known[0]} to {known[-1]} |" in support


def test_the_conda_recipe_is_that_of_the_project():
    recipe = (ROOT / "conda" / "recipe.yaml").read_text(encoding="utf-8")
    assert f'version: "{carom.__version__}"' in recipe
    run = re.search(r"^  run:\n((?:    - .*\n)+)", recipe, re.M)[1]
    needed = [one.removeprefix("    - ").replace(" ", "") for one in run.splitlines()]
    assert needed == [f"python{project()['requires-python']}", *project()["dependencies"]]
    entries = {f"{name} = {value}" for name, value in project()["scripts"].items()}
    assert set(re.findall(r"^      - (carom = .*)$", recipe, re.M)) == entries


def test_each_page_of_the_reference_says_whether_it_is_stable():
    pages = [path for path in (ROOT / "docs" / "api").glob("*.rst") if path.stem != "index"]
    pages = [path for path in pages if not path.stem.startswith("carom.")]  # made by Sphinx
    said = {path.stem: path.read_text(encoding="utf-8").splitlines()[3] for path in pages}
    marks = {f":doc:`{word} <../support>`." for word in ("Stable", "Experimental")}
    assert {name for name in said if said[name] not in marks} == set()
