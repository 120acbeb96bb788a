"""Mistakes of a newcomer: the sentence that is printed for each, word by word (`newcomer.txt`)."""

import re
import warnings
from pathlib import Path

import matplotlib as mpl
import pytest

from carom.arguments import attributes

mpl.use("agg")
TEXT = (Path(__file__).parent / "newcomer.txt").read_text(encoding="utf-8")
HEAD, *ENTRIES = re.split(r"^>>> ", TEXT, flags=re.M)
BEGIN = "\n".join(line[4:] for line in HEAD.split("\n") if line.startswith("    "))
MISTAKES = [entry.strip().split("\n", 1) for entry in ENTRIES]


def printed(line):
    """What is printed for a line after the first ones: the last line of a traceback, or a warning."""
    names = {}
    exec(BEGIN, names)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            exec(line, names)
        except Exception as error:
            return f"{type(error).__name__}: {error}"
    return "nothing"


def test_a_mistake_is_answered_by_this_sentence():
    wrong = []
    for line, sentence in MISTAKES:
        found = printed(line)
        if found.split() != sentence.split():
            wrong.append(f"{line}\n    {found}\n    and not {sentence}")
    assert not wrong, "\n".join(wrong)


def test_an_error_within_a_property_keeps_its_own_sentence():
    @attributes()
    class Broken:
        @property
        def value(self):
            return self.values

    with pytest.raises(AttributeError, match="no attribute 'values'; did you mean 'value'"):
        Broken().value  # noqa: B018


def test_there_are_mistakes_enough_and_none_twice():
    assert len(MISTAKES) >= 60
    assert len({line for line, _ in MISTAKES}) == len(MISTAKES)
