"""The code of the README and of the documentation pages runs, and prints what the pages say."""

import contextlib
import io
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FOLDERS = (ROOT / "docs" / "tutorial", ROOT / "docs" / "howto")
PAGES = ["README.md", "docs/start.md"]
PAGES += sorted(str(p.relative_to(ROOT)) for folder in FOLDERS for p in folder.glob("*.md"))
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def blocks(page: str) -> list[tuple[str, str]]:
    """Return (language, text) of all fenced blocks of a page."""
    return BLOCK.findall((ROOT / page).read_text(encoding="utf-8"))


def words(text: str) -> list[str]:
    """Return the words of an output; spaces, line breaks and brackets do not matter."""
    return re.sub(r"[\[\](),;<>]", " ", text).split()


def same(shown: str, printed: str) -> bool:
    """Whether two words are equal; numbers to 1e-6, or both round-off."""
    if shown == printed:
        return True
    try:
        a, b = float(shown), float(printed)
    except ValueError:
        return False
    return abs(a - b) <= 1e-6 * max(abs(a), abs(b)) or max(abs(a), abs(b)) < 1e-12


@pytest.mark.parametrize("page", [p for p in PAGES if any(k == "python" for k, _ in blocks(p))])
def test_code_of_a_page_prints_what_is_shown(page, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("MPLBACKEND", "agg")
    space, printed = {"__name__": "__main__"}, ""  # a module that Numba finds
    for language, text in blocks(page):
        if language == "python":
            output = io.StringIO()
            with contextlib.redirect_stdout(output):
                exec(compile(text, page, "exec"), space)
            printed = output.getvalue()
        elif language == "text":
            shown, got = words(text), words(printed)
            assert len(shown) == len(got), f"shown:\n{text}\nprinted:\n{printed}"
            wrong = [pair for pair in zip(shown, got) if not same(*pair)]
            assert not wrong, f"(shown, printed): {wrong}"
