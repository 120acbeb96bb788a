"""The live viewer: its server, what is moved by the slider, and that nothing is left of it."""

import re
import signal
import subprocess
import sys
import threading
import time
import urllib.error
import urllib.request

import numpy as np
import pytest

import carom
from viewer.browser import needs_browser


@pytest.fixture
def live(thrown):
    """A viewer of the die, without a browser; nothing of it is left behind."""
    before = set(threading.enumerate())
    with carom.view(thrown, open=False, block=False, title="die") as view:
        yield view
    end = time.monotonic() + 10
    while left := set(threading.enumerate()) - before:
        assert time.monotonic() < end, left
        time.sleep(0.05)
    assert "ended" in repr(view)
    view.stop()  # a second time


def test_a_name_of_somebody_else_gets_nothing(live):
    """DNS rebinding: a page of another site that lets its own name point here, or that asks from there."""
    import websockets.sync.client as client
    from viser import __version__ as version
    from websockets.exceptions import InvalidStatus

    netloc = live.url.removeprefix("http://")
    port = netloc.split(":")[1]

    def page(host):
        request = urllib.request.Request(live.url, headers={"Host": host})
        try:
            return urllib.request.urlopen(request, timeout=10).status
        except urllib.error.HTTPError as error:
            return error.code

    own = netloc, f"127.0.0.1:{port}", f"[::1]:{port}"
    assert {host: page(host) for host in own} == dict.fromkeys(own, 200)
    others = (
        f"evil.example:{port}",
        f"127.0.0.1.evil.example:{port}",
        f"localhost.evil:{port}",
        "a b",
    )
    assert {host: page(host) for host in others} == dict.fromkeys(others, 403)

    def talk(origin):
        given = {"origin": origin, "subprotocols": [f"viser-v{version}"], "open_timeout": 10}
        try:
            with client.connect(f"ws://{netloc}", **given) as socket:
                return len(socket.recv(timeout=10)) > 0
        except InvalidStatus as error:
            return error.response.status_code

    assert talk(live.url) is talk(None) is True
    refused = (
        "http://evil.example",
        "null",
        f"https://evil.example:{port}",
        f"http://localhost:{port}1",
    )
    assert {origin: talk(origin) for origin in refused} == dict.fromkeys(refused, 403)


class Pressed:
    """What viser hands to those who listen: somebody in a browser has done it."""

    client = "somebody"


def move(handle, value):
    """Do what a browser does to a control."""
    handle._impl.value = value
    for listener in handle._impl.update_cb:
        listener(Pressed())


def test_slider_moves_bodies(live, thrown):
    for t in (0.1, 0.23):
        move(live.panel.time, t)
        x, Q, *_ = thrown.evaluate(t)
        (body,) = live.stage.bodies
        assert np.allclose(body.batched_positions, x, atol=1e-6)
        assert 1.0 - abs(float(body.batched_wxyzs[0] @ Q[0])) < 1e-6
        assert live.time == t


def test_an_impact_shows_its_arrow_and_inside(live, thrown):
    assert not live.stage.impulses.visible
    move(live.panel.impact, live.panel.impact.options[1])
    assert live.time == thrown.impacts.time[0]
    assert live.stage.impulses.visible
    start, end = live.stage.impulses.points[0]
    change = thrown.velocity[-1, 0] - thrown.velocity[0, 0]
    assert np.allclose(start, thrown.impacts.point[0], atol=1e-6)
    assert (end - start) @ change > 0
    assert "slip" in live.panel.words.content
    assert live.panel.velocity.visible
    assert np.allclose(
        live.panel.velocity.data[1][0], thrown.impacts.relative_velocity_before[0, 0]
    )
    origin = thrown.impacts.point[0] + [0.0, 0.0, 1.0]
    assert live.stage.nearest_impact(origin, (0, 0, -1)) == 0
    live.choose(-1)
    assert not live.panel.velocity.visible


def test_it_plays_to_its_end(live):
    live.speed = 10.0
    live.play()
    end = time.monotonic() + 10
    while live.playing and time.monotonic() < end:
        time.sleep(0.02)
    assert (live.time, live.playing) == (live.end, False)
    assert live.panel.time.value == pytest.approx(live.end)


def test_next_and_previous_impact(live, thrown):
    assert len(thrown.impacts) >= 2
    live.next_impact(1)
    live.next_impact(1)
    assert live.chosen == 1
    live.next_impact(-1)
    assert live.chosen == 0
    live.next_impact(-1)
    assert live.chosen == 0


@needs_browser
def test_page_of_the_server(live, browser, thrown):
    """A browser connects, the eye goes with the followed body, and what is said in the page is no error."""
    browser.open(live.url)
    end = time.monotonic() + 30
    while not live.server.get_clients() and time.monotonic() < end:
        browser.run("1")
        time.sleep(0.1)
    (client,) = live.server.get_clients().values()
    browser.wait_for("document.querySelector('canvas') !== null")
    # A page first says where its eye is by default, then where the server has put it: wait for that.
    end = time.monotonic() + 30
    while not np.allclose(client.camera.position, live.server.initial_camera.position, atol=1e-5):
        assert time.monotonic() < end, client.camera.position
        browser.run("1")
        time.sleep(0.05)
    live.follow("body1")
    before = client.camera.position.copy()
    live.seek(0.2)
    moved = thrown.evaluate(0.2)[0][0] - thrown.position[0, 0]
    end = time.monotonic() + 10  # what the browser says back may be a moment older
    while not np.allclose(client.camera.position - before, moved, atol=1e-5):
        assert time.monotonic() < end, (client.camera.position - before, moved)
        browser.run("1")
        time.sleep(0.05)
    assert all(url.startswith((live.url, "data:", "blob:")) for url in browser.loaded)
    browser.open("about:blank")


def test_it_waits_for_ctrl_c(thrown, tmp_path):
    """From a process of its own: it says where it is, answers there, and ends in good order."""
    thrown.save(tmp_path / "die.nc")
    code = (  # what a shell has started in the background ignores Ctrl-C, and hands that on
        "import carom, signal; signal.signal(signal.SIGINT, signal.default_int_handler);"
        "carom.view('die.nc', open=False); print('on we go')"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code], cwd=tmp_path, stdout=subprocess.PIPE, text=True
    ) as process:
        said = process.stdout.readline()
        address = re.fullmatch(r"die: (http://localhost:\d+) \(Ctrl-C ends it\)\n", said)[1]
        with urllib.request.urlopen(address) as page:
            assert "<title>" in page.read().decode()
        process.send_signal(signal.SIGINT)
        try:
            assert process.communicate(timeout=60)[0] == "on we go\n"
        finally:
            process.kill()  # nothing if it has ended
    assert process.returncode == 0


def test_server_is_for_this_machine_alone(live):
    assert live.server.get_host() == "127.0.0.1"
