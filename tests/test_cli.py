"""The command: help, version, exit codes, errors as one line, and each command as a user calls it."""

import json
import os
import re
import signal
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest

import carom
from carom.cli import CTRL_C, EXIT_OK, FAILED, USAGE, app, extras, main, scenes, show, warmup
from carom.io.progress import Bar

DIE = """
import carom
scene = carom.Scene()
ground = scene.add_half_space((0, 0, 0), (0, 0, 1))
die = scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.03), name="die",
                     velocity=(0.5, 0, -0.5), angular_velocity=(10, 10, 0))
scene.add_contact(die, ground, restitution=0.5, friction=0.2)
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with a scene in Python, and its result."""
    folder = tmp_path_factory.mktemp("cli")
    (folder / "die.py").write_text(DIE)
    out = folder / "die.h5"
    assert main(["simulate", str(folder / "die.py"), "-o", str(out), "-d", "0.05"]) == EXIT_OK
    return folder


def one_line(capsys) -> str:
    shown = capsys.readouterr().err
    assert shown.count("\n") == 1, shown
    return shown


def test_version(capsys):
    assert main(["--version"]) == EXIT_OK
    assert capsys.readouterr().out.strip() == f"carom {carom.__version__}"


@pytest.mark.parametrize("name", [name for name, _, _ in app.COMMANDS])
def test_help_teaches(name, capsys):
    """Each command has at least one example that is a call of it."""
    assert main([name, "--help"]) == EXIT_OK
    out = capsys.readouterr().out
    assert out.startswith(f"Usage: carom {name}")
    assert f"  carom {name}" in out.split("For example:")[1]


def test_no_command_shows_the_help(capsys):
    assert main([]) == USAGE
    out = capsys.readouterr().out
    assert all(f"\n  {name} " in out for name, _, _ in app.COMMANDS)
    assert "130 interrupted" in out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["paper", "--figure", "fig9"], ("fig9", "fig3a", "--figure")),
        (["paper", "--figure", "fig3a,fig9"], ("fig9", "fig3a")),
        (["nonsense"], ("nonsense", "paper")),
        (["doctor", "--much"], ("--much",)),
        (["simulate"], ("SCENE", "--resume")),
        (["simulate", "none.py", "-d", "1"], ("SCENE", "none.py")),
        (["simulate", __file__, "-d", "1"], ("'scene'", "none")),
        (["info", __file__], ("not HDF5",)),
        (["throw", "--load", "1.5"], ("--load must be",)),
        (["throw", "--count", "x"], ("--count",)),
    ],
)
def test_wrong_arguments_are_one_line_and_code_2(arguments, words, capsys):
    assert main(arguments) == USAGE
    shown = one_line(capsys)
    assert shown.startswith("carom")
    assert all(word in shown for word in words)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["-d", "-1"], ("duration", "-1")),
        (["-d", "1", "--step", "soon"], ("--step", "soon")),
        (["-d", "1", "--method", "rk3"], ("rk3", "rk8")),
        (["-d", "1", "--friction", "0.2"], ("--friction", ".xml")),
        (["-d", "1", "--until", "rest"], ("at rest", "got 'rest'")),
        ([], ("--duration",)),
    ],
)
def test_simulate_refuses(arguments, words, made, capsys):
    assert main(["simulate", str(made / "die.py"), *arguments]) == USAGE
    shown = one_line(capsys)
    assert all(word in shown for word in words)


def test_simulate_keeps_what_simulate_gives(made):
    kept = carom.Solution.load(made / "die.h5")
    again = carom.simulate(kept.scene, 0.05)
    np.testing.assert_array_equal(kept.position, again.position)
    assert len(kept.impacts) == len(again.impacts) >= 1


def test_simulate_saves_at_times_and_to_a_tolerance(made):
    """A given tolerance takes the place of both of the file's; a given step takes the place of tolerances."""
    out = ["-o", str(made / "finer.h5"), "--force"]
    assert main(["simulate", str(made / "die.h5"), "--save-at", "0.02", *out]) == EXIT_OK
    found = carom.Solution.load(made / "finer.h5")
    np.testing.assert_allclose(found.t, [0.0, 0.02, 0.04, 0.05], rtol=0, atol=1e-16)
    assert main(["simulate", str(made / "die.h5"), "--rtol", "1e-10", *out]) == EXIT_OK
    found = carom.Solution.load(made / "finer.h5").settings
    assert (found["method"], found["rtol"]) == ("rk8", 1e-10)
    assert found["atol"] < 1e-10
    assert main(["simulate", str(made / "finer.h5"), "--step", "0.01", *out]) == EXIT_OK
    found = carom.Solution.load(made / "finer.h5").settings
    assert (found["step"], found["method"], "rtol" in found) == (0.01, "rk4", False)


