"""A scene as JSON makes the same run again."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import carom
from carom.io.files.scene_data import Decoder, Encoder
from carom.io.files.scene_parts import scene_from_text, scene_to_text
from carom.model.compile import compile_scene
from files.compare import same_bits
from files.scenes import everything, pile, pull, push

pytestmark = pytest.mark.plain
GIVEN = {"motor.force": push, "wind.function": pull}


def arrays(value, name=""):
    """All arrays of a compiled scene by name; columns of records but for addresses, which are of a process."""
    if isinstance(value, np.ndarray) and value.dtype.names:
        for field in value.dtype.names:
            if "address" not in field:
                yield f"{name}.{field}", value[field]
    elif isinstance(value, np.ndarray):
        yield name, value
    elif isinstance(value, tuple) and hasattr(value, "_fields"):
        for field, one in zip(value._fields, value):
            yield from arrays(one, f"{name}.{field}")


@pytest.mark.parametrize("implicit", [False, True])
@pytest.mark.parametrize("scene", [everything(), pile()], ids=["everything", "pile"])
def test_compiled_arrays(scene, implicit):
    # of every kind of part that there is, with directions that change when they are normalised again
    text = scene_to_text(scene)
    again, missing = scene_from_text(text, GIVEN if scene.forces else None)
    assert missing == []
    assert str(again) == str(scene)
    one, two = (
        dict(arrays(compile_scene(s, carom.Options(), implicit=implicit))) for s in (scene, again)
    )
    assert one.keys() == two.keys()
    assert [name for name in one if not same_bits(one[name], two[name])] == []


def test_text_is_json_and_stays_the_same():
    text = scene_to_text(everything())
    data = json.loads(text, parse_constant=pytest.fail)  # no NaN, which is no JSON
    assert data["parts"][1]["name"] == "body1"
    assert data["parts"][1]["velocity"] == [0.0, 0.0, 0.0]
    assert scene_to_text(scene_from_text(text)[0]) == text


def test_arrays_stay_read_only():
    again, _ = scene_from_text(scene_to_text(everything()))
    with pytest.raises(ValueError, match="read-only"):
        again["body1"].position[0] = 1.0


def test_functions_are_named_and_missed():
    scene, missing = scene_from_text(scene_to_text(everything()))
    assert missing == ["motor.force", "wind.function"]
    with pytest.raises(
        RuntimeError, match=r"'motor\.force' \(files\.scenes\.push\) is not in the file"
    ):
        scene["motor"].definition.force(0.0, 0.0, 0.0)
    text = scene_to_text(everything())
    assert "placeholders" in json.loads(text)["note"]
    scene, missing = scene_from_text(text, {"motor.force": push})
    assert scene["motor"].definition.force is push
    assert missing == ["wind.function"]
    with pytest.raises(
        ValueError, match=r"names of the file \('motor\.force', 'wind\.function'\), got 'x'"
    ):
        scene_from_text(text, {"x": push})


@given(st.floats(allow_nan=False), st.lists(st.floats(allow_nan=False), max_size=4))
def test_any_number(one, several):
    # a number as JSON has 17 digits, which are enough; infinities have a name
    encoder = Encoder()
    values = (
        one,
        np.array(several),
        np.array([several]),
        np.arange(3),
        np.zeros((0, 3)),
        "a",
        None,
    )
    data = json.loads(json.dumps(encoder.value(values), allow_nan=False))
    back = Decoder([]).value(data)
    assert same_bits(np.float64(one), np.float64(back[0]))
    assert all(same_bits(a, b) for a, b in zip(values[1:5], back[1:5]))
    assert back[5:] == values[5:]
