"""Persistent contact: the active set, the contact step, slip, stick and rest."""
