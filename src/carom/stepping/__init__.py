"""Time stepping: the event step, islands in time, the step of a crowd, and the run to its end."""
