"""Inertia along a coordinate as a row with a compliance, J a + lam/I = -d (`carom.dynamics.rotors`)."""

from __future__ import annotations

from carom.dynamics.elements import relation

write_rows, acceleration_bias = relation.write_rows, relation.acceleration_bias
