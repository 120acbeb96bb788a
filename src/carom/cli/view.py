"""``carom view``: look at a result in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def run(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE", exists=True, dir_okay=False, help="A result file.", show_default=False
        ),
    ],
    export: Annotated[
        Path | None,
        typer.Option(
            metavar="PAGE.html", show_default=False,
            help="Write one page that shows the motion without a server, and end.",
        ),
    ] = None,
    port: Annotated[
        int | None, typer.Option(min=1, max=65535, show_default="a free one", help="Of the server.")
    ] = None,
    open: Annotated[bool, typer.Option(help="Open a window of the browser.")] = True,
) -> int:  # fmt: skip
    """Look at a result in the browser, in three dimensions.

    Runs until Ctrl-C. On a machine without a screen take --export, or --no-open and a port that is
    forwarded.

    For example:
      carom view die.h5
      carom view die.h5 --export die.html
      carom view die.h5 --no-open --port 8080
    """
    from carom import view as look

    written = look(file, port=port, open=open and export is None, export=export)
    if export is not None:
        print(written)
    return 0