def test_simulate_until_an_event(made, capsys):
    out, until = made / "until.h5", "first impact of die and half_space1"
    command = ["simulate", str(made / "die.py"), "-d", "9", "-o", str(out), "--until", until]
    assert main([*command, "--until", "at rest"]) == EXIT_OK
    assert f'That was events[0] ("{until}") at t = ' in capsys.readouterr().out
    found = carom.Solution.load(out)
    assert found.status is carom.Status.STOPPED
    assert found.t[-1] == found.t_events[0][0]
    assert abs(found.t[-1] - found.impacts.time[0]) < 1e-15  # round-off of the search for it
    assert [len(t) for t in found.t_events] == [1, 0]
    assert main(["simulate", "--resume", str(out), "--until", "at rest"]) == USAGE
    assert "--until must be left out with --resume" in one_line(capsys)


def test_simulate_does_not_write_over_a_result(made, capsys):
    before = (made / "die.h5").read_bytes()
    command = ["simulate", str(made / "die.py"), "-o", str(made / "die.h5"), "-d", "0.01"]
    assert main(command) == USAGE
    assert "--force" in one_line(capsys)
    assert (made / "die.h5").read_bytes() == before


def test_a_result_and_its_json_are_scenes_too(made, capsys):
    """Settings are those of the result but for what is given."""
    assert main(["info", str(made / "die.h5"), "--scene"]) == EXIT_OK
    (made / "scene.json").write_text(capsys.readouterr().out)
    found = []
    for name, more in (("die.h5", []), ("scene.json", ["-d", "0.05"])):
        assert main(["simulate", str(made / name), "--step", "2e-3", "--json", *more]) == EXIT_OK
        found.append(json.loads(capsys.readouterr().out))
    for one in found:
        assert (one["status"], one["reached"], one["saved_steps"]) == ("SUCCESS", 0.05, 26)
    assert found[0]["impacts"] == found[1]["impacts"]
    (made / "other.json").write_text('{"gravity": [0, 0, 0]}')
    assert main(["simulate", str(made / "other.json"), "-d", "1"]) == USAGE
    assert "carom info" in one_line(capsys)


def test_a_script_that_fails_is_named_with_its_line(tmp_path, capsys):
    (tmp_path / "bad.py").write_text("import carom\n\nscene = carom.Scene(gravity=1 / 0)\n")
    assert main(["simulate", str(tmp_path / "bad.py"), "-d", "1"]) == FAILED
    assert "bad.py, line 3: ZeroDivisionError" in one_line(capsys)
    (tmp_path / "worse.py").write_text("import carom\nscene = (\n")
    assert main(["simulate", str(tmp_path / "worse.py"), "-d", "1"]) == FAILED
    assert "worse.py, line 2" in one_line(capsys)


def test_a_run_that_fails_is_kept_and_code_1(made, capsys):
    """With steps of a second the paper's return map cannot work: the die is deep inside the ground."""
    coarse = ["-d", "2", "--step", "1", "--impact-location", "project"]
    command = ["simulate", str(made / "die.py"), *coarse]
    assert main([*command, "-o", str(made / "failed.h5")]) == FAILED
    assert "smaller step" in one_line(capsys)
    assert not carom.Solution.load(made / "failed.h5").success


def test_a_result_that_cannot_be_saved_is_a_failure(made, capsys, monkeypatch):
    def full(*_, **__):
        raise OSError("no space")

    monkeypatch.setattr("carom.io.files.keeper.write", full)
    assert (
        main(["simulate", str(made / "die.py"), "-o", str(made / "lost.h5"), "-d", "0.1"]) == FAILED
    )
    found = capsys.readouterr()
    assert "could not be saved: no space" in found.err
    assert "lost.h5" not in found.out


