"""Actions of the loop on a closed point."""

NOTHING, STRIKE, HOLD, SETTLE = range(4)
