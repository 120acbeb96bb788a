"""`LiveView`: a run in the browser, served by this process; needs viser."""

from __future__ import annotations

import io
import socket
import threading
import time
import webbrowser
from contextlib import redirect_stdout
from typing import Self

import numpy as np

from carom import checks
from carom.visual.viewer.frames import poses_at
from carom.visual.viewer.guard import guarded
from carom.visual.viewer.show import Show, body_number, playing_speed

RATE = 30.0  # pictures a second
SAID = 0.1  # interval between updates of slider and energies during play [s]
FADE = 0.35  # time for which an impact is shown [s of real time]


def need_viser() -> None:
    """Raise an error with the command that installs viser, if it is missing."""
    what = 'a live view (not a page: carom.view(solution, export="run.html"))'
    checks.need("viser", what, "view")


class LiveView:
    """A run that is shown in a browser. `carom.view` makes it with ``block=False``; use it with ``with``.

    Attributes
    ----------
    time : float
        Time of the shown state [s].
    playing : bool
        Whether the motion is playing.
    speed : float
        Seconds of the run per second.
    server : viser.ViserServer
        The server; you can add your own objects to its scene.
    """

    def __init__(self, show: Show, follow: int, speed: float | None, host: str, port: int | None):
        import viser

        from carom.visual.viewer.live_panel import LivePanel
        from carom.visual.viewer.live_scene import LiveScene

        self.show, self.host = show, host
        self.start, self.end = float(show.frames.time[0]), float(show.frames.time[-1])
        self.time, self.playing, self.chosen = self.start, False, -1
        self.speed = speed or playing_speed(self.end - self.start)
        self._followed, self._change = follow, threading.RLock()
        self._stopped, self._marked = threading.Event(), 0.0
        # hide the banner of viser; `wait` prints the address
        with redirect_stdout(io.StringIO()), guarded(host) as used:
            self.server = viser.ViserServer(
                host, port or free_port(host), label=show.title, verbose=False
            )
            if not used:
                self.server.stop()
                raise RuntimeError("a live view needs a version of viser that serves by websockets")
        self.stage = LiveScene(self.server, show)
        self.panel = LivePanel(self.server, show, self)
        if len(show.strikes.number):
            self.stage.marks.on_click(self._clicked)
        if follow >= 0:
            self.panel.follow.value = show.solution.scene.bodies[follow].name
        self.seek(self.start)
        self._player = threading.Thread(target=self._run, name="carom view", daemon=True)
        self._player.start()

    @property
    def url(self) -> str:
        """Address of the viewer for the browser."""
        host = "localhost" if self.host in ("0.0.0.0", "127.0.0.1", "") else self.host
        return f"http://{host}:{self.server.get_port()}"

    def seek(self, t: float) -> None:
        """Show the state at time `t` [s]; times outside the run are moved into it."""
        with self._change, self.server.atomic():
            before = self._place_followed()
            self.time = min(max(float(t), self.start), self.end)
            self.stage.move(self.time, FADE * self.speed)
            if not self.playing or time.monotonic() - self._marked > SAID:
                self._marked = time.monotonic()
                self.panel.show_time(self.time)
            self._move_eyes(before)

    def play(self, on: bool = True) -> None:
        """Play from the present time, or from the start if it is at the end; with False pause."""
        with self._change:
            if on and self.time >= self.end:
                self.seek(self.start)
            self.playing = bool(on)
            if on:
                self.stage.see_through(self.panel.through.value)
            self.panel.play.label = "Pause" if on else "Play"
            self.panel.show_time(self.time)

    def choose(self, k: int) -> None:
        """Stop at impact `k` of the list and show its course in the boundary layer; -1 for none."""
        with self._change:
            self.chosen = k
            self.panel.show_impact(k)
            self.stage.see_through(k >= 0 or self.panel.through.value)
            if k >= 0:
                self.play(False)
                self.seek(float(self.show.solution.impacts.time[self.show.strikes.number[k]]))
            else:
                self.seek(self.time)

    def next_impact(self, step: int = 1) -> None:
        """Choose the impact after the chosen one (or after the shown time); with -1 the impact before."""
        times = self.show.solution.impacts.time[self.show.strikes.number]
        if self.chosen >= 0:
            k = self.chosen + step
        else:
            k = int(np.searchsorted(times, self.time)) - (step < 0)
        if 0 <= k < len(times):
            self.choose(k)

    def follow(self, name: str | None) -> None:
        """Let the camera follow the body with this name; None: no body."""
        self._followed = body_number(self.show, name)
        place = self._place_followed()
        if place is not None:
            for client in self.server.get_clients().values():
                client.camera.look_at = place

    def show_arrows(self, on: bool, length: float | None = None) -> None:
        """Show or hide arrows; `length` is a factor of their initial lengths."""
        self.stage.arrows_on = on
        self.stage.length = length or self.stage.length
        self.seek(self.time)

    def open(self) -> None:
        """Open the browser."""
        webbrowser.open(self.url)

    def wait(self) -> None:
        """Print the address, and return when Ctrl-C is pressed."""
        try:
            print(f"{self.show.title}: {self.url} (Ctrl-C ends it)", flush=True)
            while not self._stopped.wait(0.5):
                pass
        except KeyboardInterrupt:
            pass
        finally:
            self.stop()

    def stop(self) -> None:
        """Stop the server; the page in the browser does not change any more."""
        if self._stopped.is_set():
            return
        self._stopped.set()
        self._player.join()
        with redirect_stdout(io.StringIO()):
            self.server.stop()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_) -> None:
        self.stop()

    def __repr__(self) -> str:
        ended = ", ended" if self._stopped.is_set() else ""
        return f"<LiveView of {self.show.title!r} at {self.url}, t = {self.time:g} s{ended}>"

    def _run(self) -> None:
        """Advance the shown time during play."""
        last = time.monotonic()
        while not self._stopped.wait(1.0 / RATE):
            now = time.monotonic()
            if self.playing:
                self.seek(self.time + self.speed * min(now - last, 0.1))
                if self.time >= self.end:
                    self.play(False)
            last = now

    def _place_followed(self) -> np.ndarray | None:
        """Return where the followed body is (3,) [m]; None if there is none."""
        if self._followed < 0:
            return None
        return poses_at(self.show.frames, self.time)[0][self._followed]

    def _move_eyes(self, before: np.ndarray | None) -> None:
        """Move the cameras of all clients by the displacement of the followed body."""
        after = self._place_followed()
        if before is None or after is None or np.array_equal(before, after):
            return
        for client in self.server.get_clients().values():
            client.camera.position = client.camera.position + after - before

    def _clicked(self, event) -> None:
        self.choose(self.stage.nearest_impact(event.ray_origin, event.ray_direction))


def free_port(host: str) -> int:
    """Return a free port."""
    with socket.socket() as probe:
        probe.bind((host, 0))
        return probe.getsockname()[1]
