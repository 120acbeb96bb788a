"""The paper, reproduced: its figures, its numbers, and impacts of a real cube (``carom paper``)."""
