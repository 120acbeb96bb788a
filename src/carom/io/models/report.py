"""`Report`: the differences between a model and its scene; equal entries are printed together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from carom import checks


def need_mujoco() -> Any:
    """Return the module ``mujoco``, or say how to install it."""
    return checks.need("mujoco", "load_model", "models")


SHOWN_NAMES = 4  # names of elements that are printed before "and 17 more"


class Entry(NamedTuple):
    """One difference between a model and its scene.

    Attributes
    ----------
    element : str
        Kind and name of the element, such as ``"actuator 'elbow'"``.
    what : str
        The property that was left out or changed.
    instead : str
        The replacement in the scene.
    """

    element: str
    what: str
    instead: str

    def __str__(self) -> str:
        return f"{self.element}: {self.what}; {self.instead}"


class Report(Sequence[Entry]):
    """All differences between a model and its scene. Print it: elements with equal entries share a line."""

    def __init__(self):
        self._entries: list[Entry] = []
        self._known: set[Entry] = set()

    def add(self, element: str, what: str, instead: str) -> None:
        """Add an entry."""
        for name, given in (("element", element), ("what", what), ("instead", instead)):
            checks.text(name, given)
        entry = Entry(element, what, instead)
        if entry not in self._known:
            self._known.add(entry)
            self._entries.append(entry)

    def __getitem__(self, index):
        return self._entries[index]

    def __len__(self) -> int:
        return len(self._entries)

    def of(self, element: str) -> list[Entry]:
        """Return the entries whose element contains this text: a name, or a kind such as ``"actuator"``."""
        checks.text("element", element)
        return [entry for entry in self._entries if element in entry.element]

    def __str__(self) -> str:
        if not self._entries:
            return "all of the model is in the scene"
        groups: dict[tuple[str, str], list[str]] = {}
        for element, what, instead in self._entries:
            groups.setdefault((what, instead), []).append(element)
        return "\n".join(
            f"{_listed(elements)}: {what}; {instead}"
            for (what, instead), elements in groups.items()
        )

    def __repr__(self) -> str:
        return f"<Report: {len(self._entries)} entries>"


def _listed(elements: list[str]) -> str:
    more = len(elements) - SHOWN_NAMES
    text = ", ".join(elements[:SHOWN_NAMES])
    return f"{text} and {more} more" if more > 0 else text
