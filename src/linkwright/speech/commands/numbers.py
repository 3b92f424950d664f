"""Spoken numbers in English and Chinese, such as ``one and a half`` and ``一点五``."""

from __future__ import annotations

from linkwright.speech.commands.words import Words

_ENGLISH_NUMBERS = (
    "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen"
)
_UP_TO_NINETEEN = {word: value for value, word in enumerate((_ENGLISH_NUMBERS + " eighteen nineteen").split())} | {
    "oh": 0,
    "nought": 0,
}
_TENS = {
    word: 10 * (index + 2)
    for index, word in enumerate(["twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety"])
}
_ARTICLES = ("a", "an")
_FRACTIONS: dict[Words, float] = {
    ("half",): 0.5,
    ("half", "a"): 0.5,
    ("half", "an"): 0.5,
    ("a", "half"): 0.5,
    ("one", "half"): 0.5,
    ("quarter",): 0.25,
    ("a", "quarter"): 0.25,
    ("one", "quarter"): 0.25,
    ("quarter", "of", "a"): 0.25,
    ("a", "quarter", "of", "a"): 0.25,
    ("three", "quarters"): 0.75,
    ("three", "quarters", "of", "a"): 0.75,
}
AND_FRACTION: dict[Words, float] = {("and", "a", "half"): 0.5, ("and", "a", "quarter"): 0.25, ("半",): 0.5}
"""The fractions that can follow a number, or a number and its unit."""

_DIGITS = {digit: value for value, digit in enumerate("零一二三四五六七八九")} | {"〇": 0, "两": 2}
_POWERS = {"十": 10, "百": 100, "千": 1000}


def parse_number(words: Words) -> float | None:
    """Return the non-negative number that words represent, or None if they are not a number."""
    if not words:
        return None
    if len(words) == 1 and words[0][0].isdigit():
        return float(words[0])
    if words in _FRACTIONS:
        return _FRACTIONS[words]
    return _parse_english(words) if words[0].isascii() else _parse_chinese(words)


def has_number(words: Words) -> bool:
    """Return whether any of the words is a number, except the articles "a" and "an"."""
    return any(word not in _ARTICLES and parse_number((word,)) is not None for word in words)


def _parse_english(words: Words) -> float | None:
    for tail, fraction in AND_FRACTION.items():
        if words[-len(tail) :] == tail:
            integer = _parse_english_integer(words[: -len(tail)])
            return None if integer is None else integer + fraction
    if "point" in words:
        point_index = words.index("point")
        integer = _parse_english_integer(words[:point_index]) if point_index else 0
        return (
            None
            if integer is None
            else _append_decimals(integer, [_UP_TO_NINETEEN.get(word, 10) for word in words[point_index + 1 :]])
        )
    return _parse_english_integer(words)


def _parse_english_integer(words: Words) -> int | None:
    """Return the integer from 0 to 9999 that English words mean, or None."""
    for name, power in (("thousand", 1000), ("hundred", 100)):
        if name in words:
            index = words.index(name)
            multiplier = 1 if words[:index] in ((), ("a",)) else _parse_english_integer(words[:index])
            remaining_words = words[index + 1 :]
            remainder = (
                0
                if not remaining_words
                else _parse_english_integer(remaining_words[1:] if remaining_words[0] == "and" else remaining_words)
            )
            is_valid = multiplier is not None and remainder is not None and 0 < multiplier < 10 and remainder < power
            return (
                power * multiplier + remainder
                if is_valid and multiplier is not None and remainder is not None
                else None
            )
    if len(words) == 1:
        return 1 if words[0] in _ARTICLES else _UP_TO_NINETEEN.get(words[0], _TENS.get(words[0]))
    if len(words) == 2 and words[0] in _TENS and 0 < _UP_TO_NINETEEN.get(words[1], 0) < 10:
        return _TENS[words[0]] + _UP_TO_NINETEEN[words[1]]
    return None


def _parse_chinese(words: Words) -> float | None:
    if words == ("半",):
        return 0.5
    if len(words) > 1 and words[-2:] == ("个", "半"):
        integer = _parse_chinese_integer(words[:-2])
        return None if integer is None else integer + 0.5
    if words[-1] == "个":
        return _parse_chinese(words[:-1]) if len(words) > 1 else None
    if "点" in words:
        point_index = words.index("点")
        integer = _parse_chinese_integer(words[:point_index])
        return (
            None
            if integer is None
            else _append_decimals(integer, [_DIGITS.get(word, 10) for word in words[point_index + 1 :]])
        )
    return _parse_chinese_integer(words)


def _parse_chinese_integer(words: Words) -> int | None:
    """Return the integer from 1 to 9999 that Chinese words mean, such as 180 for 一百八, or None."""
    total, digit, power, has_zero = 0, None, 10_000, False
    for word in words:
        if word in _DIGITS and digit is None:
            if _DIGITS[word] == 0 and total:
                has_zero = True
                continue
            digit = _DIGITS[word]
        elif word in _POWERS and _POWERS[word] < power and (digit or (word == "十" and digit is None and not total)):
            power = _POWERS[word]
            total += (digit or 1) * power
            digit, has_zero = None, False
        else:
            return None
    if digit is None:
        return total or None
    omits_unit = total and power > 10 and not has_zero
    return total + digit * (power // 10 if omits_unit else 1)


def _append_decimals(integer: int, digits: list[int]) -> float | None:
    if not digits or max(digits) > 9:
        return None
    return float(f"{integer}.{''.join(map(str, digits))}")
