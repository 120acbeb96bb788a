"""What differs between the kinds of contacts: a file each, composed by number to the operations of a contact.

The file of a kind has a function of the name of each operation in `carom.contact.operations` (there with what
it returns) that is not the common one. A new kind is a file here, its name in `carom.model.contact_kinds`, and
the part of a scene that makes such rows.

Other files serve several kinds: `half_space` and `partner` (the other side), `found_points`, `drift`, `parting`
(two solids), `rim`, `level_surfaces`, `curvature`.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Any

from carom._compiled.by_number import by_number
from carom.model.contact_kinds import KINDS

_FILES = [import_module(f"{__name__}.{name}") for name in KINDS]


def by_kind(contact: str) -> Callable[[Callable], Any]:
    """Decorate the common form of an operation; the result calls the own form of a kind where it has one.

    `contact` is the contact in terms of the parameters of the operation.
    """

    def operation(common: Callable) -> Any:
        own = [getattr(file, common.__name__, None) for file in _FILES]
        return by_number(f"{contact}.kind", common, own)

    return operation
