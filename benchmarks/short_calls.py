"""Time of a short call of `carom.simulate`: of a scene that was run before, and of a new one."""

from __future__ import annotations

import statistics
import warnings

import carom
from common import FEW, clock, die_scene, pendulum_scene, report


def pile(count: int = 10):
    """Return boxes, one on another, .2 mm apart."""
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1))
    scene.set_contact_default(restitution=0.2, friction=0.4)
    for k in range(count):
        scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=1.0, position=(0, 0, 0.0501 + 0.1002 * k))
    return scene


CASES = {
    "planar die, one impact, by tolerances": (die_scene, {"duration": 0.3}),
    "planar die, one impact, h = 10 ms": (die_scene, {"duration": 0.3, "step": 0.01}),
    "ten boxes, 0.01 s": (pile, {"duration": 0.01}),
    "pendulum, 0.1 s": (pendulum_scene, {"duration": 0.1}),
}


def milliseconds(make, how: dict, new: bool, calls: int) -> float:
    """Return the median time of a call; `new` scenes are made before their time is taken."""
    scene, times = make(), []
    for _ in range(3):
        carom.simulate(scene, **how)
    for _ in range(calls):
        one = make() if new else scene
        begin = clock()
        carom.simulate(one, **how)
        times.append(clock() - begin)
    return 1e3 * statistics.median(times)


def main() -> None:
    """Measure and report."""
    warnings.simplefilter("ignore")
    rows = []
    for name, (make, how) in CASES.items():
        times = (milliseconds(make, how, new, 20 if FEW else 300) for new in (False, True))
        rows.append([name, *(f"{time:.3g}" for time in times)])
    report("short_calls", "Short calls", ["", "the same scene [ms]", "a new scene [ms]"], rows)


if __name__ == "__main__":
    main()
