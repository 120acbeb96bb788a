"""The mark of carom: a ball comes into the letter c, strikes it, and leaves with 3/4 of its normal speed.

Run ``python docs/pictures/logo.py`` to make ``docs/_static/logo.svg``.
"""

from __future__ import annotations

import math
from pathlib import Path

OUT = Path(__file__).parents[1] / "_static" / "logo.svg"
#: read on white and on black
LETTER, BALL, PATH = "#2B8CC4", "#E69F00", "#8D99A4"
MIDDLE, OUTER, WIDTH = 32.0, 24.0, 8.0  # of the letter: its middle, radius and stroke
OPEN = math.radians(64.0)  # half of its opening
RADIUS, SLOPE = 7.5, 0.36  # of the ball, and of its way in, as it comes from above
BEGINS, ENDS = 57.0, 54.5  # where its way begins, and where it is
RESTITUTION = 0.75


def path() -> list[tuple[float, float]]:
    """Return the corners of the path of the centre: straight, and without friction."""
    struck = MIDDLE - (OUTER - WIDTH / 2 - RADIUS)
    out = SLOPE / RESTITUTION  # the speed along the surface stays, that across it is less
    return [
        (BEGINS, MIDDLE - SLOPE * (BEGINS - struck)),
        (struck, MIDDLE),
        (ENDS, MIDDLE + out * (ENDS - struck)),
    ]


def svg() -> str:
    """Return the mark as SVG."""
    corners = path()
    line = " ".join(f"{x:.2f},{y:.2f}" for x, y in corners)
    x, y = corners[-1]
    end, high = MIDDLE + OUTER * math.cos(OPEN), OUTER * math.sin(OPEN)
    letter = (
        f"M{end:.2f},{MIDDLE - high:.2f} A{OUTER:g},{OUTER:g} 0 1 0 {end:.2f},{MIDDLE + high:.2f}"
    )
    stroke = 'fill="none" stroke-linecap="round" stroke-linejoin="round"'
    return f"""<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 64 64" role="img" aria-label="carom">
  <polyline points="{line}" {stroke} stroke="{PATH}" stroke-width="3"/>
  <path d="{letter}" {stroke} stroke="{LETTER}" stroke-width="{WIDTH:g}"/>
  <circle cx="{x:.2f}" cy="{y:.2f}" r="{RADIUS:g}" fill="{BALL}"/>
</svg>
"""


if __name__ == "__main__":
    OUT.write_text(svg(), encoding="utf-8")
