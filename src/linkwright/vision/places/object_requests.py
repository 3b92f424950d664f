"""Requests for objects, and descriptions of visible objects, in English and Chinese."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from math import atan2, degrees, hypot

from linkwright.diagnostics import Phrase, phrase
from linkwright.diagnostics.translation import CHINESE, ENGLISH, localized
from linkwright.images.color_words import COLOR_WORD_SPELLINGS, find_color_word, split_into_words

_CHINESE_COLORS = {
    "红": "red", "橙": "orange", "橘": "orange", "黄": "yellow", "绿": "green", "青": "cyan", "蓝": "blue",
    "紫": "purple", "粉": "pink", "棕": "brown", "褐": "brown", "白": "white", "灰": "grey", "黑": "black",
}  # fmt: skip
_SYNONYMS = (
    ("ball", "football", "soccer ball", "sports ball", "sphere", "球", "足球", "皮球", "小球"),
    ("crate", "box", "cube", "箱子", "箱", "盒子", "方块", "木箱"),
    ("cone", "traffic cone", "锥桶", "路锥", "锥筒", "圆锥", "雪糕筒"),
    ("drum", "barrel", "cylinder", "桶", "圆桶", "油桶", "圆柱"),
    ("person", "people", "human", "pedestrian", "adult", "人", "行人", "大人"),
    ("child", "kid", "小孩", "孩子", "儿童"),
    ("stop sign", "停车标志", "停止标志", "停车牌"),
    ("yield sign", "give way sign", "让行标志", "减速让行标志"),
    ("sign", "traffic sign", "标志", "标志牌", "路牌"),
    ("wall", "墙", "墙壁"),
    ("robot", "机器人"),
    ("chair", "椅子"),
    ("table", "desk", "桌子"),
    ("bottle", "瓶子"),
    ("cup", "杯子"),
    ("dog", "狗"),
    ("cat", "猫"),
    ("car", "汽车", "车"),
)  # fmt: skip
"""Names of the same object, English names first. Answers use the first English or Chinese name."""
_COMMON_NAMES = {name: group[0] for group in _SYNONYMS for name in group}
_CHINESE_NAMES = {group[0]: next(name for name in group if not name.isascii()) for group in _SYNONYMS}
_PLURALS = {"people": "person", "children": "child", "boxes": "box", "persons": "person"}
_FILLER_WORDS = {"the", "a", "an", "that", "this", "please", "to", "some", "any"}
_VERBS = re.compile(
    r"(?:please )?"
    r"(?:(?:go|drive|move|walk|run|come|get|turn)(?: over)? to|find|search for|look for|approach|follow)(?: me)? "
)
_CHINESE_VERBS = re.compile(
    r"^(?:请|帮我|去|走到|开到|到|前往|寻找|找到|找|跟着|跟随|跟上|靠近)+|(?:那里|那边|旁边|面前|前面)$"
)
_CHINESE_FILLERS = re.compile(r"那个|这个|一个|那只|这只|色的|色|的|请")
_NUMBER_WORDS = {
    ENGLISH: ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"),
    CHINESE: ("零", "一", "两", "三", "四", "五", "六", "七", "八", "九", "十"),
}
_ROUND_NOUN, _ROUND_ASPECT_RATIOS = "ball", (0.75, 1.33)
_ROUND_FILL_FRACTIONS = (0.7, 0.86)
"""The range of the fraction of its box that a round patch fills, about pi / 4. A square patch fills the whole box."""
_MAX_AHEAD_DEGREES, _MAX_BESIDE_DEGREES = 20.0, 110.0
"""The maximum bearings, in degrees, of objects ahead and of objects to the left or right. Other objects are behind."""


class Answer(Enum):
    """The kinds of answers to a request."""

    SEARCHING = "looking"
    FOUND = "found"
    ARRIVED = "arrived"
    NOT_FOUND = "not found"
    LOST = "lost"
    BLOCKED = "blocked"
    NO_DETECTIONS = "blind"
    STOPPED = "stopped"


_ANSWERS: Mapping[Answer, Callable[[str], Phrase]] = {
    Answer.SEARCHING: lambda name: phrase("I am looking for the {name}.", name=name),
    Answer.FOUND: lambda name: phrase("I see the {name} and am driving to it.", name=name),
    Answer.ARRIVED: lambda name: phrase("I am at the {name}.", name=name),
    Answer.NOT_FOUND: lambda name: phrase("I cannot find the {name}.", name=name),
    Answer.LOST: lambda name: phrase("I have lost the {name}.", name=name),
    Answer.BLOCKED: lambda name: phrase("An obstacle is between me and the {name}.", name=name),
    Answer.NO_DETECTIONS: lambda _: phrase("I am stopping, because I receive no detections."),
    Answer.STOPPED: lambda _: phrase("I am stopping."),
}
"""The answers, given the name of the object."""


@dataclass(frozen=True, slots=True)
class ObjectRequest:
    """An object that a user asks for.

    Attributes:
        noun: the name of the object, as `normalize_object_name` returns it; empty for any object of the color.
        color: one of `COLORS`; None for any color.
        text: the words of the request, without filler words.
    """

    noun: str
    color: str | None
    text: str

    @property
    def language(self) -> str:
        """The language of the request, one of `LANGUAGES`."""
        return ENGLISH if self.text.isascii() else CHINESE

    def matches(self, name: str, color: str | None, aspect_ratio: float = 1.0, score: float = 1.0) -> bool:
        """Return whether an object is the requested one.

        A class can have a color in its name, as ``red_ball`` has. A class that is only a color matches any object
        of that color, and matches a ball if the patch is about as wide as high. If the request is for a ball of any
        color, a round patch also matches.

        Args:
            name: the class of the object.
            color: the color of the object; None if it is unknown.
            aspect_ratio: the width divided by the height.
            score: the score of the detection; for a patch of a color, the fraction of its box that it fills.
        """
        words = split_into_words(name)
        class_color = find_color_word(name)
        class_noun = " ".join(word for word in words if word not in COLOR_WORD_SPELLINGS)
        if self.color is not None and self.color != (class_color or color):
            return False
        if not self.noun:
            return True
        if not class_noun:
            if self.noun != _ROUND_NOUN:
                return self.color is not None
            is_round = self.color is not None or _ROUND_FILL_FRACTIONS[0] < score < _ROUND_FILL_FRACTIONS[1]
            return is_round and _ROUND_ASPECT_RATIOS[0] < aspect_ratio < _ROUND_ASPECT_RATIOS[1]
        return self.noun in (normalize_object_name(class_noun), normalize_object_name(class_noun.split()[-1]))


@dataclass(frozen=True, slots=True)
class Sighting:
    """A visible object: its class, its color or None, and its position in m."""

    name: str
    color: str | None
    ahead: float
    left: float


def normalize_object_name(name: str) -> str:
    """Return the common name of an object in lower case and singular.

    It is ``ball`` for ``football`` and ``球``, for example.
    """
    normalized = name.strip().lower()
    if normalized in _COMMON_NAMES:
        return _COMMON_NAMES[normalized]
    singular = _PLURALS.get(normalized) or (
        normalized[:-1] if len(normalized) > 3 and normalized.endswith("s") else normalized
    )
    return _COMMON_NAMES.get(singular, singular if singular in _PLURALS.values() else normalized)


def parse_request(text: str) -> ObjectRequest | None:
    """Parse a request such as ``go to the red ball`` or ``去红色的球那里``.

    The result is None if the request names no object.
    """
    normalized = text.strip().strip(".,!?。，！？").lower()
    if normalized.isascii():
        normalized = (
            _VERBS.sub("", f"{' '.join(normalized.split())} ", count=1) if _VERBS.match(normalized) else normalized
        )
        words = [word for word in split_into_words(normalized) if word not in _FILLER_WORDS]
        color = next((COLOR_WORD_SPELLINGS[word] for word in words if word in COLOR_WORD_SPELLINGS), None)
        noun = " ".join(word for word in words if word not in COLOR_WORD_SPELLINGS and word not in ("thing", "one"))
        return ObjectRequest(normalize_object_name(noun), color, " ".join(words)) if color or noun else None
    normalized = _CHINESE_VERBS.sub("", normalized)
    color = next((_CHINESE_COLORS[character] for character in normalized if character in _CHINESE_COLORS), None)
    noun = _CHINESE_FILLERS.sub("", normalized)
    noun = "".join(sign for sign in noun if sign not in _CHINESE_COLORS).replace("东西", "").strip()
    return (
        ObjectRequest(normalize_object_name(noun), color, re.sub(r"那个|这个|一个|请", "", normalized))
        if color or noun
        else None
    )


def describe_sightings(sightings: Iterable[Sighting], language: str) -> str:
    """Describe visible objects, nearest first: *I see a red ball 1.2 m ahead and two crates*."""
    groups: dict[str, list[Sighting]] = {}
    for sighting in sorted(sightings, key=lambda sighting: hypot(sighting.ahead, sighting.left)):
        groups.setdefault(add_color_to_name(sighting.name, sighting.color, language), []).append(sighting)
    if not groups:
        return localized(phrase("I see no objects."), language)
    if language == CHINESE:
        return f"我看到{_join_phrases([_describe_in_chinese(group) for group in groups.values()], '，', '和')}。"
    return f"I see {_join_phrases([_describe_in_english(group) for group in groups.values()], ', ', ' and ')}."


def add_color_to_name(name: str, color: str | None, language: str) -> str:
    """Return the name of an object with its color: *red ball*, 红色的球."""
    words = [word for word in split_into_words(name) if word not in COLOR_WORD_SPELLINGS]
    color_word = find_color_word(name) or color
    noun = " ".join(words)
    if language != CHINESE:
        return " ".join(filter(None, (color_word, noun or "thing")))
    chinese = _CHINESE_NAMES.get(normalize_object_name(noun), noun) if noun else "东西"
    color_characters = {english: sign for sign, english in reversed(_CHINESE_COLORS.items())}
    return f"{color_characters[color_word]}色的{chinese}" if color_word else chinese


def make_answer_phrase(event: Answer, request: ObjectRequest, language: str) -> str:
    """Return the answer to a request.

    The object has its name from the request, or the translation of that name.
    """
    name = request.text if request.language == language else add_color_to_name(request.noun, request.color, language)
    return localized(_ANSWERS[event](name), language)


def _describe_in_english(group: Sequence[Sighting]) -> str:
    sighting = group[0]
    name = add_color_to_name(sighting.name, sighting.color, ENGLISH)
    if len(group) > 1:
        return f"{_spell_number(len(group), ENGLISH)} {_pluralize(name)}"
    article = "an" if name[0] in "aeiou" else "a"
    return f"{article} {name} {hypot(sighting.ahead, sighting.left):.1f} m {_describe_direction(sighting, ENGLISH)}"


def _describe_in_chinese(group: Sequence[Sighting]) -> str:
    sighting = group[0]
    name = add_color_to_name(sighting.name, sighting.color, CHINESE)
    if len(group) > 1:
        return f"{_spell_number(len(group), CHINESE)}个{name}"
    return f"{_describe_direction(sighting, CHINESE)}{hypot(sighting.ahead, sighting.left):.1f}米处有一个{name}"


def _describe_direction(sighting: Sighting, language: str) -> str:
    angle = degrees(atan2(sighting.left, sighting.ahead))
    if abs(angle) <= _MAX_AHEAD_DEGREES:
        return localized(phrase("ahead"), language)
    if abs(angle) > _MAX_BESIDE_DEGREES:
        return localized(phrase("behind me"), language)
    return localized(phrase("to the left") if angle > 0 else phrase("to the right"), language)


def _spell_number(count: int, language: str) -> str:
    words = _NUMBER_WORDS[language]
    return words[count] if count < len(words) else str(count)


def _pluralize(name: str) -> str:
    for singular, plural in (("person", "people"), ("child", "children")):
        if name.endswith(singular):
            return name[: -len(singular)] + plural
    return name + ("es" if name.endswith(("x", "s", "ch", "sh")) else "s")


def _join_phrases(phrases: Sequence[str], comma: str, conjunction: str) -> str:
    return phrases[0] if len(phrases) == 1 else comma.join(phrases[:-1]) + conjunction + phrases[-1]
