"""No public callable takes a wrong value in silence, dies of it, or fails to say which argument it was."""

import inspect
import re
import sys
from pathlib import Path

import pytest

import carom
from bad_input import walk
from carom.scene.values import MethodsOfScene

pytest.importorskip("matplotlib")
pytest.importorskip("mujoco")
pytest.importorskip("sympy")
pytest.importorskip("h5netcdf")
pytest.importorskip("zarr")
pytest.importorskip("PIL")

API = Path(__file__).parents[2] / "docs" / "api"
ENTRY = r"^   carom\.(?:scene\.)?([a-z]\w*(?:\.\w+)+|[A-Za-z]\w*)$"  # of a list in its pages
SOME = 12  # kinds of wrong values for each parameter, half of them as look like numbers
FEW = 4  # of calls that take a tenth of a second
SHARE = 4  # of both, what is tried each time
DEAR = (
    "simulate to",
    "resume",
    "ensemble",
    "identify",
    "plots.",
    "film",
    "view",
    "Solution.plot",
)
MODULES = (
    "baselines",
    "constraints",
    "films",
    "forces",
    "joints",
    "models",
    "plots",
)

#: what the library hands back, and nobody makes
HANDED_BACK = {
    "AccuracyWarning", "GROUND", "ContactSolution", "CornerImpact", "Ensemble", "Impact", "LayerHistory",
    "MistakeWarning", "Model", "Sensitivities", "SimulationError", "Solution", "Status",
    "generalized.CoordinateContact", "generalized.GeneralizedSolution",
    "generalized.CoordinateImpactTable", "generalized.CoordinateImpact", "generalized.CoordinateState",
    "dynamics.mobility.Mobility", "results.ImpactTable", "results.ImpactRecord",
    "results.EventTable", "results.SwitchTable", "impact.ImpactForce", "impact.ImpactForces",
    "results.ContactTable",
    "results.ForceTable", "all_pairs.PairTable", "results.Ledger",
    "results.SystemState", "results.BodyState", "results.JointImpulse", "results.JointImpulseTable",
    "results.JointView", "results.ForceView", "results.ConstraintView", "results.ContactView",
    "io.files.convert.Frames",
    "visual.viewer.live.LiveView", "visual.viewer.page.Exported", "models.Coordinate", "models.Model",
    "models.Report", "models.Entry", "models.Keyframe", "models.Motor",
    "models.Robot", "models.Sensor", "impact.InvariantDirections",
    "impact.NormalMotion", "studies.gradient.Sensitivities", "studies.gradient.Derivative",
    "studies.gradient.Margin",
    "studies.gradient.ImpactKind", "studies.gradient.ImpactDerivative", "studies.gradient.ByInputs",
    "studies.identify.Identification",
    "studies.identify.State", "studies.identify.FreeFlight", "studies.identify.RollOut",
    "studies.identify.TrajectoryError",
    "studies.identify.Uncertainty", "baselines.LayerRun", "baselines.MoreauJeanRun",
    "joints.Joint", "joints.Joint.anchor", "forces.AppliedForce", "constraints.Constraint",
    "Options.as_dict", "studies.identify.Curvature",
    "Body", "HalfSpace", "Ground", "Contact", "Constraint", "AppliedForce", "stops.Stop", "switch.Switch",
    "joints.JointDefinition",
}  # fmt: skip


@pytest.fixture(scope="module")
def recipes(tmp_path_factory):
    return walk.recipes(tmp_path_factory.mktemp("calls"))


NAMES = list(walk.recipes(Path()))


def complaints(name, make, share):
    """Return what is wrong with the recipe of a callable, and with calls with wrong values."""
    call, arguments = make()
    missing = walk.parameters(call) - arguments.keys()
    if missing:
        return [f"the recipe of {name} must have a value for {missing}"]
    call(**arguments)  # what the recipe says works
    some = FEW if name.startswith(DEAR) else SOME
    found = walk.complaints(name, make, some // share)
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")
    return found


@pytest.mark.parametrize("share", [SHARE, pytest.param(1, marks=pytest.mark.slow)])
@pytest.mark.parametrize("dear", [False, True])
def test_wrong_values_are_refused_by_name(recipes, dear, share, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)  # where a word is taken as a path
    found = []
    for name in NAMES:
        if name.startswith(DEAR) == dear:
            found += complaints(name, recipes[name], share)
    assert found == []


def members(prefix, one):
    """Yield a function, or a class and its public methods."""
    yield prefix
    if inspect.isclass(one) and not issubclass(one, (tuple, int, BaseException)):
        for name, _ in inspect.getmembers(one, callable):
            own = any(
                name in vars(base) and base.__module__.startswith("carom") for base in one.__mro__
            )
            if own and not name.startswith("_"):
                yield f"{prefix}.{name}"


def public():
    """Yield the names of all public callables."""
    for name in carom.__all__:
        one = getattr(carom, name)
        if not inspect.ismodule(one):
            yield from members(name, one)
    for name in MODULES:
        module = getattr(carom, name)
        listed = getattr(module, "__all__", None) or [
            k
            for k, v in vars(module).items()
            if inspect.isclass(v)
            and v.__module__ == module.__name__
            and not issubclass(v, MethodsOfScene)  # whose methods are those of `Scene`
        ]
        for own in listed:
            if own not in carom.__all__:
                yield from members(f"{name}.{own}", getattr(module, own))
    for page in API.glob("*.rst"):
        for name in re.findall(ENTRY, page.read_text(), re.MULTILINE):
            yield short(name)


def short(name):
    """Return a name as users type it: `plots.energy` for `visual.plots.energy`."""
    for brief, module in carom._PACKAGES.items():
        whole = module.removeprefix("carom.") + "."
        if name.startswith(whole):
            return f"{brief}.{name.removeprefix(whole)}"
    return name


@pytest.mark.skipif(not API.exists(), reason="the pages are not here")
def test_every_public_callable_is_tried():
    """A new function needs a recipe in `states.py`, `runs.py` or `reads.py`."""
    # arithmetic on arrays that results are worked with is not checked: it is called for each number
    tried = {walk.plain(name) for name in NAMES} | HANDED_BACK
    assert sorted({n for n in public() if n not in tried and not n.startswith("geometry.")}) == []
