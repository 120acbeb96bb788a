"""Islands of a step: sets of bodies that cannot meet other bodies in it; each moves with its own clock."""
