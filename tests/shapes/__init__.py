"""Tests of shapes of all kinds in motion."""
