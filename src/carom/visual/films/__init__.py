"""Films and still pictures of a motion; needs ``carom[film]``."""

from __future__ import annotations

from carom.visual.films.film import film
from carom.visual.films.stage import still

__all__ = ["film", "still"]


def __dir__() -> list[str]:
    return __all__
