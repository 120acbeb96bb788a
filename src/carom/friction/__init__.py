"""Many contacts at once: w = W p + c, with Coulomb's cones."""

from carom.friction.api import ContactSolution, solve_contacts

__all__ = ["ContactSolution", "solve_contacts"]
