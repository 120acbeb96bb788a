"""The order of the house: each folder imports only from those before it, and nothing goes round in circles."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

import carom
from sources import tree

ROOT = Path(carom.__file__).parent
#: folders and modules of carom, lowest first (`docs/development/architecture.md`)
ORDER = (
    "_compiled", "hints", "arguments", "checks", "fields", "options", "status", "geometry", "flexible", "scene",
    "collision", "model", "law", "kinematics", "contact", "friction", "dynamics", "impact", "persistent",
    "stepping", "results", "run", "generalized", "watch", "io", "control", "simulate", "studies",
    "visual", "baselines", "paper", "bench", "cli",
)  # fmt: skip
#: methods of what users hold in their hands that need a floor above, imported where they are called
DOORS = {
    ("flexible.modes", "io.files.disk"),
    ("scene.scene", "dynamics.mobility"),
    ("scene.contacts", "collision.api"),
    ("results.portable", "io.files.writing"),
    ("results.portable", "io.files.reading"),
    ("results.portable", "io.files.convert"),
    ("results.portable", "io.files.resume"),
    ("results.replay", "run"),
    ("results.spans", "io.files.kept"),
    ("scene.shown", "visual.notebook"),
    ("scene.shown", "visual.plots"),
    ("results.drawn", "visual.plots"),
    ("studies.ensembles.result", "visual.plots"),
    ("results.drawn", "visual.exports"),
}
LOOSE = 8


@cache
def modules() -> dict[str, Path]:
    """All modules, by their names below carom."""
    found = {}
    for path in ROOT.rglob("*.py"):
        parts = path.relative_to(ROOT).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


class Import(NamedTuple):
    """An import statement of a file."""

    node: ast.Import | ast.ImportFrom
    inside: bool  # a function
    for_types: bool  # only


def imports_below(node: ast.AST, inside: bool = False, for_types: bool = False):
    """Yield all imports below a node: statements are looked at, not what they are made of."""
    for_types = for_types or (
        isinstance(node, ast.If) and "TYPE_CHECKING" in ast.unparse(node.test)
    )
    inside = inside or isinstance(node, ast.FunctionDef)
    for below in ast.iter_child_nodes(node):
        if isinstance(below, (ast.Import, ast.ImportFrom)):
            yield Import(below, inside, for_types)
        elif isinstance(below, (ast.stmt, ast.ExceptHandler, ast.match_case)):
            yield from imports_below(below, inside, for_types)


@cache
def statements(path: Path) -> list[Import]:
    """All imports of a file."""
    return list(imports_below(tree(path)))


def imports(path: Path, known) -> list[tuple[str, bool]]:
    """Modules of carom that a file imports, and whether inside a function; not those for types only."""
    found = []
    for node, inside, for_types in statements(path):
        names = []
        if for_types:
            continue
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "carom":
            base = (node.module or "")[6:]
            for alias in node.names:
                full = f"{base}.{alias.name}" if base else alias.name
                names.append(full if full in known else base)
        else:
            names = [alias.name[6:] for alias in node.names if alias.name.startswith("carom.")]
        found += [(name, inside) for name in names if name]
    return found


def test_each_folder_imports_from_those_before_it():
    known, doors, wrong = modules(), set(), []
    for name, path in known.items():
        if not name:
            continue
        own = ORDER.index(name.split(".")[0])
        for other, inside in imports(path, known):
            if ORDER.index(other.split(".")[0]) > own:
                if inside and (name, other) in DOORS:
                    doors.add((name, other))
                else:
                    wrong.append(f"{name} imports {other}")
    assert not wrong
    assert doors == DOORS  # none that is not used


def test_no_file_imports_itself_by_way_of_others():
    known = modules()
    edges = {
        name: {other for other, inside in imports(path, known) if not inside and other != name}
        for name, path in known.items()
    }
    done, way = set(), []

    def visit(name):
        assert name not in way, " -> ".join([*way[way.index(name) :], name])
        if name in done:
            return
        way.append(name)
        for other in sorted(edges[name]):
            visit(other)
        way.pop()
        done.add(name)

    for name in known:
        visit(name)


def test_few_modules_stand_beside_the_folders():
    loose = {path.stem for path in ROOT.glob("*.py")} - {"__init__"}
    assert len(loose) <= LOOSE
    assert loose | {p.name for p in ROOT.iterdir() if (p / "__init__.py").exists()} == set(ORDER)


def test_only_compiled_code_knows_numba():
    for name, path in modules().items():
        if name.split(".")[0] == "_compiled":
            continue
        for node, *_ in statements(path):
            if isinstance(node, ast.Import):
                names = [a.name for a in node.names]
            else:
                names = [node.module or ""]
            assert not {one.split(".")[0] for one in names} & {"numba", "llvmlite"}, name


def test_only_laws_know_what_a_law_is_made_of():
    # Who has a law asks it by number (`carom.law`): a new form of coefficient is one file there.
    own = {"first", "last", "exponent"}
    found = [
        f"{name}:{node.lineno}"
        for name, path in modules().items()
        for node in ast.walk(tree(path))
        if isinstance(node, ast.Attribute)
        and (node.attr == "pieces" or node.attr in own)
        and ast.unparse(node.value).endswith(("laws", "laws.table"))
    ]
    outside = [where for where in found if not where.startswith(("law.", "model."))]
    assert len(found) > 2
    assert {where.split(":")[0] for where in outside} <= {"results.impact_remarks"}


#: columns that tell what a contact is
OF_KIND = {"kind", "static", "surface", "first_level", "last_level", "first_mine", "last_mine"}
#: who may ask: those who make the rows, and who composes the kinds by number
ASK = ("contact.kinds.", "contact.operations", "model.", "scene.")


def is_row_of_contacts(node: ast.AST) -> bool:
    """Whether a node is written as a row of `System.contacts`, or as all of them."""
    text = ast.unparse(node.value if isinstance(node, ast.Subscript) else node)
    return text.split(".")[-1] in ("contact", "contacts")


def test_only_kinds_of_contacts_know_what_a_contact_is():
    # The rest asks by operations: a new ground is one file of `contact.kinds`. The contact problem
    # of `friction` (and of a crowd), and systems in coordinates, have other records of contacts.
    from carom.model.contact_kinds import KINDS

    asked, files = [], {f"carom.contact.kinds.{kind}" for kind in KINDS}
    for name, path in modules().items():
        if name.startswith(("friction.", "stepping.crowd.solve", "generalized.")):
            continue
        for node in ast.walk(tree(path)):
            column = None
            if isinstance(node, ast.Attribute):
                column = node.attr
            elif isinstance(node, ast.Subscript) and isinstance(node.slice, ast.Constant):
                column = node.slice.value
            if column in OF_KIND and is_row_of_contacts(node.value):
                asked.append(name)
            if isinstance(node, ast.ImportFrom) and node.module == "carom.model.contact_kinds":
                asked += [name for one in node.names if one.name.isupper()]
            if isinstance(node, ast.ImportFrom) and node.module in files:
                asked.append(name)
    assert len(asked) > 20
    assert {name for name in asked if not name.startswith(ASK)} == {"contact.kinds"}


class Wall(NamedTuple):
    """Numbers of kinds, and the files that may compare with them."""

    numbers: set[str]  # in `carom.model.arrays`
    ask: tuple[str, ...]
    others: set[str]  # that do so too


WALLS = {
    "elements with rows of their own": Wall(
        {"RELATION", "USER_ROWS", "STIFF", "INERTIA", "OWN_ROWS"},
        ("dynamics.elements", "dynamics.element_operations", "model."),
        # turns that files of earlier versions lack, and the row of a motor in the place of friction
        {"dynamics.reactions", "results.dry_friction"},
    ),
    "coordinates of joints": Wall(
        {"REVOLUTE", "PRISMATIC", "SWING", "TWIST", "OF_LIMIT", "LIMITED"},
        ("kinematics.coordinates", "model."),
        {"dynamics.tree"},  # elimination begins with the most frequent joint
    ),
    "friction in joints": Wall(
        {"MOTION_JOINT"},
        (
            "persistent.joint_rows",
            "persistent.memory",
            "kinematics.contact_point",
            "dynamics.contact_impulse",
            "model.",
        ),
        # round-off and drift of its row, and its mode, which is no event of a contact
        {"persistent.rows", "persistent.start", "persistent.finish", "persistent.activation"},
    ),
}


@pytest.mark.parametrize("wall", WALLS)
def test_only_the_files_of_kinds_compare_kinds(wall):
    # The rest asks by operations that are composed by number: a new kind is one file.
    numbers, ask, others = WALLS[wall]
    found = {
        name
        for name, path in modules().items()
        for node in statements(path)
        if isinstance(node.node, ast.ImportFrom)
        and node.node.module in ("carom.model.arrays", "carom.model.workspace")
        and numbers & {one.name for one in node.node.names}
    }
    assert any(name.startswith(ask[0]) for name in found)
    assert {name for name in found if not name.startswith(ask)} <= others


def test_only_the_files_of_forces_know_their_tables():
    # All tables are copied and reported alike: a new force is a file there, which is given its rows, and its
    # definition.
    from carom.scene.forces import TABLES

    names = {kind.name for kind in TABLES}
    assert not [
        name
        for name, path in modules().items()
        for node in ast.walk(tree(path))
        if isinstance(node, ast.Attribute)
        and node.attr in names
        and ast.unparse(node.value).split(".")[-1] in ("forces", "tables")
    ]
    assert {f"dynamics.applied.{name}" for name in names} <= set(modules())


def test_large_records_are_made_by_name():
    # Of ten arrays and more of the same type no place in a list says which one is meant.
    rooms = {*ORDER[ORDER.index("collision") : ORDER.index("results")], "run"}
    read = {n: tree(p) for n, p in modules().items() if n.split(".")[0] in rooms}
    nodes = [(name, node) for name, module in read.items() for node in ast.walk(module)]
    large = {
        node.name
        for _, node in nodes
        if isinstance(node, ast.ClassDef)
        and "NamedTuple" in map(ast.unparse, node.bases)
        and sum(isinstance(line, ast.AnnAssign) for line in node.body) >= 10
    }
    assert {"System", "Work", "ContactWork"} <= large
    assert not [
        f"{name}:{node.lineno}"
        for name, node in nodes
        if isinstance(node, ast.Call) and node.args and getattr(node.func, "id", "") in large
    ]


def is_integer(value: ast.AST) -> bool:
    """Whether an expression is that of an integer: numbers, and what is computed of them."""
    if isinstance(value, ast.Constant):
        return type(value.value) is int
    if isinstance(value, ast.Call):
        return isinstance(value.func, ast.Name) and value.func.id in {"int", "len"}
    parts = [node for node in ast.iter_child_nodes(value) if isinstance(node, ast.expr)]
    return isinstance(value, ast.UnaryOp | ast.BinOp) and all(map(is_integer, parts))


def integers(path: Path) -> set[str]:
    """Names that a module binds to integers: one by one, in tuples, or by `range` and `map(int, ...)`."""
    found = set()
    for line in tree(path).body:
        if not isinstance(line, ast.Assign):
            continue
        for target in line.targets:
            pairs = [(target, line.value)]
            if isinstance(target, ast.Tuple):
                several = isinstance(line.value, ast.Tuple)
                values = line.value.elts if several else [ast.Constant(0)] * len(target.elts)
                counts = several or ast.unparse(line.value).startswith(("range(", "map(int,"))
                pairs = list(zip(target.elts, values)) if counts else []
            found |= {ast.unparse(name) for name, value in pairs if is_integer(value)}
    return found


def test_a_code_is_declared_once():
    """Two modules that declare one name mean one thing twice, or two things by one name."""
    declared: dict[str, list[str]] = {}
    for module, path in modules().items():
        for name in integers(path):
            declared.setdefault(name, []).append(module)
    assert len(declared) > 300
    assert {"NOT_FINITE", "EVENT_GAP", "NO_FRICTION", "FEW_PAIRS"} <= set(declared)
    assert {name: where for name, where in declared.items() if len(where) > 1} == {}


#: folders whose thresholds are in their files `thresholds.py` (`tests/test_thresholds.py`)
NUMERIC = {
    "geometry", "collision", "model", "law", "kinematics", "contact", "friction", "dynamics", "impact",
    "persistent", "stepping", "generalized",
}  # fmt: skip
#: floats beside them that are no thresholds: of mathematics, of a method, costs of work. It only gets shorter
OTHER_FLOATS = {
    "dynamics.double_double": {"SPLITTER"},
    "dynamics.implicit": {"GAMMA"},
    "friction.residual": {"NOTHING"},
    "kinematics.differences": {"_FIRST", "_SECOND"},
    "impact.resolve_by_slip": {"_NONE"},
    "impact.spline": {"_X1", "_X2", "_X3", "_W1", "_W2", "_W3"},
    "impact.strike_together": {"HERTZ", "LINEAR"},
    "kinematics.coordinates.turns": {"TURN"},
    "kinematics.torque_free_top": {"FAR"},
    "model.allowance": {"PART", "OF_STEP", "PARTS", "SAVED", "SMOOTH"},
    "model.records": {"LONG"},
    "stepping.crowd.step": {"CUT_PRODUCTS"},
}  # fmt: skip


def is_float(value: ast.AST) -> bool:
    """Whether an expression is a float, a tuple with one, or computed of them."""
    if isinstance(value, ast.Constant):
        return type(value.value) is float
    if isinstance(value, ast.BinOp) and isinstance(value.op, ast.Div):
        return True
    parts = [node for node in ast.iter_child_nodes(value) if isinstance(node, ast.expr)]
    return isinstance(value, ast.UnaryOp | ast.BinOp | ast.Tuple) and any(map(is_float, parts))


def floats(path: Path) -> set[str]:
    """Names that a module binds to floats: one by one, or in tuples."""
    found = set()
    for line in tree(path).body:
        if isinstance(line, ast.Assign):
            for target in line.targets:
                pairs = [(target, line.value)]
                if isinstance(target, ast.Tuple) and isinstance(line.value, ast.Tuple):
                    pairs = list(zip(target.elts, line.value.elts))
                found |= {ast.unparse(name) for name, value in pairs if is_float(value)}
    return found


def test_thresholds_are_in_the_files_of_thresholds():
    """A float beside them is a threshold without a unit and a reason."""
    found = {
        module: floats(path)
        for module, path in modules().items()
        if module.split(".")[0] in NUMERIC and not module.endswith(".thresholds")
    }
    assert {module: names for module, names in found.items() if names} == OTHER_FLOATS
    assert "ROUND_OFF" in floats(modules()["geometry.thresholds"])


#: who writes to the disk: whole files; parts of a folder with a protocol of its own; compiled code, which is
#: written below all other rooms and read only if it is whole
WRITERS = ("io.files.disk", "studies.ensembles.store", "_compiled.")
BY_NAME = {
    "write_text",
    "write_bytes",
    "savefig",
    "to_csv",
    "to_parquet",
    "tofile",
    "rename",
    "save_binary",
}
IN_MEMORY = ("out", "file", "bytes")  # what is then put


def writes(node: ast.AST) -> bool:
    """Return whether a call may write to a file, other than to an object that holds bytes."""
    if not isinstance(node, ast.Call):
        return False
    name = getattr(node.func, "attr", getattr(node.func, "id", ""))
    first = node.args[0] if node.args else None
    if name in BY_NAME:
        if name in ("to_csv", "rename") and first is None:  # it returns a text; columns of a table
            return False
        return getattr(first, "id", "") not in IN_MEMORY
    modes = [one.value for one in ast.walk(node) if isinstance(one, ast.Constant)]
    return name == "open" and any(mode in modes for mode in ("w", "wb", "a", "ab", "x", "xb"))


def test_all_files_are_written_whole():
    """By `io.files.disk`: a full disk leaves the old file."""
    found = {
        name: [node.lineno for node in ast.walk(tree(path)) if writes(node)]
        for name, path in modules().items()
    }
    assert not {
        name: lines for name, lines in found.items() if lines and not name.startswith(WRITERS)
    }
