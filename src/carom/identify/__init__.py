"""Parameters of a scene from recorded motion."""
