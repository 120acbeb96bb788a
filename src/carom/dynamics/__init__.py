"""Forces, joints, the constrained solve with its back ends, and the methods, one a file."""