def test_interrupted_simulate_keeps_the_run_and_resumes(made, capsys, monkeypatch):
    """The progress function stands for Ctrl-C: half-way, as a signal to this process."""
    out, straight = made / "long.h5", made / "straight.h5"

    def stop(self, done, total):
        if 2 * done >= total:
            os.kill(os.getpid(), signal.SIGTERM)  # taken as Ctrl-C

    command = ["simulate", str(made / "die.py"), "-d", "0.2"]
    with monkeypatch.context() as patch:
        patch.setattr(Bar, "__call__", stop)
        assert main([*command, "-o", str(out)]) == CTRL_C
    said = one_line(capsys)
    assert f"carom simulate --resume {out}" in said
    assert carom.Solution.load(out).t[-1] < 0.15
    assert main(["simulate", "--resume", str(out), "--step", "1"]) == USAGE
    assert "--step" in one_line(capsys)
    assert main(["simulate", "--resume", str(out)]) == EXIT_OK
    assert main([*command, "-o", str(straight)]) == EXIT_OK
    runs = [carom.Solution.load(path) for path in (out, straight)]
    np.testing.assert_array_equal(runs[0].position, runs[1].position)


def test_a_finished_run_goes_on(made, capsys):
    out, straight = made / "short.h5", made / "whole.h5"
    command = ["simulate", str(made / "die.py"), "--step", "0.001"]
    assert main([*command, "-d", "0.1", "-o", str(out)]) == EXIT_OK
    assert main(["simulate", "--resume", str(out), "-d", "0.2"]) == EXIT_OK
    assert "t = 0 to 0.2 s" in capsys.readouterr().out
    assert main([*command, "-d", "0.2", "-o", str(straight)]) == EXIT_OK
    runs = [carom.Solution.load(path) for path in (out, straight)]
    np.testing.assert_array_equal(runs[0].position, runs[1].position)
    assert main(["simulate", "--resume", str(out), "-d", "0.1"]) == USAGE
    assert "--duration must be finite and above 0.2" in one_line(capsys)


def test_the_suffix_of_out_decides(made, capsys):
    command = ["simulate", str(made / "die.py"), "-d", "0.1", "-o"]
    assert main([*command, str(made / "die.csv")]) == EXIT_OK
    head = (made / "die.csv").read_text().splitlines()[0]
    assert head.startswith("time,die.x,die.y,die.z,die.qw")
    assert (made / "die.impacts.csv").read_text().startswith("time,contact,")
    capsys.readouterr()
    assert main([*command, str(made / "die.xlsx")]) == USAGE
    assert "--out must end in .nc, .h5, .hdf5" in one_line(capsys)
    assert not (made / "die.xlsx").exists()


def test_functions_of_a_scene_by_their_names_in_files():
    scene = carom.Scene()
    body = scene.add_body(carom.Sphere(0.1), mass=1.0, position=(0, 0, 1))

    def wind(t, states):
        return np.zeros((1, 6))

    scene.add_force(carom.forces.UserForce(body, wind), name="wind")
    assert scenes.functions(scene) == {"wind.function": wind}


def test_info_is_what_the_solution_says(made, capsys):
    solution = carom.Solution.load(made / "die.h5")
    assert main(["info", str(made / "die.h5"), "--json"]) == EXIT_OK
    found = json.loads(capsys.readouterr().out)
    assert found["impacts"]["count"] == len(solution.impacts)
    assert found["impacts"]["energy"] == pytest.approx(solution.impacts.energy_change.sum())
    assert found["held"]["intervals"] == len(solution.contacts.start)
    assert found["energy"]["start"] == solution.total_energy[0]
    assert found["bodies"][0]["name"] == "die"
    assert found["source"] == f"carom {carom.__version__}"
    assert "10.1007" in found["citation"]
    assert main(["info", str(made / "die.h5")]) == EXIT_OK
    out = capsys.readouterr().out
    assert all(word in out for word in ("SUCCESS", "Box(lx=0.02", "greatest residual", "10.1007"))
    assert "\x1b" not in out  # no colours where nobody looks


def test_info_of_a_run_that_touches_nothing(made, capsys):
    up = str(made / "up.h5")
    assert main(["simulate", str(made / "die.py"), "-o", up, "-d", "0.005"]) == EXIT_OK
    capsys.readouterr()
    assert main(["info", str(made / "up.h5")]) == EXIT_OK
    assert re.search(r"persistent contact +0 intervals, 0 points", capsys.readouterr().out)


