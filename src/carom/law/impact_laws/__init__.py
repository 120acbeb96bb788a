"""The laws of restitution by number, one file for each, with the names of `carom.scene.materials.IMPACT_LAWS`.

Restitution ends when a measured quantity reaches a goal. A law defines

- `MEASURE`, the quantity: "speed" (u_n), "impulse" (the normal impulse of restitution), or "work" (the work of
  the normal force in restitution); "nothing" if the impact has no path (`carom.impact.final_slip`);
- `goal(e, v0, p_c, work_c)`, its value at the end, from the restitution, the speed of approach [m/s], and the
  normal impulse [N s] and the work of the normal force [J], below zero, of compression;
- `GAINS`: whether the law may raise the energy if there is friction.

Compression is Newton's law with the goal u_n = 0.
"""

from __future__ import annotations

import math
from importlib import import_module

from carom._compiled.decorators import kernel
from carom.scene.materials import IMPACT_LAWS

NUMBERS = {name: number for number, name in enumerate(IMPACT_LAWS)}
NEWTON, STRONGE = NUMBERS["newton"], NUMBERS["stronge"]
LAWS = [import_module(f"{__name__}.{name}") for name in IMPACT_LAWS]


def _numbers(chosen) -> tuple[int, ...]:
    return tuple(number for number, law in enumerate(LAWS) if chosen(law))


BY_SPEED = _numbers(lambda law: law.MEASURE == "speed")
BY_IMPULSE = _numbers(lambda law: law.MEASURE == "impulse")
BY_WORK = _numbers(lambda law: law.MEASURE == "work")
WITHOUT_PATH = _numbers(lambda law: law.MEASURE == "nothing")
GAINING = _numbers(lambda law: law.GAINS)
COUNT = len(LAWS)


def _goal_up_to(number: int):
    """Return the kernel that calls the goal of a law by its number, for all numbers up to `number`."""
    own = LAWS[number].goal
    others = _goal_up_to(number - 1) if number > 0 else own

    @kernel
    def first(law, e, v0, p_c, work_c):
        return own(e, v0, p_c, work_c)

    @kernel
    def later(law, e, v0, p_c, work_c):
        if law == number:
            return own(e, v0, p_c, work_c)
        return others(law, e, v0, p_c, work_c)

    return later if number > 0 else first


#: `goal(law, e, v0, p_c, work_c)`: the value of the law's measure at which restitution ends
goal = _goal_up_to(COUNT - 1)


@kernel
def remaining(law, goal, u_n, p, work):
    """Return how far the phase is from its goal; `p` and `work` are counted from its start."""
    if law in BY_SPEED:
        return goal - u_n
    if law in BY_IMPULSE:
        return goal - p
    return goal - work


@kernel
def rate(law, u_n, k):
    """Return the derivative of the law's measure with the normal impulse, du_n/dp = k."""
    if law in BY_SPEED:
        return k
    if law in BY_IMPULSE:
        return 1.0
    return u_n


@kernel
def straight(law, left, u_n, k):
    """Return the normal impulse that reaches the goal, `left` away, if du_n/dp = k; infinite if none does."""
    if law in BY_SPEED:
        return left / k if k > 0.0 else math.inf
    if law in BY_IMPULSE:
        return left
    root = u_n * u_n + 2.0 * k * left  # u_n d + k d^2/2 = left
    if not root > 0.0:
        return math.inf
    below = u_n + math.sqrt(root)
    return 2.0 * left / below if below > 0.0 else math.inf
