"""The parts of a scene, each with a name that is unique in the scene."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from difflib import get_close_matches
from typing import Any

from carom import checks
from carom.scene.bodies import Body, Ground
from carom.scene.contacts import Contact


class Derived(dict):
    """Results of a scene as it is now, by name; each change of the scene empties it."""

    def once(self, name: Hashable, compute: Callable[[], Any]) -> Any:
        """Return the result of this name; compute it if there is none."""
        if name not in self:
            self[name] = compute()
        return self[name]

    def __reduce__(self):  # deep copies, whose parts may be changed, and pickles begin without
        return Derived, ()


class Registry:
    """All named parts of one scene, or system in coordinates, in the order in which they were added."""

    def __init__(self, whole: str = "scene"):
        self.whole, self._parts = whole, {}
        self._kinds = {}
        self.derived = Derived()

    def copied(self) -> Registry:
        """Return a copy with the same parts."""
        made = Registry(self.whole)
        made._parts = self._parts.copy()
        made._kinds = {kind: parts.copy() for kind, parts in self._kinds.items()}
        made.derived.update(self.derived)
        return made

    def new(self, kind: type, name: str | None, default: str) -> tuple[int, str]:
        """Return the index and the name of the next part of a `kind`.

        If the name is None, it becomes `default` with a number: that of the part, or the next free one.
        """
        index = self.count(kind)
        return index, self._numbered(default, index + 1) if name is None else self._free(name)

    def _numbered(self, default: str, number: int) -> str:
        while f"{default}{number}" in self._parts:
            number += 1
        return f"{default}{number}"

    def _free(self, name: str) -> str:
        checks.text("name", name)
        if name in self._parts:
            raise ValueError(
                f"name must be unique in the {self.whole}, got {checks.shown(name)} a second time"
            )
        return name

    def add(self, part):
        """Store `part` under its name, and return it."""
        self.derived.clear()
        self._parts[part.name] = part
        self._kinds.setdefault(type(part), []).append(part)
        return part

    def parts(self, kind: type) -> tuple:
        """Return all parts of a `kind`, in the order added."""
        if kind not in self.derived:
            self.derived[kind] = tuple(self._kinds.get(kind, ()))
        return self.derived[kind]

    def __iter__(self) -> Iterator:
        """Go through all parts, in the order added."""
        return iter(self._parts.values())

    def count(self, kind: type) -> int:
        """Return the number of parts of a `kind`."""
        return len(self._kinds.get(kind, ()))

    def __getitem__(self, name: str):
        """Return the part with this name; of a contact, its two bodies may be named in either order."""
        if isinstance(name, str) and name in self._parts:
            return self._parts[name]
        for part in self._parts.values():
            if isinstance(part, Contact) and name == f"{part.other.name}-{part.body.name}":
                return part
        raise KeyError(f"the scene has no part {self._called(name)}")

    def member(self, argument: str, part, kinds: tuple[type, ...], hint: str = "") -> Any:
        """Return a `part`, given as an object or by name; refuse other `kinds` and parts of other scenes."""
        if isinstance(part, str):
            if part not in self._parts:
                world = hint if Ground in kinds and part.lower() in ("world", "ground") else ""
                raise ValueError(
                    f"{argument} must be a part of the {self.whole}, which has none "
                    f"{self._called(part)}{world}"
                )
            part = self._parts[part]
        checks.instance(argument, part, kinds, hint)
        if not isinstance(part, Ground) and self._parts.get(part.name) is not part:
            raise ValueError(
                f"{argument} must belong to this {self.whole}, got {checks.shown(part)} of another one"
            )
        return part

    def _called(self, name) -> str:
        """Return the end of a message about a name that no part has, with the nearest name."""
        near = get_close_matches(checks.shown(name).strip("'"), self._parts, n=1)
        hint = f"did you mean {near[0]!r}?" if near else f"it has {len(self._parts)} named parts"
        return f"called {checks.shown(name)}; {hint}"

    def pair(self, parent, child) -> tuple[Any, Any]:
        """Return `parent` and `child`, given as objects or by name; refuse a pair that cannot be joined."""
        hint = "; the world itself is carom.GROUND"
        parent = self.member("parent", parent, (Body, Ground), hint)
        hint = "; the world is the parent: add_joint(definition, carom.GROUND, body)"
        child = self.member("child", child, (Body,), hint if isinstance(child, Ground) else "")
        if parent is child:
            raise ValueError(
                f"parent and child must be two bodies, got {checks.shown(child)} for both"
            )
        return parent, child
