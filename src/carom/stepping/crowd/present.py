"""The contact problem of a crowd with arrays of the present size."""

from __future__ import annotations

from carom._compiled.decorators import kernel
from carom.friction.layout import ContactWork


@kernel
def of_present_size(crowd, n):
    """Return the problem with arrays cut to the present numbers of bodies and blocks."""
    work, pairs, updates = crowd.problem, crowd.graph.count[3], crowd.graph.count[2]
    return ContactWork(
        kind=work.kind, contact=work.contact, vector=work.vector, count=work.count, mismatch=work.mismatch,
        W=work.W, matrix=work.matrix, pivot=work.pivot, active=work.active, link=work.link, path=work.path,
        other=work.other, body=work.body[:n], place=work.place[:n], later=work.later[:pairs],
        target=work.target[:updates], block=work.block[: n + 2 * pairs],
    )  # fmt: skip
