"""Chromium without a window, driven by the DevTools protocol: one page, its console and what it loads."""

import json
import shutil
import subprocess
import time
import urllib.request
from pathlib import Path

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
CHROMIUM = next(filter(None, map(shutil.which, NAMES)), None)
WAIT = 90  # for a page [s]: a busy machine draws in software for long
FLAGS = (
    "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--remote-debugging-port=0",
    "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    "--window-size=1280,800", "--no-first-run", "--disable-background-networking",
)  # fmt: skip
needs_browser = pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium to open the page")


class Browser:
    """A chromium with one page. `said` and `loaded` are what its console said and what it asked for."""

    def __init__(self, folder: Path):
        from websockets.sync.client import connect

        command = [CHROMIUM, *FLAGS, f"--user-data-dir={folder}", "about:blank"]
        self.process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        self.said, self.loaded, self._number = [], [], 0
        port = int(self._until(lambda: self._port(folder)))
        with urllib.request.urlopen(f"http://127.0.0.1:{port}/json/list") as answer:
            page = next(one for one in json.load(answer) if one["type"] == "page")
        # Without pings: their thread draws from `random`, which a property test in this process would see.
        self.socket = connect(page["webSocketDebuggerUrl"], max_size=None, ping_interval=None)
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **params):
        """Send a command; return its answer."""
        self._number += 1
        self.socket.send(json.dumps({"id": self._number, "method": method, "params": params}))
        while True:
            message = json.loads(self.socket.recv(timeout=30))
            if message.get("id") == self._number:
                assert "error" not in message, message
                return message["result"]
            self._note(message)

    def _note(self, message) -> None:
        """Keep what goes wrong in the page, and what it loads."""
        kind, about = message["method"], message.get("params", {})
        if kind == "Runtime.exceptionThrown":
            self.said.append(about["exceptionDetails"].get("exception", {}).get("description"))
        elif kind == "Runtime.consoleAPICalled" and about["type"] in ("error", "warning"):
            self.said.append(str(about["args"]))
        elif kind == "Log.entryAdded" and about["entry"]["level"] in ("error", "warning"):
            self.said.append(about["entry"]["text"])
        elif kind == "Network.requestWillBeSent":
            self.loaded.append(about["request"]["url"])

    def open(self, url: str) -> None:
        """Go to an address."""
        self.said.clear()
        self.loaded.clear()
        self.call("Page.navigate", url=url)

    def run(self, script: str):
        """Return the value of a JavaScript expression in the page."""
        answer = self.call(
            "Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True
        )
        assert "exceptionDetails" not in answer, answer
        return answer["result"].get("value")

    def wait_for(self, script: str):
        """Wait until a JavaScript expression is true."""
        return self._until(lambda: self.run(script))

    def _until(self, look):
        end = time.monotonic() + WAIT
        while time.monotonic() < end:
            if found := look():
                return found
            time.sleep(0.05)
        raise TimeoutError(f"the browser did not get there within {WAIT} s")

    @staticmethod
    def _port(folder: Path) -> str:
        note = folder / "DevToolsActivePort"
        return note.read_text().split("\n")[0] if note.exists() else ""

    def close(self) -> None:
        """End it."""
        self.call("Browser.close")
        self.socket.close()
        self.process.wait(timeout=20)
