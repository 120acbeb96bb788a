"""Files: saved runs and checkpoints, models in MJCF and URDF."""
