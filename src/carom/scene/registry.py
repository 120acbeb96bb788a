"""The parts of a scene, each with a name that is unique in the scene."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from difflib import get_close_matches
from typing import Any, TypeVar

from carom import checks
from carom.scene.bodies import Body, Ground
from carom.scene.changes import KINDS, LEAVES, exchanged, of_origin, origin, parts_in
from carom.scene.contacts import Contact

T = TypeVar("T")


class Derived(dict):
    """Results of a scene as it is, by name; each change of the scene begins another one."""

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
        self.sealed = False  # the scene of a run, which must not change

    def copied(self, sealed: bool = False) -> Registry:
        """Return a copy with the same parts and results; one that is `sealed` refuses changes."""
        made = Registry(self.whole)
        made._parts = self._parts.copy()
        made._kinds = {kind: parts.copy() for kind, parts in self._kinds.items()}
        made.derived.update(self.derived)
        made.sealed = sealed
        return made

    def changes(self) -> None:
        """Begin a change of the scene: forget results of it as it was."""
        if self.sealed:
            raise ValueError(
                "scene must not be that of a run or of a solution, which stays as it was; change a copy of it: "
                "scene.copy()"
            )
        self.derived = Derived()

    def new(
        self, kind: type, name: str | None, default: str, replace: bool = False
    ) -> tuple[int, str]:
        """Return the index and the name of the next part of a `kind`, or of that which it replaces.

        If the name is None, it becomes `default` with a number: that of the part, or the next free one.
        """
        index = self.count(kind)
        if checks.flag("replace", replace):
            if name is None:
                raise ValueError("name must be given with replace=True, got None")
            old = self._parts.get(checks.text("name", name))
            if old is None:
                return index, name
            if type(old) is not kind:
                raise ValueError(
                    f"name must be that of a {KINDS[kind].called} to replace it, got {name!r}, a "
                    f"{KINDS[type(old)].called}; take that away: scene.remove({name!r})"
                )
            return old.index, name
        return index, self._numbered(default, index + 1) if name is None else self._free(name)

    def _numbered(self, default: str, number: int) -> str:
        while f"{default}{number}" in self._parts:
            number += 1
        return f"{default}{number}"

    def _free(self, name: str) -> str:
        checks.text("name", name)
        if name in self._parts:
            instead = "; replace=True puts the new part in the place of the one that has it"
            raise ValueError(
                f"name must be unique in the {self.whole}, got {checks.shown(name)} a second time"
                f"{instead if self.whole == 'scene' else ''}"
            )
        return name

    def make(
        self, kind: type[T], default: str, name: str | None, replace: bool, **values: Any
    ) -> T:
        """Make a part of a `kind`, which checks its values, and store it under the name that `new` returns."""
        values["index"], values["name"] = self.new(kind, name, default, replace)
        return self.add(kind(**values))

    def add(self, part) -> Any:
        """Store `part` under its name, and return it; a part that has the name gives it its place."""
        if part.name in self._parts:
            old = self._parts[part.name]
            of_origin(part, old)
            names = list(self._parts)
            later = set(names[names.index(part.name) :])
            if not isinstance(part, LEAVES) or any(one.name in later for one in parts_in(part)):
                self.exchange({id(old): part})
                return self._parts[part.name]
            self.changes()
            self._parts[part.name] = self._kinds[type(part)][part.index] = part
            return part
        self.changes()
        self._parts[part.name] = part
        self._kinds.setdefault(type(part), []).append(part)
        return part

    def exchange(self, changed: dict[int, Any]) -> None:
        """Put parts in the place of others, or take them away, as `exchanged` does."""
        parts = exchanged(self, changed)
        self.changes()
        self._parts = {part.name: part for part in parts}
        self._kinds = {kind: [part for part in parts if type(part) is kind] for kind in KINDS}

    def parts(self, kind: type) -> tuple:
        """Return all parts of a `kind`, in the order added."""
        if kind not in self.derived:
            self.derived[kind] = tuple(self._kinds.get(kind, ()))
        return self.derived[kind]

    def __iter__(self) -> Iterator:
        """Go through all parts, in the order added."""
        return iter(self._parts.values())

    def __contains__(self, name) -> bool:
        return name in self._parts

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
        raise KeyError(f"the {self.whole} has no part {self._called(name)}")

    def get(self, name: str) -> Any:
        """Return the part with exactly this name, or None."""
        return self._parts.get(name)

    def has(self, part) -> bool:
        """Return whether there is a part with this name, or a part is one of these."""
        if isinstance(part, str):
            try:
                return self[part] is not None
            except KeyError:
                return False
        own = self._parts.get(part.name) if type(part) in KINDS else None
        return own is not None and origin(own) is origin(part)

    def named(self, argument: str, part) -> Any:
        """Return a part of any kind, given as an object or by name, as `__getitem__` finds it."""
        if isinstance(part, str) and part not in self._parts and self.has(part):
            return self[part]
        return self.member(argument, part, tuple(KINDS))

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
        if isinstance(part, Ground) or (own := self._parts.get(part.name)) is part:
            return part
        if own is None or not self.has(part):
            raise ValueError(
                f"{argument} must belong to this {self.whole}, got {checks.shown(part)} of another one, "
                "or one that was removed"
            )
        return own

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
