"""The laws of contacts, stops, joints and coordinates: friction by the slip, restitution by the approach.

Who has a law carries its number in one table (`carom.model.laws`), and finds its value at a speed here.
"""
