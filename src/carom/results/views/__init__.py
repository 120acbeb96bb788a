"""Results of one part: a view keeps nothing, it reads the arrays of a solution or of a state."""
