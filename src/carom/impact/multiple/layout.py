"""Input, settings and result of a multiple impact."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom._compiled.record_arrays import table
from carom.impact.layout import BAD_INPUT
from carom.impact.thresholds import LAYER_RTOL
from carom.model.laws import Laws

if TYPE_CHECKING:
    from carom.options import Options

SIMULTANEOUS, SEQUENTIAL, BY_NEWTON = 0, 1, 2
MULTIPLE = {"simultaneous": SIMULTANEOUS, "sequential": SEQUENTIAL, "newton": BY_NEWTON}

#: beside those of `carom.impact.layout`: after every method some contact approaches, or energy has grown
NOT_RESOLVED = 2

MESSAGES = {
    BAD_INPUT: "a number is not finite or out of its range",
    NOT_RESOLVED: "with every method some contacts still approach at the end, or energy is gained",
}

# Bits of `marks`, beside AT_ONCE and PLASTIC of `carom.impact.layout`.
MISSED = 2  #: the law of Newton or Poisson was not satisfied; the nearest result or Stronge's law was used
CAPPED = 4  #: the law of a contact requires e_* > 1, and is not satisfied: energy cannot grow
EXACT = 16  #: contacts that move alike, resolved exactly as one
REPELLED = 32  #: the impulse was changed by round-off, so that energy does not grow
FINAL_SLIP = (
    512  #: one contact problem by the law of a contact that has no path: it may gain energy
)
NO_RESULT = 256  #: after every method a contact approaches, or energy has grown

HAS_STUCK = 2  #: bit of `sticks`: the contact is open, and opened without slip


class MultipleSettings(NamedTuple):
    """Settings of the resolver of multiple impacts."""

    multiple: int = SIMULTANEOUS
    rtol: float = LAYER_RTOL  # relative error of velocities
    exponent: float = 1.0  # p of the normal law; 0 in a run: by the shapes in contact
    max_events: int = 200  # changes of mode per contact
    max_steps: int = 2000  # per contact
    max_rounds: int = 40  # of the outer iteration of Newton's and Poisson's law


def multiple_settings(options: Options, exponent: float = 0.0) -> MultipleSettings:
    """Return the settings for the options of a run; `exponent` where these give none."""
    return MultipleSettings(
        multiple=MULTIPLE[options.multiple], rtol=options.corner_tolerance,
        exponent=options.corner_exponent or exponent,
    )  # fmt: skip


#: a contact of an impact
CORNER_CONTACT = [
    ("friction", "f8"),  # of a law, that which bounds stick
    ("restitution", "f8"),  # e
    ("law", "i8"),  # by number
    ("stiffness", "f8"),  # only ratios matter
    # contacts with equal numbers strike together, others in an impact of their own
    ("pair", "i8"),
    # written by the resolver
    ("place", "i8"),  # among all contacts, of one that strikes now
    ("acting", "f8"),  # friction where it acts, otherwise 0
    ("of_class", "i8"),  # number of the class of contacts that move alike
    ("pressed", "i8"),  # 1 if some force can press it
]


class CornerContacts(NamedTuple):
    """The contacts of an impact: the first k of each array; rows n, t1, t2 of each are rows of W and u."""

    contact: np.recarray  # (K,) CORNER_CONTACT
    W: np.ndarray  # (3K, 3K) inverse mass [1/kg], symmetric, often singular
    # (3K,) velocity before [m/s], approach negative; u_n = 0 for contacts that touch or persist
    u: np.ndarray


class Passage(NamedTuple):
    """Settings of the passage of a group, and the laws of its contacts."""

    rtol: float
    exponent: float  # p of the normal law
    max_events: int
    max_steps: int
    max_rounds: int
    by_slip: bool  # whether any friction depends on the slip
    may_gain: bool  # whether the energy may grow, in one contact problem
    speed: float  # unit of speeds [m/s]
    laws: Laws


RESULT = [
    ("energy_change", "f8"),
    ("plastic_change", "f8"),  # its part in the plastic event
    ("miss", "f8"),  # greatest ln(target/reached) of Newton's and Poisson's law where not met
    ("steps", "i8"),
    ("events", "i8"),
    ("rounds", "i8"),  # of the outer iteration
    ("classes", "i8"),  # of contacts that move alike
    ("marks", "i8"),
]


class MultipleResult(NamedTuple):
    """Result of an impact of K contacts."""

    impulse: np.ndarray  # (3K,) [N s]
    velocity: np.ndarray  # (3K,) after [m/s]
    compression: np.ndarray  # (K,) work of the normal force while loading, <= 0 [J]
    restitution: np.ndarray  # (K,) work of the normal force while unloading, >= 0 [J]
    friction: np.ndarray  # (K,) energy dissipated by friction [J]
    wedged: np.ndarray  # (K,) 1 if friction blocks the contact at the end: its law fails
    summary: np.recarray  # (1,) RESULT


def new_multiple_result(capacity: int) -> MultipleResult:
    """Return arrays for the result of up to `capacity` contacts."""
    k = max(int(capacity), 1)
    return MultipleResult(
        np.zeros(3 * k), np.zeros(3 * k), np.zeros(k), np.zeros(k), np.zeros(k),
        np.zeros(k, dtype=np.int64), table(RESULT, 1),
    )  # fmt: skip
