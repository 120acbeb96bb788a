"""Distance of two solids and the points that carry a contact: pure functions of world poses."""
