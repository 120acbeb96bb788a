"""The exported page: it plays by itself, loads nothing, and shows the motion."""

import json
import re

import numpy as np
import pytest

import carom
from carom.visual.viewer.pack import header_text
from viewer.browser import needs_browser


@pytest.fixture(scope="session")
def page(thrown, tmp_path_factory):
    """The page of the die."""
    path = tmp_path_factory.mktemp("page") / "die.html"
    written = carom.view(thrown, export=path, title="A <die> & co", follow="body1")
    assert (written.path, written.size) == (path, path.stat().st_size)
    assert str(written) == f"{path}: {written.size / 1e3:.0f} kB"
    assert written.size < 200_000
    return path


@pytest.fixture
def opened(page, browser):
    """The browser with the page of the die."""
    browser.open(page.as_uri())
    browser.wait_for("window.carom !== undefined")
    return browser


def drawn(browser) -> bool:
    """Let the next picture be drawn."""
    return browser.run(
        "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))"
    )


def test_page_asks_for_nothing(page):
    """No address is in it, and its own policy forbids to load any."""
    text = page.read_text(encoding="utf-8")
    links = set(re.findall(r"https?://[^\s\"'`)]+", text)) - {"http://www.w3.org/2000/svg"}
    assert not links
    assert "default-src 'none'" in text
    assert not re.search(r"<(script|link|img)[^>]+(src|href)=\"(?!data:,)", text)
    assert "A &lt;die&gt; &amp; co" in text


def test_names_cannot_end_the_script():
    assert "</script>" not in header_text({"bodies": ["</script><b>"]})
    assert json.loads(header_text({"a": ["</script>"]})) == {"a": ["</script>"]}


@needs_browser
def test_slider_moves_bodies_as_they_moved(opened, thrown):
    """Poses are those of the run: single precision, and straight lines between frames of half a millisecond."""
    for part in (0.0, 0.3137, 0.784, 0.79, 1.0):
        opened.run(f"(s => {{ s.value = {part}; s.dispatchEvent(new Event('input')); }})(slider)")
        pose = opened.run("carom.pose(0)")
        t = opened.run("carom.state.time")
        assert t == pytest.approx(0.25 * part)
        x, Q, *_ = thrown.evaluate(t)
        assert np.allclose(pose["position"], x[0], atol=1e-6)
        assert 1.0 - abs(np.dot(pose["orientation"], Q[0])) < 1e-6
    assert drawn(opened)
    assert "0.2500 / 0.2500 s" in opened.run("clock.textContent")
    assert opened.said == []
    assert [url for url in opened.loaded if not url.startswith(("data:", "blob:"))] == [
        opened.run("location.href")
    ]


@needs_browser
def test_what_is_seen(opened):
    """Something is drawn, and it changes with time."""
    shots = []
    for t in (0.0, 0.19):
        opened.run(f"carom.seek({t})")
        assert drawn(opened)
        opened.run(
            "document.getElementById('space').toDataURL('image/png').length"
        )  # a picture of the canvas
        shots.append(opened.call("Page.captureScreenshot", format="png")["data"])
    assert len(shots[0]) > 20_000
    assert shots[0] != shots[1]
    assert opened.run("notice.hidden")


@needs_browser
def test_an_impact_shows_its_inside(opened, thrown):
    opened.run("document.querySelector('#list tbody tr').click()")
    assert opened.run("carom.state.time") == thrown.impacts.time[0]
    assert opened.run("inside.querySelectorAll('svg.chart').length") == 3
    assert "slip" in opened.run("inside.textContent")
    cells = opened.run("[...document.querySelectorAll('#list tbody tr')].map(r => r.textContent)")
    assert len(cells) == len(thrown.impacts)
    assert "body1-half_space1" in cells[0]
    assert opened.run("energy.querySelectorAll('svg.chart path').length") >= 3
    assert "impulse, greatest" in opened.run("legend.textContent")
    opened.run("document.dispatchEvent(new KeyboardEvent('keydown', {key: 'Escape'}))")
    assert opened.run("inside.children.length") == 0


@needs_browser
def test_a_click_on_a_mark_chooses_its_impact(opened):
    opened.run("reset.click()")  # all of the motion is in view
    assert drawn(opened)
    for k, (dx, dy) in ((1, (2, 3)), (0, (-3, 1)), (-1, (200, -200))):
        x, y = opened.run(f"carom.markOf({max(k, 0)})")
        for kind in ("mousePressed", "mouseReleased"):
            where = {"x": x + dx, "y": y + dy, "button": "left", "clickCount": 1}
            opened.call("Input.dispatchMouseEvent", type=kind, **where)
        assert opened.run("carom.state.chosen") == k


@needs_browser
def test_an_address_may_name_a_moment(page, browser, thrown):
    for end, time in (("#t=0.125", 0.125), ("#impact=2", thrown.impacts.time[1])):
        browser.open("about:blank")
        browser.open(page.as_uri() + end)
        browser.wait_for("window.carom !== undefined")
        assert browser.run("carom.state.time") == time


@needs_browser
def test_an_address_may_play_again_and_again(page, browser):
    browser.open("about:blank")
    browser.open(page.as_uri() + "#loop")
    browser.wait_for("window.carom !== undefined")
    assert browser.run("carom.state.playing && panel.hidden")
    browser.run("carom.seek(0.249)")
    browser.wait_for("carom.state.time < 0.2")  # past the end it begins anew
    assert browser.run("carom.state.playing")
    assert browser.said == []


@needs_browser
def test_keys_play_and_step(opened):
    def press(key):
        opened.run(f"document.dispatchEvent(new KeyboardEvent('keydown', {{key: '{key}'}}))")

    press("ArrowRight")
    assert opened.run("carom.state.time === carom.run.time[1]")
    press("ArrowLeft")
    assert opened.run("carom.state.time === carom.run.time[0]")
    press(" ")
    assert opened.run("carom.state.playing")
    opened.wait_for("carom.state.time > 0.001")
    press(" ")
    assert not opened.run("carom.state.playing")
    press("ArrowDown")
    assert opened.run("carom.state.chosen") == 0
    press("End")
    assert opened.run("carom.state.time === carom.run.time.at(-1)")
    assert opened.said == []


@needs_browser
def test_held_forces_and_shapeless_bodies_are_drawn(slid, swung, browser, tmp_path):
    for name, solution in (("slid", slid), ("swung", swung)):
        path = tmp_path / f"{name}.html"
        carom.view(solution, export=path)
        browser.open(path.as_uri())
        browser.wait_for("window.carom !== undefined")
        browser.run(f"carom.seek({solution.t[-1]}); carom.choose(0)")
        assert drawn(browser)
        assert browser.said == []
    assert "rad/s" in browser.run("inside.textContent")
    browser.open((tmp_path / "slid.html").as_uri())
    browser.wait_for("window.carom !== undefined")
    assert "force of persistent contact" in browser.run("legend.textContent")
