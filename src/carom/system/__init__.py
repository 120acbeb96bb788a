"""The scene compiled into flat arrays."""
