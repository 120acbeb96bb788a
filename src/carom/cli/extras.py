"""The optional packages of each extra: ``pip install "carom[files]"``."""

from __future__ import annotations

import re
import tomllib
from importlib import metadata
from pathlib import Path

#: extras that combine others, and extras for developers of carom
OWN = ("all", "test", "docs", "bench")


def requirements() -> dict[str, tuple[str, ...]]:
    """Return the packages of each extra; those that are always needed under ``""``.

    From pyproject.toml in a checkout, else from the installed package.
    """
    project = Path(__file__).parents[3] / "pyproject.toml"
    if project.exists() and 'name = "carom"' in (text := project.read_text(encoding="utf-8")):
        project = tomllib.loads(text)["project"]
        lines = [("", line) for line in project["dependencies"]]
        for extra, more in project["optional-dependencies"].items():
            lines += [(extra, line) for line in more]
    else:
        lines = []
        for line in metadata.requires("carom") or []:
            extra = re.search(r"extra\s*==\s*['\"]([\w-]+)['\"]", line)
            lines.append((extra[1] if extra else "", line))
    found: dict[str, list[str]] = {"": []}
    for extra, line in lines:
        name = re.match(r"[\w.-]+", line)
        if name and name[0] != "carom" and extra not in OWN:
            found.setdefault(extra, []).append(name[0])
    return {extra: tuple(names) for extra, names in found.items()}


def version(package: str) -> str | None:
    """Return the version of an installed package, or None."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def pip_line(module: str, likely: str = "") -> str:
    """Return the pip command that installs a missing module; `likely` is the extra of the command."""
    wanted = _plain(module.split(".")[0])
    owners = [e for e, names in requirements().items() if wanted in map(_plain, names)]
    if likely and (likely in owners or not owners):
        return f'pip install "carom[{likely}]"'
    if owners and owners[0]:
        return f'pip install "carom[{owners[0]}]"'
    return f"pip install {module.split('.')[0]}"


def _plain(name: str) -> str:
    return name.lower().replace("-", "_")
