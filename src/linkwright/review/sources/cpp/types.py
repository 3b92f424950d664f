"""Compare types of C++ as callers see them, not as they are written."""

from __future__ import annotations

import re

_ARITHMETIC = ("bool", "char", "short", "int", "long", "long long", "float", "double", "long double")
"""The arithmetic types, each of which takes all values of the previous ones, or nearly so."""
_INTEGERS = re.compile(r"(?:unsigned )?(?:char|short|int|long|long long)|(?:std::)?(?:u?int(?:8|16|32|64)_t|size_t)")
"""The integer types. A call with a value of one also builds with another, and with a floating-point type."""
_REAL_NUMBERS = ("float", "double", "long double")
_KINDS = re.compile(r"\b(?:struct|class|enum|typename)\s+(?=\w)")
_EAST_CONST = re.compile(r"^(?P<type>[\w:]+(?:<.*>)?)\s+const\b")
_INNER_EAST_CONST = re.compile(r"(?<=[<,(])([\w:]+) const(?=[>,*&)])")
_ARRAY = re.compile(r"\s*\[\w*\]$")
_INTEGER = re.compile(r"\b(?:(?:unsigned|signed|short|long|int)\b\s*)+")
_SHARED = re.compile(r"(?P<pointer>(?:std::|boost::)?shared_ptr)<(?P<const>const )?(?P<type>[^<>]*)>")
_SPECIFIERS = re.compile(r"\b(?:static|constexpr|inline|mutable|volatile)\b\s*")
_REFERENCE = re.compile(r"const (?P<type>[^&*]+)&")


def normalize_type(text: str) -> str:
    """Return a type of a parameter or result in one notation.

    ``const`` stands first and is left out for values, which it does not concern; an array is a pointer.
    """
    text = _KINDS.sub("", " ".join(text.split()))
    text = re.sub(r"\s*([*&<>,:()])\s*", r"\1", text)
    text = re.sub(r"(?<=[*&>])const\b", " const", text)
    text = _INTEGER.sub(lambda match: _normalize_integer(match[0]), text)
    text = _INNER_EAST_CONST.sub(r"const \1", text)
    text = _EAST_CONST.sub(lambda match: f"const {match['type']}", text).strip()
    text = re.sub(r"^const const ", "const ", text)
    text = re.sub(r"\*\s*const$", "*", _ARRAY.sub("*", text))
    is_value = text.startswith("const ") and not re.search(r"[*&]$", text)
    return text.removeprefix("const ") if is_value else text


def _normalize_integer(text: str) -> str:
    words = text.split()
    size = " ".join(word for word in words if word in ("short", "long"))
    sign = "unsigned " if "unsigned" in words else ""
    return f"{sign}{size or 'int'}" + (" " if text.endswith(" ") else "")


def is_same_type(old: str, new: str) -> bool:
    """Return whether two normalized types are equal, though only one may have the namespace of a class."""
    if old == new:
        return True
    parts = [re.split(r"((?:\w+::)*\w+)", text) for text in (old, new)]
    return len(parts[0]) == len(parts[1]) and all(
        one == other or one.endswith(f"::{other}") or other.endswith(f"::{one}")
        for one, other in zip(*parts, strict=True)
    )


def accepts_type(old: str, new: str) -> bool:
    """Return whether a parameter of a new type accepts all arguments for the old type. Both types are normalized."""
    if is_same_type(old, new):
        return True
    values = [match["type"] if (match := _REFERENCE.fullmatch(text)) else text for text in (old, new)]
    if is_same_type(*values) or (old in _ARITHMETIC and new in _ARITHMETIC[_ARITHMETIC.index(old) :]):
        return True
    if _INTEGERS.fullmatch(values[0]) and (_INTEGERS.fullmatch(values[1]) or values[1] in _REAL_NUMBERS):
        return True
    if re.search(r"[*&]$", old) and old[-1] == new[-1:] and not old.startswith("const ") and not old.endswith("&&"):
        return is_same_type(f"const {old}", new)
    pointers = [_SHARED.fullmatch(value) for value in values]
    if pointers[0] is None or pointers[1] is None or pointers[0]["const"]:
        return False
    return bool(pointers[1]["const"]) and is_same_type(pointers[0]["type"], pointers[1]["type"])


def can_use_result(old: str, new: str) -> bool:
    """Return whether code that uses a result of an old type builds with a new type. Both types are normalized."""
    is_number = old in _ARITHMETIC and new in _ARITHMETIC
    return is_number or old == "void" or accepts_type(new, old)


def is_convertible(old: str, new: str) -> bool:
    """Return whether code that reads and sets a member of an old type may build with a new type.

    It may if one of the types is deduced, as with ``auto``.
    """
    types = [normalize_type(_SPECIFIERS.sub("", text)) for text in (old, new)]
    is_deduced = any(re.search(r"\b(?:auto|decltype)\b", text) for text in types)
    return is_deduced or (can_use_result(types[0], types[1]) and can_use_result(types[1], types[0]))
