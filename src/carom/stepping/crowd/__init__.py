"""Heaps: a large island takes its step whole, all its contacts in one problem (Moreau's time-stepping)."""
