"""The free phase: forces, joints, the constrained solve with its back ends, the methods."""
