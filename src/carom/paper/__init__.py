"""The paper, reproduced: its figures and its numbers (``carom paper``)."""
