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
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["version"] == version
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(r"^version: (.*)$", citation, re.M)[1] == version
    assert f"\n## {version}\n" in (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"version {version}." in (ROOT / "docs/cite.md").read_text(encoding="utf-8")
