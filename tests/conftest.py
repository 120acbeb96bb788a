"""For all tests: what is compiled on the way is not spoken of, as tests look at what is on stderr."""

from carom._compiled import notice

notice.silence()
