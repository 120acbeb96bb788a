"""The text that `print(scene)` shows."""

from __future__ import annotations

KINDS = (
    "bodies",
    "half_spaces",
    "statics",
    "contacts",
    "joints",
    "constraints",
    "stops",
    "forces",
    "switches",
)
ONE = {
    "bodies": "body",
    "half_spaces": "half-space",
    "statics": "static body",
    "switches": "switch",
}
MANY = {"statics": "static bodies"}


def counts(scene) -> str:
    """Return the number of parts of each kind, in one line."""
    rare = ("statics", "constraints", "stops", "switches")
    shown = [kind for kind in KINDS if kind not in rare or getattr(scene, kind)]
    return ", ".join(_count(kind, len(getattr(scene, kind))) for kind in shown)


def summary(scene) -> str:
    """Return one line for each part, grouped by kind."""
    lines = [f"Scene with gravity {scene.gravity} m/s^2"]
    for kind in KINDS:
        parts = getattr(scene, kind)
        if parts:
            lines += [f"{_count(kind, len(parts))}:", *(f"  {part!r}" for part in parts)]
    return "\n".join(lines)


def _count(kind: str, n: int) -> str:
    one = ONE.get(kind, kind.removesuffix("s"))
    return f"{n} {one if n == 1 else MANY.get(kind, kind.replace('_', '-'))}"
