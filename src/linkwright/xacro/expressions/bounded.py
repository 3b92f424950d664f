"""Limited versions of Python functions that could otherwise run for hours.

An expression is charged for each step of its work, and the clock is read between two steps. However, a single call of
a function that is written in C cannot be interrupted. Therefore, each function that can be slow for some arguments
is listed here with a limit: keys with equal hashes, searches from the right, texts stripped of many characters,
codecs, and numbers with many bits.
"""

from __future__ import annotations

import codecs
import math
import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable

from linkwright.diagnostics import phrase
from linkwright.loading.lean_typing import Any


class RefusalError(Exception):
    """Raised when an expression attempts something that expressions are not allowed to do."""


_MAX_EQUAL_HASHES = 1_000
"""The maximum number of keys with the same hash. Python compares each of them with all others."""
_MAX_COMPARISONS = 200_000_000
"""The maximum number of character comparisons in one call."""
_MAX_NUMBERS = 1_000
_QUICK_CODECS = frozenset({"utf-8", "utf-16", "utf-32", "ascii", "iso8859-1", "iso8859-15", "cp1252", "unicode-escape"})
_MAX_CODED_CHARACTERS = 10_000
"""The maximum number of characters for a codec that is not in `_QUICK_CODECS`."""
_REGEX_TIMEOUT_S = 0.5
"""The time limit of a regular expression, as for all expressions from files (decision 0020)."""

HASHING = frozenset(
    {
        *("set", "frozenset", "dict", "update", "union", "difference", "intersection", "symmetric_difference"),
        *("difference_update", "intersection_update", "issubset", "issuperset", "isdisjoint", "dotify"),
    }
)
"""Names of functions that put all items of an argument into a table."""


def checked_keys(value: Any) -> Any:
    """Return a value from which a set or dict can safely be built.

    The result is the given value or, for an iterator, a list of its items.

    Raises:
        RefusalError: if too many of the items, or of the first items of its pairs, have the same hash.
    """
    if isinstance(value, (str, bytes, dict, set, frozenset, range)) or not hasattr(value, "__iter__"):
        return value
    items = value if isinstance(value, (list, tuple)) else list(value)
    if len(items) > _MAX_EQUAL_HASHES:
        check_keys(items)
        check_keys([item[0] for item in items if isinstance(item, (list, tuple)) and item])
    return items


def check_keys(items: Collection[Any]) -> None:
    """Check that not too many different keys have the same hash.

    Raises:
        RefusalError: if more than a thousand different keys have the same hash.
    """
    for hash_value, count in Counter(map(_hash_of, items)).items():
        if (
            count > _MAX_EQUAL_HASHES
            and len({repr(item) for item in items if _hash_of(item) == hash_value}) > _MAX_EQUAL_HASHES
        ):
            raise RefusalError(
                phrase(
                    "more than {count:,} keys have the same hash",
                    count=_MAX_EQUAL_HASHES,
                )
            )


def _hash_of(item: Any) -> int:
    try:
        return hash(item)
    except TypeError:  # an unhashable item, such as a list, is refused later
        return id(item)


def _bounded_search(name: str) -> Callable[..., Any]:
    def search(text: Any, part: Any, *rest: Any) -> Any:
        if isinstance(part, (str, bytes)) and len(part) * len(text) > _MAX_COMPARISONS:
            raise RefusalError(phrase("the strings are too long for '{name}'", name=name))
        return getattr(text, name)(part, *rest)

    return search


def _rsplit(text: str, sep: str | None = None, maxsplit: int = -1) -> list[str]:
    return text.rsplit() if sep is None and maxsplit == -1 else _bounded_search("rsplit")(text, sep, maxsplit)


def _bounded_strip(name: str) -> Callable[..., Any]:
    def strip(text: str, characters: str | None = None) -> Any:
        if isinstance(characters, str):
            characters = "".join(dict.fromkeys(characters))
            if len(characters) * len(text) > _MAX_COMPARISONS:
                raise RefusalError(phrase("the strings are too long for '{name}'", name=name))
        return getattr(text, name)(characters)

    return strip


