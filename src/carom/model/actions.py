"""Actions of the loop on a closed point."""

NOTHING, STRIKE, PERSIST = range(3)
