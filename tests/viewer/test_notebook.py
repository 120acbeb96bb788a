"""What notebooks show: HTML that loads nothing, with the page of a run in a frame of its own."""

import base64
import html
import io
import re
import sys

import numpy as np
import pytest

import carom
from carom.visual import notebook
from carom.visual.viewer.page import page_text
from carom.visual.viewer.show import show_of
from simulate.scenes import die
from viewer.browser import needs_browser


@pytest.fixture(scope="module")
def ensemble(thrown):
    """Three dice of other masses."""
    return carom.ensemble(thrown.scene, 0.1, step=5e-3, vary={"body1.mass": [0.01, 0.02, 0.03]})


def pictures(text):
    """The pictures in HTML, as arrays."""
    from PIL import Image

    found = re.findall(r'src="data:image/png;base64,([^"]*)"', text)
    return [np.asarray(Image.open(io.BytesIO(base64.b64decode(one)))) for one in found]


def test_a_run_is_its_page_in_a_frame(thrown):
    text = thrown._repr_html_()
    ((page, rest),) = re.findall(r'srcdoc="([^"]*)" sandbox="allow-scripts"([^>]*)>', text)
    assert "src=" not in rest
    assert html.unescape(page) == page_text(show_of(thrown, most=notebook.FRAMES))
    assert "1 bodies, t = 0 .. 0.25 s" in text  # where frames are not shown


def test_a_large_run_is_a_picture_and_a_sentence(thrown, monkeypatch):
    monkeypatch.setattr(notebook, "MOST_BYTES", 10_000)
    text = thrown._repr_html_()
    (picture,) = pictures(text)
    assert picture.shape == (400, 800, 3)
    assert "iframe" not in text
    assert "carom.view(solution, export=&quot;run.html&quot;) writes it" in text


def test_a_scene_is_a_picture_of_its_start_and_its_parts():
    scene = die(color="#b01020", name="<b>&$x$")
    text = scene._repr_html_()
    (picture,) = pictures(text)
    red, green, _ = picture.transpose(2, 0, 1).astype(int)
    assert (
        np.mean(red > green + 50) > 5e-4
    )  # the die, and nothing else, has this colour; it is above a floor
    assert "&lt;b&gt;&amp;&#36;x&#36;" in text
    assert "<b>" not in text
    assert "color: #b01020" in text
    for part in scene.half_spaces:
        assert part.name in text
    assert "img" not in carom.Scene()._repr_html_()


def test_the_picture_of_a_scene_has_what_is_near():
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), color="#00ff00")
    scene.add_static(carom.Box(0.3, 0.3, 0.1), position=(0.3, 0, 0.05), color="#0000ff")
    scene.add_static(carom.Box(1, 1, 1), position=(90, 0, 0.5))  # too far to be seen
    scene.add_body(carom.Box(0.1, 0.1, 0.1), mass=1, position=(0, 0, 0.4), color="#ff0000")
    (picture,) = pictures(scene._repr_html_())
    strongest = picture.argmax(axis=-1)[np.ptp(picture.astype(int), axis=-1) > 50]
    assert np.all(np.bincount(strongest) > 0.005 * 400 * 800)


def test_the_picture_of_a_scene_has_floor_and_walls():
    """A ball 1 m above a floor and 2 m from a wall, ten and twenty times its radius."""
    scene = carom.Scene()
    scene.add_half_space((0, 0, 0), (0, 0, 1), color="#00ff00")
    scene.add_static(carom.Box(0.1, 9, 9), position=(-2, 0, 4.5), color="#0000ff")
    scene.add_body(carom.Sphere(0.1), mass=1, position=(0, 0, 1), color="#ff0000")
    (picture,) = pictures(scene._repr_html_())
    strongest = picture.argmax(axis=-1)[np.ptp(picture.astype(int), axis=-1) > 50]
    assert np.all(np.bincount(strongest, minlength=3) > np.array([0.003, 0.05, 0.05]) * 400 * 800)


