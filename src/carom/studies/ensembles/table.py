"""The columns of an ensemble: numbers and words of each run by name, and back to arrays."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.io.files.convert import BODY
from carom.status import Status
from carom.studies.ensembles.outcome import PENDING, REFUSED, Layout, no_outcomes
from carom.studies.values import OF_SYSTEM

if TYPE_CHECKING:
    from carom.studies.ensembles.result import Ensemble

#: words for the status of a run, which is a number among the outcomes
WORDS = {PENDING: "pending", REFUSED: "refused", **{int(s): s.name.lower() for s in Status}}
AXES: dict[tuple[int, ...], tuple[str, ...]] = {(3,): ("x", "y", "z"), (4,): ("w", "x", "y", "z")}
FOLDERS = ("inputs", "observed")


def layout_of(ensemble: Ensemble | SimpleNamespace) -> Layout:
    """Return what the states at the ends are of."""
    names = ensemble.outcomes.dtype.names or ()
    count = ensemble.outcomes.dtype["position"].shape[0] if "position" in names else 0
    return Layout.of_facts(ensemble.about, count)


def flat(name: str, shape: tuple[int, ...], layout: Layout) -> list[str]:
    """Return names of the columns of an array with this shape for each run."""
    if not shape:
        return [name]
    ends = AXES.get(shape) or [".".join(map(str, place)) for place in np.ndindex(shape)]
    if layout.of == "coordinates" and name in OF_SYSTEM:
        ends = layout.names
    return [f"{name}.{end}" for end in ends]


def outcome_columns(layout: Layout) -> dict[str, tuple[str, Any]]:
    """Return for each column of outcomes the outcome, and the place in it of each run."""
    found: dict[str, tuple[str, Any]] = {}
    for name in no_outcomes(0, layout).dtype.names or ():
        if name not in layout.fields:
            found[name] = name, ()
    for k, one in enumerate(layout.names):
        for field, shape in layout.fields.items():
            if shape:
                found |= {f"{one}.{end}": (field, (k, i)) for i, end in enumerate(BODY[field])}
            else:
                found[f"{field}.{one}"] = field, (k,)
    return found


def stems(ensemble: Ensemble) -> dict[str, dict[str, str]]:
    """Return names of inputs and of what is observed in the columns: their own, unless an outcome has it."""
    layout = layout_of(ensemble)
    taken = {*outcome_columns(layout), "message"}
    found: dict[str, dict[str, str]] = {}
    for folder in FOLDERS:
        found[folder] = {}
        for name, values in getattr(ensemble, folder).items():
            clear = not taken.intersection(flat(name, values.shape[1:], layout))
            found[folder][name] = name if clear else f"{folder}:{name}"
            taken.update(flat(found[folder][name], values.shape[1:], layout))
    return found


def columns(ensemble: Ensemble) -> dict[str, np.ndarray]:
    """Return all numbers and words of the runs by name, each (R,)."""
    found, layout = {}, layout_of(ensemble)
    for folder, names in stems(ensemble).items():
        for name, stem in names.items():
            values = getattr(ensemble, folder)[name]
            rows = values.reshape(len(values), -1)
            found |= dict(zip(flat(stem, values.shape[1:], layout), rows.T))
    for column, (name, place) in outcome_columns(layout).items():
        found[column] = ensemble.outcomes[name][(slice(None), *place)]
    found["status"] = np.array([WORDS[code] for code in found["status"].tolist()], dtype=object)
    found["message"] = messages(ensemble)
    return found


def messages(ensemble: Ensemble) -> np.ndarray:
    """Return the message of each run (R,), empty if there is none."""
    found = np.full(len(ensemble), "", dtype=object)
    for run, message in ensemble.failures.items():
        found[run] = message
    return found


def shapes(ensemble: Ensemble) -> dict[str, dict[str, list]]:
    """Return what `from_columns` needs: column, shape and type of inputs and of what is observed."""
    return {
        folder: {
            name: [stem, list((one := getattr(ensemble, folder)[name]).shape[1:]), one.dtype.str]
            for name, stem in names.items()
        }
        for folder, names in stems(ensemble).items()
    }


def from_columns(found: dict[str, np.ndarray], shapes: dict, about: dict) -> dict[str, Any]:
    """Return the fields of an `Ensemble` from its columns."""
    fields: dict[str, Any] = {"about": about}
    runs, layout = len(found["status"]), Layout.of_facts(about)
    for folder in FOLDERS:
        fields[folder] = {}
        for name, (stem, shape, kind) in shapes[folder].items():
            rows = [found[column] for column in flat(stem, tuple(shape), layout)] or [
                np.zeros((runs, 0))
            ]
            fields[folder][name] = np.stack(rows, axis=-1).reshape(runs, *shape).astype(kind)
    rows = no_outcomes(runs, layout)
    codes = {word: code for code, word in WORDS.items()}
    for column, (name, place) in outcome_columns(layout).items():
        values = found[column]
        if column == "status":
            values = [codes[word] for word in values]
        rows[name][(slice(None), *place)] = values
    said = enumerate(found["message"])
    return {**fields, "outcomes": rows, "failures": {k: str(text) for k, text in said if text}}
