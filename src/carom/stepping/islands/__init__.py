"""Islands of a step: sets of bodies that cannot meet others in it, each moved on a clock of its own."""
