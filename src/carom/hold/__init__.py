"""Contacts that persist: when a contact is held, how it slips, sticks, rests and opens."""
