"""Many contacts at once: w = W p + c with Coulomb's cones."""
