"""Find the constants that functions newly return, such as codes of errors."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.sources.statements.code import Code, Part

_RETURN = re.compile(r"[\s\d]*return (?P<code>(?:\w+\s?(?:::|\.)\s?)*[A-Z][A-Z0-9_]{2,})\s?;?")


class ReturnedCode(NamedTuple):
    """A constant that a function newly returns.

    Attributes:
        sentence: the function and the constant.
        line: the line of the statement in the new version.
    """

    sentence: Phrase
    line: int


def find_returned_codes(old: Code, new: Code) -> Iterator[ReturnedCode]:
    """Yield the constants that functions of both versions newly return.

    Functions that no longer return another constant are left out, because the constant may only have another name.
    """
    for name, parts in new.functions.items():
        if name not in old.functions:
            continue
        before, after = _read_codes(old.functions[name]), _read_codes(parts)
        words = {word for part in old.functions[name] for word in re.findall(r"\w+", part.text)}
        if not before.keys() <= after.keys():
            continue
        for short, (code, line) in after.items():
            if short not in words:
                yield ReturnedCode(phrase("'{name}()' returns {code} now", name=name, code=code), line)


def _read_codes(parts: Sequence[Part]) -> dict[str, tuple[str, int]]:
    """Return the constants that a function returns, each with its first line, by name without namespaces."""
    codes: dict[str, tuple[str, int]] = {}
    for part in parts:
        match = _RETURN.fullmatch(part.text)
        if match is not None:
            code = "".join(match["code"].split())
            codes.setdefault(re.split(r"::|\.", code)[-1], (code, part.first_line))
    return codes
