"""Multiple impact (at a corner of the manifold): several contacts are closed, and one or more strike."""
