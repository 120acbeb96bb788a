"""The columns of an ensemble: numbers and words of each run by name, and back to arrays."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.io.files.convert import BODY
from carom.status import Status
from carom.studies.ensembles.outcome import PENDING, REFUSED, no_outcomes

if TYPE_CHECKING:
    from carom.studies.ensembles.result import Ensemble

#: words for the status of a run, which is a number among the outcomes
WORDS = {PENDING: "pending", REFUSED: "refused", **{int(s): s.name.lower() for s in Status}}
AXES: dict[tuple[int, ...], tuple[str, ...]] = {(3,): ("x", "y", "z"), (4,): ("w", "x", "y", "z")}
FOLDERS = ("inputs", "observed")


def body_names(ensemble: Ensemble | SimpleNamespace) -> list[str]:
    """Return the names of the bodies; those of a file without them are numbered."""
    count = ensemble.outcomes.dtype["position"].shape[0]
    given = ensemble.about.get("body_names")
    return json.loads(given) if given else [f"body{k + 1}" for k in range(count)]


def flat(name: str, shape: tuple[int, ...]) -> list[str]:
    """Return names of the columns of an array with this shape for each run."""
    if not shape:
        return [name]
    ends = AXES.get(shape) or [".".join(map(str, place)) for place in np.ndindex(shape)]
    return [f"{name}.{end}" for end in ends]


def outcome_columns(bodies: list[str]) -> dict[str, tuple[str, Any]]:
    """Return for each column of outcomes the outcome, and the place in it of each run."""
    found = {}
    for name in no_outcomes(0, len(bodies)).dtype.names or ():
        if name not in BODY:
            found[name] = name, ()
    for k, body in enumerate(bodies):
        for name, ends in BODY.items():
            found |= {f"{body}.{end}": (name, (k, i)) for i, end in enumerate(ends)}
    return found


def stems(ensemble: Ensemble) -> dict[str, dict[str, str]]:
    """Return names of inputs and of what is observed in the columns: their own, unless an outcome has it."""
    taken = {*outcome_columns(body_names(ensemble)), "message"}
    found: dict[str, dict[str, str]] = {}
    for folder in FOLDERS:
        found[folder] = {}
        for name, values in getattr(ensemble, folder).items():
            clear = not taken.intersection(flat(name, values.shape[1:]))
            found[folder][name] = name if clear else f"{folder}:{name}"
            taken.update(flat(found[folder][name], values.shape[1:]))
    return found


def columns(ensemble: Ensemble) -> dict[str, np.ndarray]:
    """Return all numbers and words of the runs by name, each (R,)."""
    found = {}
    for folder, names in stems(ensemble).items():
        for name, stem in names.items():
            values = getattr(ensemble, folder)[name]
            rows = values.reshape(len(values), -1)
            found |= dict(zip(flat(stem, values.shape[1:]), rows.T))
    for column, (name, place) in outcome_columns(body_names(ensemble)).items():
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


def layout(ensemble: Ensemble) -> dict[str, dict[str, list]]:
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
    runs = len(found["status"])
    for folder in FOLDERS:
        fields[folder] = {}
        for name, (stem, shape, kind) in shapes[folder].items():
            rows = [found[column] for column in flat(stem, tuple(shape))] or [np.zeros((runs, 0))]
            fields[folder][name] = np.stack(rows, axis=-1).reshape(runs, *shape).astype(kind)
    bodies = json.loads(about["body_names"])
    rows = no_outcomes(runs, len(bodies))
    codes = {word: code for code, word in WORDS.items()}
    for column, (name, place) in outcome_columns(bodies).items():
        values = found[column]
        if column == "status":
            values = [codes[word] for word in values]
        rows[name][(slice(None), *place)] = values
    said = enumerate(found["message"])
    return {**fields, "outcomes": rows, "failures": {k: str(text) for k, text in said if text}}
