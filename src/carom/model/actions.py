"""What the loop is to do with a closed point."""

NOTHING, STRIKE, HOLD, SETTLE = range(4)
