"""Spoken numbers in English and Chinese: ``one and a half``, ``a hundred and six``, ``一点五``."""

from __future__ import annotations

from linkwright.speech.commands.words import Words

_ENGLISH = (
    "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen"
)
_SMALL = {word: number for number, word in enumerate((_ENGLISH + " eighteen nineteen").split())} | {
    "oh": 0,
    "nought": 0,
}
_TENS = {
    word: 10 * (at + 2)
    for at, word in enumerate(["twenty", "thirty", "forty", "fifty", "sixty", "seventy", "eighty", "ninety"])
}
_ONE = ("a", "an")
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
"""Fractions that may follow a number, or a number and its unit."""

_DIGITS = {digit: number for number, digit in enumerate("零一二三四五六七八九")} | {"〇": 0, "两": 2}
_POWERS = {"十": 10, "百": 100, "千": 1000}


def number(words: Words) -> float | None:
    """Return the number, at least 0, that all of the words together mean, or None."""
    if not words:
        return None
    if len(words) == 1 and words[0][0].isdigit():
        return float(words[0])
    if words in _FRACTIONS:
        return _FRACTIONS[words]
    return _english(words) if words[0].isascii() else _chinese(words)


def has_number(words: Words) -> bool:
    """Return whether any of the words is a number; the articles "a" and "an" do not count."""
    return any(word not in _ONE and number((word,)) is not None for word in words)


def _english(words: Words) -> float | None:
    for tail, fraction in AND_FRACTION.items():
        if words[-len(tail) :] == tail:
            whole = _whole(words[: -len(tail)])
            return None if whole is None else whole + fraction
    if "point" in words:
        at = words.index("point")
        whole = _whole(words[:at]) if at else 0
        return None if whole is None else _with_decimals(whole, [_SMALL.get(word, 10) for word in words[at + 1 :]])
    return _whole(words)


def _whole(words: Words) -> int | None:
    """Return the value of an integer in English, up to 9999, or None."""
    for name, power in (("thousand", 1000), ("hundred", 100)):
        if name in words:
            at = words.index(name)
            left = 1 if words[:at] in ((), ("a",)) else _whole(words[:at])
            rest = words[at + 1 :]
            right = 0 if not rest else _whole(rest[1:] if rest[0] == "and" else rest)
            good = left is not None and right is not None and 0 < left < 10 and right < power
            return power * left + right if good and left is not None and right is not None else None
    if len(words) == 1:
        return 1 if words[0] in _ONE else _SMALL.get(words[0], _TENS.get(words[0]))
    if len(words) == 2 and words[0] in _TENS and 0 < _SMALL.get(words[1], 0) < 10:
        return _TENS[words[0]] + _SMALL[words[1]]
    return None


def _chinese(words: Words) -> float | None:
    if words == ("半",):
        return 0.5
    if len(words) > 1 and words[-2:] == ("个", "半"):
        whole = _chinese_whole(words[:-2])
        return None if whole is None else whole + 0.5
    if words[-1] == "个":
        return _chinese(words[:-1]) if len(words) > 1 else None
    if "点" in words:
        at = words.index("点")
        whole = _chinese_whole(words[:at])
        return None if whole is None else _with_decimals(whole, [_DIGITS.get(word, 10) for word in words[at + 1 :]])
    return _chinese_whole(words)


def _chinese_whole(words: Words) -> int | None:
    """Return the value of an integer in Chinese, up to 9999, or None; 一百八 is 180."""
    total, digit, power, zero = 0, None, 10_000, False
    for word in words:
        if word in _DIGITS and digit is None:
            if _DIGITS[word] == 0 and total:
                zero = True
                continue
            digit = _DIGITS[word]
        elif word in _POWERS and _POWERS[word] < power and (digit or (word == "十" and digit is None and not total)):
            power = _POWERS[word]
            total += (digit or 1) * power
            digit, zero = None, False
        else:
            return None
    if digit is None:
        return total or None
    short = total and power > 10 and not zero
    return total + digit * (power // 10 if short else 1)


def _with_decimals(whole: int, digits: list[int]) -> float | None:
    if not digits or max(digits) > 9:
        return None
    return float(f"{whole}.{''.join(map(str, digits))}")
