"""Actions of the loop on a closed point."""

NOTHING, STRIKE, PERSIST, RENEW_MODE = range(4)
