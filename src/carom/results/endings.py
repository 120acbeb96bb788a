"""How a run ended, in sentences: what decided it, when and where, and what to change."""

from __future__ import annotations

from carom.status import Status


def message(
    status: Status, reason: str, finer: str, reached: float, warnings: tuple[str, ...] = ()
) -> str:
    """Return the message of a run that ended with `status` at the time `reached`.

    `reason` is what is known about its failure beyond the status, `finer` how it gets shorter steps, and the
    first of its `warnings` the reason why it is inaccurate.
    """
    if status.ended:
        return " ".join((status.message, *(warnings[:1] if status is Status.INACCURATE else ())))
    said = status.advice(finer)
    if reason:
        said = f"{reason[0].upper()}{reason[1:]}"
        if status is Status.FUNCTION_FAILED:
            said += ". The solution has all results up to then."
    return f"{said} (reached t = {reached:.9g} s)"
