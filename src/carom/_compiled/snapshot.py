"""A copy of a user's function with all values that it uses, and their text: what its code depends on.

Numba takes the values of globals and of closures when it compiles, and a function that it has compiled keeps
the old ones. So code is kept on disk (`carom._compiled.kept_code`) only for a copy: the key is a hash of the
text, the code is compiled from the copy, and both are made at once. A part whose value the text could not tell
raises `NotKept`: such a function is compiled in each process.
"""

from __future__ import annotations

import builtins
import dis
import hashlib
import operator
import sys
import types
from typing import Any

import numpy as np
from numba.core import imputils
from numba.core import types as kinds
from numba.core.compiler import Compiler
from numba.core.registry import CPUDispatcher
from numba.core.typing import templates

#: packages whose functions have one meaning for one version
_KNOWN = {"builtins", "math", "cmath", "operator", "_operator", "numpy", "numba"}
_CONSTANTS = int, float, bool, complex, str, bytes, types.NoneType, types.EllipsisType
_MOST_BYTES = (
    10**6
)  # of an array that Numba copies into the code; of a larger one it takes the address


class NotKept(Exception):
    """A part of a function has no text that tells its value."""


class Snapshot:
    """The copy of a function: `function`, and `text`, the text of all that it depends on.

    With ``plain=True`` functions that Numba has compiled become plain ones, which a call from Python does not
    compile.
    """

    def __init__(self, function: types.FunctionType, plain: bool = False):
        self._plain, self._foreign = plain, _foreign()
        self._seen: dict[int, tuple[int, Any]] = {}  # copies, with their numbers in the text
        self._modules: dict[int, tuple[int, Any, set[str]]] = {}
        self._inside: list[types.FunctionType] = []
        self._stated: list[tuple[Any, list]] = []  # functions with the signatures that they state
        self.text: list[str] = []
        self.function = self._function(function)

    def named_after(self, digest: str) -> None:
        """Name all copies by a digest of the text: symbols of different code must differ."""
        for k, one in enumerate(self._inside):
            one.__name__ = one.__qualname__ = f"user_{digest}_{k}"
        for one, signatures in self._stated:
            for signature in signatures:
                one.compile(signature)
            one.disable_compile()

    @property
    def digest(self) -> str:
        """A hash of the text."""
        return hashlib.sha256(repr(self.text).encode()).hexdigest()

    def _function(self, one: types.FunctionType, seen: Any = None) -> types.FunctionType:
        """Copy a function; it is known to the parts inside it, because it may call itself."""
        code = one.__code__
        if one.__kwdefaults__:
            raise NotKept("arguments by name only")
        self._code(code)
        space, cells = {"__name__": __name__}, [types.CellType() for _ in code.co_freevars]
        defaults = self._value(one.__defaults__, set())
        made = types.FunctionType(code, space, one.__name__, defaults, tuple(cells))
        made.__module__ = __name__
        self._inside.append(made)
        if seen is not None:
            seen(made)
        used, names = _globals(code), _names(code)
        for name in sorted(used):
            self.text.append(f"global {name}")
            if name in one.__globals__:
                space[name] = self._value(one.__globals__[name], names)
            else:
                self._value(getattr(builtins, name, self), names)
        for name, cell, old in zip(code.co_freevars, cells, one.__closure__ or ()):
            self.text.append(f"outer {name}")
            try:
                cell.cell_contents = self._value(old.cell_contents, names)
            except ValueError as error:  # it is not set yet
                raise NotKept(name) from error
        return made

    def _code(self, code: types.CodeType) -> None:
        """Write the text of instructions, without line numbers."""
        if any(one.opname.startswith("IMPORT") for one in dis.get_instructions(code)):
            raise NotKept("an import")
        if not self._foreign["attributes"].isdisjoint(code.co_names):
            raise NotKept("an attribute that other code defines for Numba")
        self.text.append(
            f"code {code.co_code!r} {getattr(code, 'co_exceptiontable', b'')!r} {code.co_flags} "
            f"{code.co_argcount} {code.co_names} {code.co_varnames} {code.co_freevars} {code.co_cellvars}"
        )
        for part in code.co_consts:
            if isinstance(part, types.CodeType):
                self._code(part)
            elif isinstance(part, frozenset):  # of a test `x in {1, 2}`; its order is not told
                self.text.append(f"set {sorted(map(repr, part))}")
            else:
                self._value(part, set())

    def _value(self, value: Any, names: set[str]) -> Any:
        """Write the text of a value, and return its copy; of a module only these names count."""
        kind = type(value)
        if kind in _CONSTANTS:
            self.text.append(f"{kind.__name__} {value!r}")
        elif isinstance(value, tuple):
            return self._tuple(value, names)
        elif kind is np.ndarray:
            return self._array(value)
        elif isinstance(value, np.generic) and kind.__module__ == "numpy" and kind is not np.void:
            self.text.append(f"number {value.dtype!r} {value.tobytes()!r}")
        elif kind is CPUDispatcher:
            return self._compiled(value)
        elif kind is types.ModuleType:
            return self._module(value, names)
        elif isinstance(value, kinds.Type) and _root(kind.__module__) == "numba":
            self.text.append(f"type {value!r}")
        else:
            self._known(value)
        return value

    def _known(self, value: Any) -> None:
        """Write the name of a function or class of Python, NumPy or Numba, which is found by this name."""
        place = getattr(value, "__module__", None)
        if kind := type(value) is np.ufunc:
            place = "numpy"
        name = getattr(value, "__name__" if kind else "__qualname__", None)
        found: Any = sys.modules.get(place) if isinstance(place, str) else None
        for part in (name or "").split("."):
            found = getattr(found, part, None)
        if found is not value or _root(place) not in _KNOWN or value is None:
            raise NotKept(repr(value))
        if id(value) in self._foreign["functions"]:
            raise NotKept(f"{name}, which other code defines for Numba")
        self.text.append(f"known {place}.{name}")

    def _tuple(self, value: tuple, names: set[str]) -> tuple:
        kind = type(value)
        fields = getattr(kind, "_fields", None)
        if kind is not tuple and fields is None:
            raise NotKept(repr(value))
        self.text.append(
            f"tuple {len(value)} {fields and (kind.__module__, kind.__qualname__, fields)}"
        )
        parts = [self._value(one, names) for one in value]
        return tuple(parts) if kind is tuple else kind(*parts)

    def _array(self, value: np.ndarray) -> np.ndarray:
        """Copy an array that Numba would copy into the code."""
        flags = value.flags
        if value.nbytes > _MOST_BYTES or not flags.forc or value.dtype.hasobject:
            raise NotKept("a large array")
        made = value.copy(order="K")
        made.flags.writeable = flags.writeable
        order = made.flags.c_contiguous, made.flags.f_contiguous, flags.writeable, flags.aligned
        numbers = hashlib.sha256(made.tobytes(order="A")).hexdigest()
        self.text.append(f"array {made.dtype!r} {made.shape} {order} {numbers}")
        return made

    def _compiled(self, one: Any) -> Any:
        """Copy a function that Numba has compiled, with its options, and compile it anew."""
        if id(one) in self._seen:
            number, made = self._seen[id(one)]
            self.text.append(f"again {number}")
            return made
        options = {
            name: sorted(value) if isinstance(value, (set, frozenset)) else value
            for name, value in sorted(one.targetoptions.items())
        }
        stated = [] if one._can_compile else one.nopython_signatures
        plain = all(type(value) in _CONSTANTS or type(value) is list for value in options.values())
        if one.locals or options.get("parallel") or not plain:
            raise NotKept("an option of Numba")
        if one._compiler.pipeline_class is not Compiler:
            raise NotKept("a pipeline of Numba")
        self.text.append(f"compiled {options} {stated}")

        def seen(copy):
            made = copy
            if not self._plain:
                made = CPUDispatcher(copy, targetoptions=dict(one.targetoptions))
            self._seen[id(one)] = len(self._seen), made

        self._function(one.py_func, seen)
        made = self._seen[id(one)][1]
        if stated and not self._plain:
            self._stated.append((made, stated))
        return made

    def _module(self, value: Any, names: set[str]) -> types.ModuleType:
        """Copy what a function uses of a module; modules of Python, NumPy and Numba stay."""
        known = _root(value.__name__) in _KNOWN
        if id(value) not in self._modules:
            made = value if known else types.ModuleType(value.__name__)
            self._modules[id(value)] = len(self._modules), made, set()
        number, made, done = self._modules[id(value)]
        self.text.append(f"module {number} {value.__name__ if known else ''}")
        wanted = sorted((names & vars(value).keys()) - done)
        done.update(wanted)
        for name in wanted:
            part = vars(value)[name]
            self.text.append(f"part {name}")
            if not known:
                setattr(made, name, self._value(part, names))
            elif isinstance(part, (CPUDispatcher, tuple, np.ndarray)):
                raise NotKept(name)  # it is not of the package
            elif not _is_method(part):  # of the one generator of `numpy.random`: this name tells it
                self._value(part, names)
        return made


