"""Six problems by nine programs: the page has the numbers of the file, and carom's are what it gives now."""

import re
from pathlib import Path

import pytest

import comparison

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "comparison.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def found():
    return comparison.points()


def test_the_page_has_the_numbers_of_the_file():
    (inside,) = re.findall(r"<!-- table: comparison -->\n(.*?)<!-- end -->", TEXT, re.DOTALL)
    table = re.findall(r"^\| (.*) \|$", inside, re.MULTILINE)[2:]
    assert [[cell.strip() for cell in line.split("|")] for line in table] == comparison.rows()
    assert comparison.machine() in inside
    for reason in comparison.why():
        assert reason in inside


def test_every_program_has_a_lock_with_its_version():
    names = {"dart": "dartpy", "rapier": "rapier3d", "siconos": "python3-siconos"}
    for program, version in comparison.kept()["versions"].items():
        if program != "carom":
            lock = ROOT / "benchmarks" / "peers" / "locks" / f"{program}.txt"
            name = names.get(program, program)
            assert re.search(rf"{name}={{1,2}}{re.escape(version)}", lock.read_text())


def test_sentences_of_the_page(found):
    def of(name, problem, setting):
        (point,) = [p for p in found[name][problem] if p.setting == setting]
        return point

    def asked(name, problem):
        return max(p.error / p.setting for p in found[name][problem])

    exact = [p for p in comparison.PROBLEMS if p not in ("stick-slip", "Pleiades")]
    ours = [p for name in exact for p in found["carom"][name]]
    assert max(p.error for p in ours) < 1e-14
    events = found["Siconos, event-driven"]
    assert max(p.error for problem in events.values() for p in problem) < 1e-13
    siconos, carom = events["bounce e=0.5"][0], comparison.best(found["carom"]["bounce e=0.5"])
    fall, own_fall = found["Exudyn, DOPRI5"]["free fall"], found["carom"]["free fall"]
    bullet, roll = found["PyBullet"]["rolling"][0], comparison.best(found["carom"]["rolling"])
    bristle = found["Exudyn, generalized-alpha"]["stick-slip"][0]
    slip, stars = found["carom"]["stick-slip"], found["carom"]["Pleiades"]
    dart, moreau = found["DART"]["stick-slip"][-1], found["Siconos, Moreau-Jean"]["stick-slip"][-1]
    said = [
        f"as fast or faster: {1e3 * siconos.time:.2g} ms beside {1e3 * carom.time:.2g} ms",
        f"{fall[0].error:.0e} m in {1e3 * fall[0].time:.2g} ms and {fall[-1].error:.0e} m in"
        f" {1e3 * fall[-1].time:.2g} ms, carom takes {1e3 * min(p.time for p in own_fall):.2g} ms",
        f"{1e3 * bullet.error:.1f} mm in {1e3 * bullet.time:.2g} ms where carom takes"
        f" {1e3 * roll.time:.2g} ms",
        f"{1e3 * bristle.error:.1f} mm in {1e3 * bristle.time:.2g} ms; the least of carom is"
        f" {1e3 * slip[0].time:.2g} ms",
        f"{dart.error:.0e} m (DART) and {moreau.error:.0e} m (Siconos)",
        f"takes {dart.time / slip[3].time:.0f} and {moreau.time / slip[3].time:.0f} times as long as carom"
        f" needs for {slip[3].error:.0e} m",
        f"{asked('carom', 'Pleiades'):.0f} times what was asked at most",
        f"Drake's RK3 {asked('Drake, RK3', 'Pleiades'):.0f} times, Exudyn's DOPRI5"
        f" {asked('Exudyn, DOPRI5', 'Pleiades'):.0f} times",
        f"at 1e-10 carom has {stars[-1].error:.0e} m in {1e3 * stars[-1].time:.2g} ms",
        f"from {of('Drake, CENIC', 'free fall', 1e-2).error:.1g} m at 1e-2 to"
        f" {of('Drake, CENIC', 'free fall', 1e-8).error:.0e} m at 1e-8",
    ]
    assert not [one for one in said if one not in TEXT]
    assert asked("carom", "stick-slip") < 1
    assert siconos.time < carom.time
    assert bullet.time < roll.time
    assert bristle.time < slip[0].time


@pytest.fixture(scope="module")
def solve():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(ROOT / "benchmarks" / "peers")
        import by_carom
        import problems
    return by_carom.SOLVE, problems.ANSWERS


@pytest.mark.parametrize("name", comparison.PROBLEMS)
def test_errors_of_carom_are_those_of_the_file(solve, found, name):
    import numpy as np

    solves, answers = solve
    for point in found["carom"][name][2:4]:
        place, _ = solves[name](point.setting)
        off = np.atleast_1d(np.asarray(place) - answers[name]())
        error = np.sqrt((off**2).sum(-1)).max() if off.ndim > 1 else np.linalg.norm(off)
        assert error < 2 * point.error + 1e-14


def test_the_answer_of_the_stars():
    """The reference of the IVP test set, by another integration."""
    import numpy as np
    from scipy.integrate import solve_ivp

    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(ROOT / "benchmarks" / "peers")
        import problems as p

    mass = np.arange(1.0, 8.0)[:, None]

    def rate(t, y):
        x = y[:14].reshape(7, 2)
        return np.concatenate([y[14:], (p.pull(x) / mass).ravel()])

    start = np.concatenate([p.STARS.ravel(), p.FLY.ravel()])
    run = solve_ivp(rate, (0, p.YEARS), start, method="DOP853", rtol=1e-13, atol=1e-13)
    assert np.abs(run.y[:14, -1].reshape(7, 2) - p.STARS_END).max() < 1e-9
