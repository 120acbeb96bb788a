"""One frictional impact: the boundary layer, slip and stick, restitution laws, the resolver."""
