"""Forces, joints, the constrained solve with its back ends, and the methods, one file for each."""
