"""`carom.view`: look at a run in a browser."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from carom import checks
from carom.visual.viewer.frames import MOST

if TYPE_CHECKING:
    from carom.results.solution import Solution
    from carom.visual.viewer.live import LiveView
    from carom.visual.viewer.page import Exported


def view(
    solution: Solution | str | os.PathLike,
    *,
    export: str | os.PathLike | None = None,
    title: str | None = None,
    follow: str | None = None,
    speed: float | None = None,
    frames: int = MOST,
    port: int | None = None,
    host: str = "127.0.0.1",
    open: bool = True,
    block: bool = True,
) -> Exported | LiveView | None:
    """Look at a run: in a browser at once, or as a page to keep.

    Bodies play, stop and can be moved through by hand; arrows are impulses of impacts and forces of contacts
    that stay; beside them energy, the list of impacts, and of each impact what went on inside it.

    Parameters
    ----------
    solution : Solution or path
        A run of a `Scene`, or the file of one (``carom[files]``).
    export : path, optional
        Write one HTML file that plays by itself, without Python and without a network, and return. Nothing
        needs to be installed for it. Default None: show it in the browser from here (``carom[view]``).
    title : str, optional
        Default: the name of the file, or "carom".
    follow : str, optional
        Name of the body that the eye follows at first. Default: none.
    speed : float, optional
        Seconds of the run in a second, above 0. Default: 1, or less for a run that lasts below 5 s.
    frames : int
        Greatest number of moments, at least 2. Runs with more saved times are thinned; moments of impacts are
        added. Default 5000; fewer where there are many bodies (3 million numbers in all).
    port : int, optional
        Where the viewer is served. Default: a free one.
    host : str
        Default ``"127.0.0.1"``: for this machine only. ``"0.0.0.0"`` lets others look.
    open : bool
        Open the browser. Default True.
    block : bool
        Go on only when Ctrl-C was pressed. Default True; with False the viewer is handed back, stop it with
        ``stop()`` or use it in a ``with``.

    Returns
    -------
    Exported, LiveView or None
        With `export` its path, size in bytes and what was left out; with ``block=False`` the viewer.

    Raises
    ------
    ImportError
        Without viser, where it is needed.
    TypeError
        For a run of a `GeneralizedSystem`, whose coordinates do not say where bodies are.
    ValueError
        If an argument is outside its range, or the file is none of a run.

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
