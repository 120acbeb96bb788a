"""One frictional impact: the boundary layer, slip and stick, restitution laws, the resolver."""

from carom.impact.api import Impact, resolve_impact
from carom.impact.history import LayerHistory, impact_layer

__all__ = ["Impact", "LayerHistory", "impact_layer", "resolve_impact"]
