"""Spoken quantities: numbers with units, converted to meters, radians and seconds."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi, tau

from linkwright.speech.commands.numbers import AND_FRACTION, parse_number
from linkwright.speech.commands.words import Words, split_into_words


def _parse_units(table: Mapping[str, float]) -> dict[Words, float]:
    return {split_into_words(name): factor for names, factor in table.items() for name in names.split("|")}


_DISTANCE_UNITS = {
    "meter|meters|meter|meters|m|米|公尺": 1.0,
    "centimeter|centimeters|centimeter|centimeters|cm|厘米|公分": 0.01,
    "millimeter|millimeters|millimeter|millimeters|mm|毫米": 0.001,
    "foot|feet|ft|英尺": 0.3048,
    "inch|inches|英寸": 0.0254,
    "yard|yards|码": 0.9144,
}
_SPEED_UNITS = {
    f"{name} {suffix}" if name.isascii() else f"{name}{suffix}": factor
    for names, factor in _DISTANCE_UNITS.items()
    for name in names.split("|")
    for suffix in (("per second", "a second") if name.isascii() else ("每秒",))
} | {"kilometers per hour|kilometers per hour|kilometers an hour|kilometers an hour|公里每小时": 1 / 3.6}
UNITS: Mapping[str, Mapping[Words, float]] = {
    "distance": _parse_units(_DISTANCE_UNITS),
    "angle": _parse_units(
        {
            "degree|degrees|deg|°|度": pi / 180,
            "radian|radians|rad|弧度": 1.0,
            "turn|turns|circle|circles|revolution|revolutions|圈|周": tau,
        }
    ),
    "speed": _parse_units(_SPEED_UNITS),
    "duration": _parse_units({"second|seconds|s|秒|秒钟": 1.0, "minute|minutes|分钟": 60.0}),
}
"""The units of each slot that is a number with a unit, each with its value in m, rad, m/s or s."""

GRAMMAR_VALUES: Mapping[str, Mapping[str, tuple[str, ...]]] = {
    "distance": {
        "en": (
            *("ten centimeters", "twenty centimeters", "half a meter", "one meter", "a meter", "one and a half meters"),
            *("two meters", "three meters", "four meters", "five meters", "one foot", "two feet", "three feet"),
        ),
        "zh": ("十厘米", "二十厘米", "半米", "一米", "一米半", "一点五米", "两米", "三米", "四米", "五米"),
    },
    "angle": {
        "en": (
            *("ten degrees", "fifteen degrees", "thirty degrees", "forty five degrees", "sixty degrees"),
            *("ninety degrees", "one hundred and twenty degrees", "one hundred and eighty degrees"),
            *("three hundred and sixty degrees", "a quarter turn", "half a turn", "one turn", "two turns"),
        ),
        "zh": (
            *("十度", "十五度", "三十度", "四十五度", "六十度", "九十度", "一百二十度", "一百八十度", "三百六十度"),
            *("半圈", "一圈", "两圈"),
        ),
    },
    "speed": {
        "en": ("ten centimeters per second", "twenty centimeters per second", "half a meter per second"),
        "zh": ("每秒十厘米", "每秒二十厘米", "每秒半米"),
    },
    "duration": {
        "en": ("one second", "two seconds", "three seconds", "five seconds", "ten seconds"),
        "zh": ("一秒", "两秒", "三秒", "五秒", "十秒"),
    },
    "number": {
        "en": ("one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"),
        "zh": ("一", "二", "三", "四", "五", "六", "七", "八", "九", "十"),
    },
}
"""The values of slots in the engines' grammars, by slot and language.

There are only a few values, so that engines do not mishear other words. Any other value is also understood if an engine
recognizes it or a user types it.
"""

_PER_SECOND: Words = ("每", "秒")


def parse_quantity(slot: str, words: Words) -> float | None:
    """Return the quantity that words express in a slot, or None if they express none.

    The unit is m, rad, m/s or s, depending on the slot. The slot ``number`` has no unit.
    """
    if slot == "number":
        return parse_number(words)
    if slot == "speed" and words[:2] == _PER_SECOND:
        return _parse_with_unit(UNITS["distance"], words[2:])
    return _parse_with_unit(UNITS[slot], words)


def _parse_with_unit(units: Mapping[Words, float], words: Words) -> float | None:
    for tail, fraction in [((), 0.0), *AND_FRACTION.items()]:
        measure_words = words[: len(words) - len(tail)]
        if words[len(measure_words) :] != tail:
            continue
        for unit, factor in units.items():
            if len(measure_words) > len(unit) and measure_words[-len(unit) :] == unit:
                value = parse_number(measure_words[: -len(unit)])
                if value is not None and (not fraction or value == int(value)):
                    return (value + fraction) * factor
    return None
