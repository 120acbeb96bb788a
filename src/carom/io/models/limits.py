"""Limits of the size of a model, which are checked before MuJoCo reads it.

MuJoCo follows a model without limits: it copies bodies two million times, or allocates height fields of ten
billion values, until the memory of the machine is used up.
"""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from contextlib import suppress
from pathlib import Path

ELEMENTS = 20_000  # of XML, copies counted: MuJoCo's memory grows with the square of the freedoms
CELLS = 2**26  # of one height field, texture or grid
GREATEST = 1e30  # of a number: volumes, and moments with their squares, of what is larger overflow
COUNTS = (("nrow", "ncol"), ("width", "height"), ("size",), ("dim",), ("nsample",))
COPIES = ("replicate", "composite", "flexcomp")  # what is in them is made `count` times
#: sizes of what carom has no use for; MuJoCo finds those that it needs itself
UNUSED = {
    "memory": -1, "njmax": -1, "nconmax": -1, "nstack": -1, "nkey": 0, "nuserdata": 0,
    **{f"nuser_{what}": -1 for what in ("body", "jnt", "geom", "site", "cam", "tendon", "actuator", "sensor")},
}  # fmt: skip
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
#: attributes that may be the word "nan"
NAMING = ("name", "class", "childclass", "key", "value", "file")


def check_model(root: ET.Element, what: str, folder: Path | None) -> None:
    """Refuse a model, with all files that it includes, that is too large.

    Raises
    ------
    ValueError
        With the element, and the limit.
    """
    total, copies = 0, [(root, 1)]
    seen: set[Path] = set()
    names = {element.get("name") for element in root.iter()}
    while copies:
        element, times = copies.pop()
        total += times
        if total > ELEMENTS:
            raise _too_many(what)
        _check_element(element, what, names)
        if element.tag in COPIES:
            times *= round(math.prod(max(1.0, n) for n in _numbers(element.get("count", "1"))))
        if total + times > ELEMENTS:
            raise _too_many(what)
        if element.tag == "include" and folder is not None:
            file = folder / element.get("file", "")
            if file.is_file() and file not in seen:  # MuJoCo refuses a file that is included twice
                seen.add(file)
                copies.append((parsed(file.read_bytes(), file.name), times))
        copies += [(child, times) for child in element]


def _too_many(what: str) -> ValueError:
    return ValueError(
        f"{what} must have {ELEMENTS} elements at most, including copies; it has more"
    )


def parsed(data: bytes | str, what: str) -> ET.Element:
    """Return the root of an XML text, in any encoding that it declares.

    Raises
    ------
    ValueError
        If it cannot be read, or defines entities.
    """
    plain = data.encode("utf-8", "replace") if isinstance(data, str) else data.replace(b"\0", b"")
    if b"<!ENTITY" in plain:
        raise ValueError(f"{what} must not define entities (<!ENTITY ...>)")
    try:
        return ET.fromstring(data.lstrip())  # some have empty lines first
    except (ET.ParseError, ValueError, LookupError) as error:
        line = " ".join(str(error).split())
        raise ValueError(f"{what} is not valid XML: {line}") from None


def drop_sizes(spec) -> None:
    """Set the sizes of memory that carom does not use to their defaults."""
    for name, value in UNUSED.items():
        if hasattr(spec, name):
            setattr(spec, name, value)


def _check_element(element: ET.Element, what: str, names) -> None:
    where = f"{what}: <{element.tag}>"
    for name, value in element.attrib.items():
        if _has_nan(value) and name not in NAMING and value not in names:
            raise ValueError(f"{where} {name} must not be NaN, got {value[:60]!r}")
        if len(value) > 1_000_000 or name == "name":  # of a mesh: MuJoCo reads it quickly
            continue
        for number in _numbers(value):
            if not abs(number) <= GREATEST:
                raise ValueError(f"{where} {name} must be at most {GREATEST:g}, got {value[:60]!r}")
    for names in COUNTS:
        if element.tag == "geom" or not all(name in element.attrib for name in names):
            continue
        cells = math.prod(max(1.0, n) for name in names for n in _numbers(element.attrib[name]))
        if cells > CELLS:
            raise ValueError(f"{where} {' x '.join(names)} must be at most {CELLS}, got {cells:g}")


def _has_nan(text: str) -> bool:
    """Return whether an attribute has numbers, and one of them is NaN."""
    with suppress(ValueError):
        return "nan" in text.lower() and any(math.isnan(float(word)) for word in text.split())
    return False


def _numbers(text: str) -> list[float]:
    """Return the numbers in an attribute, 1 where there are none."""
    found = [float(word) for word in text.split() if _NUMBER.fullmatch(word)]
    return found or [1.0]
