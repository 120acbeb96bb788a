"""The command: help, version, errors as one line, and the paper's figures."""

import subprocess
import sys

import numpy as np
import pytest

import carom
from carom.cli import FAILED, OK, USAGE, main, warmup


def test_version(capsys):
    assert main(["--version"]) == OK
    assert capsys.readouterr().out.strip() == f"carom {carom.__version__}"


@pytest.mark.parametrize("arguments", [["--help"], ["paper", "--help"], ["doctor", "--help"]])
def test_help(arguments, capsys):
    assert main(arguments) == OK
    out = capsys.readouterr().out
    assert "usage: carom" in out
    assert "paper" in out or "doctor" in out


def test_no_command_shows_the_help(capsys):
    assert main([]) == USAGE
    assert "carom paper" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["paper", "--figure", "fig9"], ("fig9", "fig3a")),
        (["nonsense"], ("nonsense", "paper")),
        (["doctor", "--much"], ("--much",)),
    ],
)
def test_wrong_arguments_are_one_line_and_code_2(arguments, words, capsys):
    assert main(arguments) == USAGE
    shown = capsys.readouterr().err
    assert shown.count("\n") == 1
    assert all(word in shown for word in words)


def test_a_figure(tmp_path, capsys):
    assert main(["paper", "--out", str(tmp_path / "x"), "--figure", "fig3a"]) == OK
    assert sorted(path.name for path in (tmp_path / "x").iterdir()) == ["fig3a.pdf", "fig3a.png"]
    assert "2 files" in capsys.readouterr().out


def test_a_folder_that_cannot_be_made_is_one_line_and_code_1(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    assert main(["paper", "--out", str(tmp_path / "file" / "x"), "--figure", "fig3a"]) == FAILED
    shown = capsys.readouterr().err.strip().splitlines()[-1]
    assert shown.startswith("carom paper: ")


def test_doctor(capsys):
    code = main(["doctor"])
    out = capsys.readouterr()
    assert "numba" in out.out
    assert "bouncing sphere: error" in out.out
    assert code == (OK if "all well" in out.out else FAILED)


def test_warmup_knows_contact_that_stays():
    """Bodies come to rest in each, and one is a heap."""
    from carom.cli.warmup import contact_scenes

    for kind, (scene, duration) in contact_scenes().items():
        solution = carom.simulate(scene, duration, step=5e-3)
        assert solution.stats["holds"] > 0 or kind == "heap"
        assert np.max(np.abs(solution.velocity[-1])) < 1e-3


def test_warmup_scenes_run():
    """Each kind of scene has an impact, so that all of it is compiled."""
    for name, scene in warmup.scenes().items():
        run = carom.simulate(scene, 0.05, step=5e-3)
        assert len(run.impacts) >= 1, name


def test_help_is_quick_and_needs_no_numba():
    """What a shell does: neither numba nor matplotlib is loaded to show the help."""
    code = (
        "import sys; from carom.cli import main; main(['paper', '--help']); "
        "assert not {'numba', 'matplotlib', 'scipy'} & set(sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
