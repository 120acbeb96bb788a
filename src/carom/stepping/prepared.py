"""A scene made ready for runs: compiled once for a method, with the arrays of a run before its first step."""

from __future__ import annotations

from typing import NamedTuple

from carom._compiled.units import Entries
from carom._compiled.user_functions import Functions
from carom.dynamics.methods import METHODS, make_method
from carom.impact.workspace import Group, new_group
from carom.model import records as r
from carom.model.compile import Compiled, compile_scene
from carom.model.kept import Mould
from carom.model.method import IMPLICIT, THREE_FIELD, Method
from carom.model.workspace import ActiveSet, Work
from carom.scene.scene import Scene
from carom.stepping.islands.layout import Islands, new_islands, no_islands, together
from carom.stepping.settings import Settings


class Prepared(NamedTuple):
    """What runs of a scene in the same `ways` begin with."""

    ways: tuple
    method: Method
    call: Entries
    apart: bool  # whether bodies may move in separate islands
    mould: Mould  # of the compiled scene; from the second run on, of all arrays of a run


class Arrays(NamedTuple):
    """The compiled scene and the workspace of one run."""

    compiled: Compiled
    active: ActiveSet
    work: Work
    islands: Islands
    group: Group


def prepared(scene: Scene, settings: Settings) -> tuple[Prepared, Arrays]:
    """Return a scene made ready for a run, with arrays of its own.

    The scene keeps what it was made of while it does not change, except for functions and curves of the user,
    which may answer otherwise when they are asked again.
    """
    ways = settings.options, settings.method, settings.impact_location, settings.adapts
    kept = scene._derived.get("prepared")
    if kept is None or kept.ways != ways:
        kind = METHODS[settings.method].kind
        apart = settings.impact_location == "locate" and kind != THREE_FIELD
        compiled = compile_scene(
            scene, settings.options, kind == THREE_FIELD, kind == IMPLICIT, apart
        )
        method = make_method(settings.method, settings.options, settings.adapts)
        call, mould = Entries(compiled.system, method), Mould((compiled,))
        kept = Prepared(ways, method, call, apart, mould)
        if not (compiled.functions._kept or len(compiled.system.relations.pieces)):
            scene._derived["prepared"] = kept
        return kept, _with_workspace(compiled, method, apart)
    compiled, *workspace = kept.mould.cast()
    compiled = compiled._replace(functions=Functions())
    if workspace:
        return kept, Arrays(compiled, *workspace)
    made = _with_workspace(compiled, kept.method, kept.apart)
    scene._derived["prepared"] = kept._replace(mould=Mould(made, together()))
    return kept, made


def _with_workspace(compiled: Compiled, method: Method, apart: bool) -> Arrays:
    system, later = compiled.system, compiled.later
    active, work = r.new_active_set(system), r.new_work(system, method.b.size)
    islands = new_islands(system, active, later) if apart else no_islands(system, active)
    return Arrays(compiled, active, work, islands, new_group(system, later is not None))
