"""Tests of bodies that are held at several points."""
