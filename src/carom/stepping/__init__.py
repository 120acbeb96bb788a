"""Time stepping: the time loop, the step of an island from event to event, and the step of a crowd."""
