"""Crowds: a large island takes a time-stepping step (Moreau), with all its contacts in one problem."""
