"""What cannot be shown, and wrong arguments, are refused by name."""

import sys

import pytest

import carom


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"follow": "dei"}, "follow must be one of 'body1'"),
        ({"speed": 0.0}, "speed must be finite and above 0"),
        ({"frames": 1}, "frames"),
        ({"frames": 2.5}, "frames must be a whole number"),
    ],
)
def test_arguments(thrown, tmp_path, arguments, words):
    with pytest.raises(ValueError, match=words):
        carom.view(thrown, export=tmp_path / "run.html", **arguments)
    assert not list(tmp_path.iterdir())


def test_arguments_of_the_live_viewer(thrown):
    with pytest.raises(ValueError, match="port"):
        carom.view(thrown, port=0, block=False, open=False)
    with pytest.raises(ValueError, match="block"):
        carom.view(thrown, block=1, open=False)


def test_export_needs_a_folder(thrown, tmp_path):
    with pytest.raises(ValueError, match="export must be the path of a file in a folder"):
        carom.view(thrown, export=tmp_path / "nowhere" / "run.html")


def test_what_cannot_be_shown(tmp_path):
    with pytest.raises(TypeError, match="solution must be a Solution"):
        carom.view(42, export=tmp_path / "run.html")
    with pytest.raises(FileNotFoundError):
        carom.view(tmp_path / "run.nc", export=tmp_path / "run.html")
    (tmp_path / "notes.nc").write_text("not a run")
    with pytest.raises(ValueError, match="path must be a file of a run"):
        carom.view(tmp_path / "notes.nc", export=tmp_path / "run.html")


def test_a_system_in_coordinates_is_not_shown(tmp_path):
    from carom.generalized.solution import GeneralizedSolution

    run = object.__new__(GeneralizedSolution)
    with pytest.raises(TypeError, match="of a GeneralizedSystem: its coordinates do not give"):
        carom.view(run, export=tmp_path / "run.html")


def test_without_viser(thrown, tmp_path, monkeypatch):
    """A page needs nothing; a live view says what to install."""
    monkeypatch.setitem(sys.modules, "viser", None)
    with pytest.raises(ImportError, match=r'pip install "carom\[view\]"'):
        carom.view(thrown, open=False)
    carom.view(thrown, export=tmp_path / "run.html")
    assert (tmp_path / "run.html").exists()


def test_the_name_of_the_file_is_the_title(thrown, tmp_path):
    thrown.save(tmp_path / "a throw.nc")
    carom.view(str(tmp_path / "a throw.nc"), export=tmp_path / "run.html")
    assert "<title>a throw</title>" in (tmp_path / "run.html").read_text()
