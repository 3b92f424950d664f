"""Worlds in SDF, made from choices: any element of the tables in any other, its value mostly of a fitting kind."""

from __future__ import annotations

from fuzz.choices import Choices
from linkwright.schema import ElementRule
from linkwright.sdf.worlds import SDF

_VALUES = [
    "0",
    "1",
    "0 0 1",
    "0 0 0 0 0 0",
    "a",
    "true",
    "1 2",
    "nan",
    "1e999",
    "",
    "a::b",
    "-1",
    "é",
    "x y",
    "0 0 0 0 0 0 1",
]
_NAMES = ["a", "b", "c", "a::b", "world", "__model__", "", "é"]
_TYPES = ["fixed", "revolute", "ball", "gpu_lidar", "point", "universal", "x"]
_REFERENCES = [
    "",
    "",
    "",
    ' relative_to="a"',
    ' relative_to="b"',
    ' frame="c"',
    ' rotation_format="quat_xyzw"',
    ' degrees="1"',
]
_MAX_DEPTH = 12


def world(choices: Choices) -> str:
    """Return a world or model, not always a valid one."""
    version = choices.pick(["1.9", "1.6", "1.4", "1.12", "2.0", "x"])
    inside = "".join(_element(choices, choices.pick(SDF.children), 1) for _ in range(1 + choices.number(3)))
    return f'<sdf version="{version}">{inside}{choices.pick(["</sdf>", "</sdf>", "</sdf> text", ""])}'


def _element(choices: Choices, rule: ElementRule, depth: int) -> str:
    if rule.tag == "pose":
        return f"<pose{choices.pick(_REFERENCES)}>{choices.pick(_VALUES)}</pose>"
    if rule.text is not None:
        value = choices.pick(_NAMES if rule.tag in ("parent", "child", "name", "uri") else _VALUES)
        return f"<{rule.tag}>{value}</{rule.tag}>"
    attributes = "".join(_attribute(choices, attribute.name) for attribute in rule.attributes)
    inside = ""
    children = (*rule.children, rule) if rule.is_recursive else rule.children
    if children and depth < _MAX_DEPTH:
        inside = "".join(_element(choices, choices.pick(children), depth + 1) for _ in range(choices.number(5)))
    return f"<{rule.tag}{attributes}>{inside}</{rule.tag}>"


def _attribute(choices: Choices, name: str) -> str:
    if choices.chance(9) or ":" in name:
        return ""
    return f' {name}="{choices.pick(_TYPES if name == "type" else _NAMES)}"'
