"""``carom view``: show a result in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def run(
    file: Annotated[
        Path,
        typer.Argument(
            metavar="FILE", exists=True, dir_okay=False, help="Result file.", show_default=False
        ),
    ],
    export: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", show_default=False,
            help="Write a file that shows the motion without a server, and stop: a page (.html), glTF "
            "(.glb), or VTK for ParaView (.pvd).",
        ),
    ] = None,
    port: Annotated[
        int | None, typer.Option(min=1, max=65535, show_default="a free one", help="Port of the server.")
    ] = None,
    open: Annotated[bool, typer.Option(help="Open a browser window.")] = True,
) -> int:  # fmt: skip
    """Show a result in the browser, in three dimensions.

    Runs until Ctrl-C. On a machine without a screen use --export, or --no-open with a forwarded port.

    For example:
      carom view die.h5
      carom view die.h5 --export die.html
      carom view die.h5 --export die.glb
      carom view die.h5 --no-open --port 8080
    """
    from carom import Solution
    from carom import view as look

    if export is not None and export.suffix.lower() in (".glb", ".pvd"):
        print(Solution.load(file).export(export))
        return 0
    written = look(file, port=port, open=open and export is None, export=export)
    if export is not None:
        print(written)
    return 0
