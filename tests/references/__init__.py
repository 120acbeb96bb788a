"""Independent computations that tests compare with: scipy and closed forms, nothing of carom."""