def check_codec(value: Any, encoding: str) -> None:
    """Check that a value is not too long for a codec of quadratic running time.

    Raises:
        RefusalError: if the value is too long for the codec.
        LookupError: if there is no such codec, or if the name is not ASCII, about which Python 3.15 warns.
    """
    if isinstance(encoding, str) and not encoding.isascii():
        raise LookupError(f"unknown encoding: {encoding}")
    name = codecs.lookup(encoding).name
    if name in _QUICK_CODECS or not isinstance(value, (str, bytes)):
        return
    longest = max(map(len, value.split("."))) if name == "idna" and isinstance(value, str) else len(value)
    if longest > _MAX_CODED_CHARACTERS:
        raise RefusalError(phrase("the string is too long for the encoding '{encoding}'", encoding=encoding))


def _bounded_codec(name: str) -> Callable[..., Any]:
    def code(value: Any, encoding: str = "utf-8", errors: str = "strict") -> Any:
        check_codec(value, encoding)
        return getattr(value, name)(encoding, errors)

    return code


METHODS: dict[tuple[type, str], Callable[..., Any]] = {
    **{(str, name): _bounded_search(name) for name in ("rfind", "rindex", "rpartition")},
    (str, "rsplit"): _rsplit,
    **{(str, name): _bounded_strip(name) for name in ("strip", "lstrip", "rstrip")},
    (str, "encode"): _bounded_codec("encode"),
    (bytes, "decode"): _bounded_codec("decode"),
}
"""Methods that are bounded: type and name -> the function to call instead."""


def _bounded_function(name: str) -> Callable[..., Any]:
    function = getattr(math, name)

    def guarded(*numbers: Any) -> Any:
        if len(numbers) > _MAX_NUMBERS:
            raise RefusalError(phrase("'{name}' receives more than {count:,} numbers", name=name, count=_MAX_NUMBERS))
        return function(*numbers)

    return guarded


def _sumprod(left: Iterable[Any], right: Iterable[Any]) -> Any:
    pairs = list(zip(left, right, strict=True))
    if len(pairs) > _MAX_NUMBERS and not all(isinstance(number, float) for pair in pairs for number in pair):
        raise RefusalError(phrase("'{name}' receives more than {count:,} numbers", name="sumprod", count=_MAX_NUMBERS))
    return sum(first_number * second_number for first_number, second_number in pairs)


MATHEMATICS: dict[str, Any] = {
    "gcd": _bounded_function("gcd"),
    **({"sumprod": _sumprod} if hasattr(math, "sumprod") else {}),
}
"""Functions of ``math`` that are bounded."""

# These patterns are compiled on first use, because few files need them.
_CLASS_BEGINS = r"\[\^?\]?"
_ESCAPE_OR_BRACKET = r"(?s)\\.|\]"


def split(pattern: str, text: str) -> list[str]:
    """Return the parts of a text between the matches of a character class.

    Args:
        pattern: the regular expression, which begins with ``[`` and ends with ``]``, as ros/xacro composes it. If
            another ``]`` ends the class earlier, the pattern can be any regular expression.
        text: the text to split.

    Raises:
        re.error: if the pattern is not a valid regular expression.
        RefusalError: if the split takes too long.
    """
    begins = re.match(_CLASS_BEGINS, pattern)
    element_match = re.compile(_ESCAPE_OR_BRACKET).finditer(pattern, begins.end() if begins else 0)
    ends = next((match.end() for match in element_match if match[0] == "]"), 0)
    if ends == len(pattern):
        return re.split(pattern, text)
    import regex

    re.compile(pattern)  # This call raises the same error as ros/xacro.
    try:
        return regex.split(pattern, text, timeout=_REGEX_TIMEOUT_S)
    except regex.error as error:
        raise re.error(str(error)) from None
    except TimeoutError:
        raise RefusalError(phrase("it takes too long to split the string at these characters")) from None
