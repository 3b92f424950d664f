"""Find the ranges of parameters that C++ sources declare with a description."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from linkwright.review.sources.names import Detail

_IDENTIFIER = re.compile(r"[A-Za-z_]\w*")
_RANGE = r"(?:floating_point|integer)_range"
_ELEMENT = rf"{_RANGE}\s*(?:\[\s*0\s*\]|\.\s*(?:at\s*\(\s*0\s*\)|front\s*\(\s*\)|back\s*\(\s*\)))"
_VALUE = r"([^;{}()]+)"
_FLOAT = re.compile(r"(-?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)f")
_SETTERS = r"(?:\s*(?:\.|->)\s*set__\w+\s*\([^()]*\))*"
_LIMITS = ((Detail.MINIMUM, "from_value"), (Detail.MAXIMUM, "to_value"))


def find_range(text: str, position: int, arguments: Sequence[str]) -> Iterator[tuple[Detail, str]]:
    """Yield the limits of a parameter whose declaration gets a description, as they are written.

    Args:
        text: the source without comments.
        position: the offset of the call that declares it.
        arguments: the arguments behind the name.
    """
    descriptor = arguments[1] if len(arguments) > 1 else ""
    code = text[text.rfind("\n}", 0, position) + 1 : position]
    if not _IDENTIFIER.fullmatch(descriptor) or "_range" not in code:
        return
    given = re.compile(
        rf"\b{descriptor}\s*\.\s*{_RANGE}\s*(?:=\s*\{{|\.\s*(?:push_back|emplace_back)\s*\(|\[\s*0\s*\]\s*=)\s*(?P<range>\w+)\s*[;)}}]"
    )
    ranges = [match["range"] for match in given.finditer(code)][-1:]
    owner = "|".join([rf"\b{descriptor}\s*\.\s*{_ELEMENT}", *(rf"\b{name}" for name in ranges)])
    for detail, field in _LIMITS:
        setter = rf"{field}\s*=\s*{_VALUE}\s*;|set__{field}\s*\(\s*{_VALUE}\s*\)"
        limit = re.compile(rf"(?:{owner}){_SETTERS}\s*(?:\.|->)\s*(?:{setter})")
        found = [(match[1] or match[2]).strip() for match in limit.finditer(code)]
        if found:
            yield detail, _FLOAT.sub(r"\1", found[-1])
