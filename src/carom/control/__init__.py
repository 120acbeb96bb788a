"""Stopping a run at events, and taking one on step by step."""
