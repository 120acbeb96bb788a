"""The contact problem of many contacts: w = W p + c with Coulomb's friction cones."""

from carom.friction.api import ContactSolution, solve_contacts

__all__ = ["ContactSolution", "solve_contacts"]