def test_what_is_not_there_is_one_line(made, capsys, monkeypatch):
    """A missing package is named with the line that installs it."""
    monkeypatch.setitem(sys.modules, "h5netcdf", None)
    assert main(["simulate", str(made / "die.h5"), "-o", str(made / "more.h5")]) == FAILED
    assert 'pip install "carom[files]"' in one_line(capsys)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert main(["paper", "fig3a", "--out", str(made / "paper")]) == FAILED
    assert 'pip install "carom[paper]"' in one_line(capsys)


def test_the_command_itself_is_an_extra(capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "typer", None)
    assert main(["doctor"]) == FAILED
    assert one_line(capsys).strip() == (
        'carom: the command needs the package typer; install it with pip install "carom[command]"'
    )


def test_extras_are_those_of_the_project():
    text = (Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8")
    told = tomllib.loads(text)["project"]["optional-dependencies"]
    found = extras.requirements()
    assert set(found) == {"", *told} - set(extras.OWN)
    assert found[""] == ("numpy", "scipy", "numba", "tqdm")
    assert found["command"] == ("typer", "rich")
    assert found["files"] == ("h5netcdf", "h5py", "xarray", "pandas")
    assert extras.pip_line("xarray.core") == 'pip install "carom[files]"'
    assert extras.pip_line("xarray", "ensemble") == 'pip install "carom[ensemble]"'
    assert extras.pip_line("nonsense") == "pip install nonsense"


def test_figures(tmp_path, capsys):
    """In the form that older versions had."""
    assert main(["paper", "--out", str(tmp_path / "x"), "--figure", "fig3a", "fig2a"]) == EXIT_OK
    names = [f"{name}.{end}" for name in ("fig2a", "fig3a") for end in ("pdf", "png")]
    assert sorted(path.name for path in (tmp_path / "x").iterdir()) == names
    assert "4 files" in capsys.readouterr().out


def test_figures_in_one_word(monkeypatch):
    asked = []
    monkeypatch.setattr("carom.paper.book.make", lambda out, names, tell: asked.append(names) or [])
    assert main(["paper", "--figure", "fig2a,fig3a"]) == EXIT_OK
    assert asked == [["fig2a", "fig3a"]]


def test_a_folder_that_cannot_be_made_is_one_line_and_code_1(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert main(["paper", "--out", str(tmp_path / "file" / "x"), "fig3a"]) == FAILED
    assert one_line(capsys).startswith("carom paper: ")


def test_doctor_speaks_before_it_compiles(capsys, monkeypatch):
    """What needs no compiler is there, and what is compiled is named, when the run begins."""
    from carom.cli import doctor

    said = []

    def stop(found):
        said.append(capsys.readouterr().out)
        raise KeyboardInterrupt

    monkeypatch.setattr(doctor, "check_code", stop)
    with pytest.raises(KeyboardInterrupt):
        doctor.run(warm=False, json=False)
    assert f"carom {carom.__version__}" in said[0]
    assert "numpy" in said[0]
    assert said[0].endswith(doctor.RUNS + "\n")


def test_doctor(capsys):
    code = main(["doctor"])
    out = capsys.readouterr()
    assert "numba" in out.out
    assert "bouncing sphere: error" in out.out
    assert code == (EXIT_OK if "no errors" in out.out else FAILED)
    assert main(["doctor", "--json"]) == code
    found = json.loads(capsys.readouterr().out)
    assert found["packages"]["numpy"] == np.__version__
    assert found["extras"]["files"]["install"] == 'pip install "carom[files]"'
    assert found["sphere"]["error"] < 1e-10


def test_json_has_no_nan(capsys):
    show.as_json({"a": float("nan"), "b": np.arange(2), "c": (np.float64(1.5), Path("x"))})
    assert json.loads(capsys.readouterr().out) == {"a": None, "b": [0, 1], "c": [1.5, "x"]}


def test_warmup_knows_contact_that_stays():
    """Bodies come to rest in each, and one is a heap."""
    for kind, (scene, duration) in warmup.contact_scenes().items():
        rough = carom.Options(energy_tolerance=0.01)  # the step is too long for the heap
        solution = carom.simulate(scene, duration, step=5e-3, throw=False, options=rough)
        assert solution.stats["holds"] > 0
        assert (solution.stats["whole_steps"] > 0) == (kind == "heap")
        assert np.max(np.abs(solution.velocity[-1])) < 1e-3


def test_warmup_scenes_run():
    """Each kind of scene has an impact, so that all of it is compiled; by each method."""
    for name, scene in warmup.scenes().items():
        run = carom.simulate(scene, 0.05, step=5e-3)
        assert len(run.impacts) >= 1, name
    kinds = {kind for kind, _, _ in warmup.work()}
    assert {*warmup.scenes(), *warmup.contact_scenes(), "layer", "impact"} <= kinds


def test_help_is_quick_and_needs_no_numba():
    """Neither numba nor matplotlib is loaded to show the help; nor typer by `import carom`."""
    code = (
        "import sys, carom; assert 'typer' not in sys.modules; "
        "from carom.cli import main; main(['simulate', '--help']); "
        "assert not {'numba', 'matplotlib', 'scipy', 'rich'} & set(sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_completion(tmp_path):
    """What bash asks for when TAB is pressed after 'carom si'."""
    asked = {"COMP_WORDS": "carom si", "COMP_CWORD": "1", "_CAROM_COMPLETE": "complete_bash"}
    done = subprocess.run(
        [sys.executable, "-m", "carom.cli"], env={**os.environ, **asked},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.stdout.split() == ["simulate"]


@pytest.mark.parametrize("columns", ["30", "200"])
def test_narrow_and_wide_windows(columns):
    done = subprocess.run(
        [sys.executable, "-m", "carom.cli", "info", "--help"], capture_output=True, text=True,
        env={**os.environ, "COLUMNS": columns, "TERMINAL_WIDTH": columns}, check=False,
    )  # fmt: skip
    assert done.returncode == EXIT_OK, done.stderr
    assert "carom info die.h5 --scene > die.json" in done.stdout


def test_a_result_is_shown_drawn_and_filmed(made, capsys, monkeypatch):
    run, page, film = made / "die.h5", made / "page.html", made / "die.gif"
    assert main(["view", str(run), "--export", str(page)]) == EXIT_OK
    assert page.stat().st_size > 20_000
    assert str(page) in capsys.readouterr().out
    model = made / "die.glb"
    assert main(["view", str(run), "--export", str(model)]) == EXIT_OK
    assert model.read_bytes()[:4] == b"glTF"
    for kind in ((), ("energy",), ("contacts",)):  # several axes by name, two, one
        picture = made / f"{len(kind)}.png"
        assert main(["plot", str(run), *kind, "-o", str(picture)]) == EXIT_OK
        assert picture.read_bytes()[:4] == b"\x89PNG"
    assert main(["film", str(run), "-o", str(film), "--fps", "50", "--speed", "0.5"]) == EXIT_OK
    assert film.read_bytes()[:3] == b"GIF"
    assert main(["plot", str(run), "nonsense"]) == USAGE
    assert "overview" in capsys.readouterr().err
    calls = []
    monkeypatch.setattr(carom, "view", lambda *a, **k: calls.append((a, k)), raising=False)
    assert main(["view", str(run), "--no-open", "--port", "8080"]) == EXIT_OK
    assert calls == [((run,), {"port": 8080, "open": False, "export": None})]


def test_a_model_is_read_and_its_report_shown(made, capsys):
    # a ball of .1 m falls .2 m: e = .5 leaves half the speed sqrt(2 g .2)
    (made / "ball.xml").write_text(
        "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body name='ball' pos='0 0 .3'><freejoint/>"
        "<geom size='.1' mass='1'/></body></worldbody><actuator><general site='top' gear='1 0 0 0 0 0'/>"
        "</actuator></mujoco>".replace("<geom size", "<site name='top'/><geom size")
    )
    out = made / "ball.h5"
    more = [
        "--restitution",
        "0.5",
        "--friction",
        "0.1",
        "-d",
        "0.25",
        "--step",
        "0.001",
        "-o",
        str(out),
    ]
    assert main(["simulate", str(made / "ball.xml"), *more]) == EXIT_OK
    assert "actuator" in capsys.readouterr().err
    impacts = carom.Solution.load(out).impacts
    speed = np.sqrt(2 * 9.81 * 0.2)
    np.testing.assert_allclose(impacts.relative_velocity_before[0, 0], -speed, rtol=1e-9)
    np.testing.assert_allclose(impacts.relative_velocity_after[0, 0], 0.5 * speed, rtol=1e-9)