def _root(name: str | None) -> str:
    """Return the package of a module."""
    return (name or "").split(".")[0]


def _is_method(value: Any) -> bool:
    return isinstance(value, types.BuiltinMethodType) and value.__module__ is None


def _globals(code: types.CodeType) -> set[str]:
    """Return the names of globals of a function, and of the functions inside it."""
    made = {one.argval for one in dis.get_instructions(code) if one.opname == "LOAD_GLOBAL"}
    return made.union(*(_globals(one) for one in code.co_consts if isinstance(one, types.CodeType)))


def _names(code: types.CodeType) -> set[str]:
    """Return all names of globals, attributes and methods in a function, and in the functions inside it."""
    inside = (_names(one) for one in code.co_consts if isinstance(one, types.CodeType))
    return set(code.co_names).union(*inside)


def _foreign() -> dict[str, set]:
    """Return which functions of Python, NumPy and Numba other packages define for Numba, and which attributes.

    The text of a function does not tell what they do.
    """
    made: dict[str, set] = {"functions": set(), "attributes": set()}
    for one in (*templates.builtin_registry.functions, *templates.builtin_registry.attributes):
        of = getattr(one, "_overload_func", None) or getattr(one, "generic", None) or one
        if of.__module__ is not None and _root(of.__module__) not in ("numba", "carom"):
            made["functions"].add(id(one.key))
            made["attributes"].add(getattr(one, "_attr", None))
    for one, key, _ in imputils.builtin_registry.functions:
        if _root(one.__module__) not in ("numba", "carom"):
            made["functions"].add(id(key))
    if any(id(one) in made["functions"] for one in vars(operator).values()):
        raise NotKept("an operator that other code defines for Numba")
    return made
