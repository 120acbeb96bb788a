"""`carom.view`: show a run in a browser."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from carom import arguments, checks
from carom.visual.viewer.frames import MOST_FRAMES

if TYPE_CHECKING:
    from carom.results.solution import Solution
    from carom.visual.viewer.live import LiveView
    from carom.visual.viewer.page import Exported


@arguments.known
def view(
    solution: Solution | str | os.PathLike,
    *,
    export: str | os.PathLike | None = None,
    title: str | None = None,
    follow: str | None = None,
    speed: float | None = None,
    frames: int = MOST_FRAMES,
    port: int | None = None,
    host: str = "127.0.0.1",
    open: bool = True,
    block: bool = True,
) -> Exported | LiveView | None:
    """Show a run in a browser, or write it as an HTML page.

    The motion can be played, stopped and moved to any time. Arrows show impulses of impacts and forces of
    persistent contacts. Beside the motion are the energy, the list of impacts, and the course of an impact in
    its boundary layer.

    Parameters
    ----------
    solution : Solution or path
        A run of a `Scene`, or the path of its file (``carom[files]``).
    export : path, optional
        Write one HTML file that plays the run without Python and without a network, and return. This needs no
        extra package. Default None: show the run in the browser (``carom[view]``).
    title : str, optional
        Title of the page. Default: the name of the file, or "carom".
    follow : str, optional
        Name of the body that the camera follows at first. Default: none.
    speed : float, optional
        Seconds of the run per second, above 0. Default: 1, or less if the run is shorter than 5 s.
    frames : int
        Maximum number of frames, at least 2. Saved times are thinned out to this number, and times of impacts
        are added. Default 5000; fewer with many bodies (3 million numbers in all).
    port : int, optional
        Port of the server. Default: a free one.
    host : str
        Address of the server. Default ``"127.0.0.1"``: only for this machine. ``"0.0.0.0"``: also for other
        machines.
    open : bool
        True (default): open the browser.
    block : bool
        True (default): return when Ctrl-C is pressed. False: return the viewer at once; stop it with ``stop()``
        or use it in a ``with`` statement.

    Returns
    -------
    Exported, LiveView or None
        With `export`, the path, the size in bytes and a note on data that were left out; with ``block=False``
        the viewer.

    Raises
    ------
    ImportError
        If viser is needed and missing.
    TypeError
        If the run is of a `GeneralizedSystem`, because its coordinates do not give the positions of bodies.
    ValueError
        If an argument is outside its range, or the file is not a file of a run.

    Examples
    --------
    >>> carom.view(solution, export="run.html")  # doctest: +SKIP
    """
    from carom.visual.viewer.show import body_number, show_of

    if speed is not None:
        speed = checks.scale("speed", speed)
    if title is not None:
        checks.text("title", title)
    if port is not None:
        port = checks.integer("port", port, least=1, most=65535)
    checks.text("host", host)
    checks.flag("open", open)
    checks.flag("block", block)
    if export is not None:
        from carom.visual.viewer.page import write_page

        show = show_of(solution, title, frames)
        return write_page(show, export, follow, speed)
    from carom.visual.viewer.live import LiveView, need_viser

    need_viser()
    show = show_of(solution, title, frames)
    live = LiveView(show, body_number(show, follow), speed, host, port)
    if open:
        live.open()
    if not block:
        return live
    live.wait()
    return None
