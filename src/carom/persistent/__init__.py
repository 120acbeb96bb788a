"""Contact that persists: the active set, the contact step, slip, stick and rest."""
