"""``carom plot`` and ``carom film``: plots and films of a result."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from carom.cli import show
from carom.results.drawn import KINDS

_File = Annotated[
    Path,
    typer.Argument(
        metavar="FILE", exists=True, dir_okay=False, help="A result file.", show_default=False
    ),
]


def plot(
    file: _File,
    kind: Annotated[
        str | None,
        typer.Argument(
            metavar="KIND", show_default="overview",
            help=f"Kind of plot: {', '.join(KINDS)} (see Solution.plot).",
        ),
    ] = None,
    out: Annotated[
        Path,
        typer.Option("--out", "-o", metavar="PICTURE", help="Output file with the suffix .png, .pdf or .svg."),
    ] = Path("plot.png"),
    dpi: Annotated[int, typer.Option(min=20, max=2000, help="Resolution of a PNG.")] = 150,
) -> int:  # fmt: skip
    """Plot a result.

    For example:
      carom plot die.h5 -o die.png
      carom plot die.h5 energy -o energy.pdf
      carom plot die.h5 impact_inside     the first impact, inside its boundary layer
    """
    import matplotlib

    matplotlib.use("agg")
    import carom
    from carom.io.files.disk import put
    from carom.visual.plots.style import as_bytes

    drawn = carom.Solution.load(file).plot(kind or KINDS[0])
    out = out if out.suffix else out.with_suffix(".png")
    put(out, [as_bytes(_figure(drawn), out.suffix, dpi=dpi)])
    print(out)
    return 0


def _figure(drawn):
    """Return the figure of what a plot returned: axes, several of them, or some by name."""
    while not hasattr(drawn, "figure"):
        drawn = next(iter(drawn.values() if isinstance(drawn, dict) else drawn))
    return drawn.figure


def film(
    file: _File,
    out: Annotated[
        Path, typer.Option("--out", "-o", metavar="FILM", help="Output file with the suffix .mp4 or .gif.")
    ] = Path("film.mp4"),
    fps: Annotated[float, typer.Option(min=1, help="Frames per second.")] = 30.0,
    speed: Annotated[
        float, typer.Option(metavar="X", help="Speed of the film: 0.1 is ten times slower.")
    ] = 1.0,
    follow: Annotated[
        str | None, typer.Option(metavar="BODY", show_default=False, help="Keep this body in the centre.")
    ] = None,
) -> int:  # fmt: skip
    """Make a film of a result.

    For example:
      carom film die.h5 -o die.mp4
      carom film die.h5 -o slow.mp4 --speed 0.1 --follow die
    """
    import carom
    from carom import film as make

    with show.progress("film") as bar:
        solution = carom.Solution.load(file)
        make(solution, out, fps=fps, speed=speed, follow=follow, progress=bar)
    print(out)
    return 0