def test_without_the_package_for_pictures_its_line_is_shown(monkeypatch):
    monkeypatch.setitem(sys.modules, "PIL", None)
    assert "pip install &quot;carom[film]&quot;" in die()._repr_html_()


def cells(text):
    """The rows of a table of HTML."""
    rows = re.findall(r"<tr>(.*?)</tr>", text)
    return [[html.unescape(c) for c in re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", r)] for r in rows]


def test_tables_have_their_numbers(thrown, slid, ensemble):
    _, *rows = cells(thrown.impacts._repr_html_())
    assert len(rows) == len(thrown.impacts)
    assert float(rows[0][1]) == pytest.approx(thrown.impacts.time[0], rel=1e-5)
    assert float(rows[0][-1]) == pytest.approx(thrown.impacts[0].energy_change, rel=1e-5)
    ledger = {row[0]: row[1:] for row in cells(slid.ledger._repr_html_())}
    assert float(ledger["friction"][1]) == pytest.approx(slid.ledger.friction[-1], rel=1e-5)
    known = {row[0]: row[1:] for row in cells(ensemble._repr_html_())}
    mass = [float(x) for x in known["input: body1.mass"]]
    np.testing.assert_allclose(mass, [0.02, 0.01 * np.sqrt(2 / 3), 0.01, 0.03, 3], rtol=1e-5)
    assert "status" not in known
    assert f"and {len(slid.forces) - 10} more" in slid.forces._repr_html_()
    impact = carom.resolve_impact(np.diag([1.0, 3.5, 3.5]), (-1.0, 1.0, 0.0), 0.1, 0.5)
    assert ["phases", "slip"] in cells(impact._repr_html_())
    assert ["name", thrown.impacts[0].name] in cells(thrown.impacts[0]._repr_html_())


CODE = """
import carom
scene = carom.Scene()
ground = scene.add_half_space((0, 0, 0), (0, 0, 1), name="ground")
die = scene.add_body(carom.Box(0.02, 0.02, 0.02), mass=0.016, position=(0, 0, 0.1), name="die")
scene.add_contact(die, ground, restitution=0.5)
scene
---
solution = carom.simulate(scene, 0.25, step=5e-3)
solution
---
solution.impacts
---
ax = solution.plot("energy")
---
ax = solution.plot("impacts")
---
import matplotlib.pyplot as plt
line = plt.plot([1, 2])
"""


@pytest.mark.slow
def test_a_notebook_has_them():
    """A kernel of its own runs the cells."""
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    made = nbformat.v4.new_notebook(cells=list(map(nbformat.v4.new_code_cell, CODE.split("---"))))
    nbclient.NotebookClient(made, timeout=120, kernel_name="python3").execute()
    scene, solution, impacts = (cell.outputs[-1].data["text/html"] for cell in made.cells[:3])
    for cell in made.cells[
        3:
    ]:  # each figure is shown once, also after the first, and the reader's own
        assert sum("image/png" in one.get("data", {}) for one in cell.outputs) == 1, cell.source
    assert len(pictures(scene)) == 1
    assert "srcdoc=" in solution
    assert len(cells(impacts)) > 1


@needs_browser
def test_a_static_page_shows_the_run(thrown, browser, tmp_path):
    page = tmp_path / "notebook.html"
    page.write_text(
        f"<!doctype html><meta charset='utf-8'>{thrown._repr_html_()}", encoding="utf-8"
    )
    browser.open(page.as_uri())
    browser.wait_for("document.readyState === 'complete'")

    def picture():
        from PIL import Image

        shot = browser.call("Page.captureScreenshot", format="png")["data"]
        return np.asarray(Image.open(io.BytesIO(base64.b64decode(shot))).convert("RGB"))

    def blue():
        """Pixels of the colour of the die, in the left of the frame."""
        shot = picture()[:450, :500].astype(int)
        return np.sum((shot[..., 2] > 150) & (shot[..., 2] > shot[..., 0] + 60))

    browser._until(lambda: blue() > 300)
    assert not browser.said
    assert not [url for url in browser.loaded if url.startswith("http")]
