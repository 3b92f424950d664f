"""An example language for garden sheds, read, written and described by its rules."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from linkwright.schema import (
    UNREADABLE,
    AttributeRule,
    ElementRule,
    ValueType,
    describe_attribute,
    describe_element,
    reader_of,
    write_element,
)
from linkwright.xmltree import Document, Element, parse, write

TEXT = ValueType("text")
NUMBER = ValueType("number", float, lambda value: None if value == float("inf") else f"{value:g}")


@dataclass(frozen=True)
class Tool:
    name: str
    weight: float | None = None
    length: float = 1.0


@dataclass(frozen=True)
class Hook:
    height: float


@dataclass(frozen=True)
class Bed:
    length: float


@dataclass(frozen=True)
class Shed:
    name: str
    width: float = 2.0
    tools: tuple[Tool, ...] = ()
    place: Hook | Bed | None = None
    shed: tuple[Shed, ...] = ()
    element: Element | None = None


TOOL = ElementRule(
    "tool",
    "something to work with",
    (
        AttributeRule("name", TEXT, "what it is called", required=True),
        AttributeRule("kg", NUMBER, "how heavy it is", "kg", since=(1, 1), field="weight"),
        AttributeRule("length", NUMBER, "how long it is", "m", default="1", later_default=((2, 0), 3.0)),
    ),
    is_repeated=True,
    make=Tool,
    field="tools",
)
PLACE = ElementRule(
    "place",
    "where it hangs or grows",
    children=(
        ElementRule("hook", "a hook", text=AttributeRule("height", NUMBER, "how high", required=True), make=Hook),
        ElementRule("bed", "a bed", (AttributeRule("length", NUMBER, "", required=True),), since=(1, 1), make=Bed),
    ),
    choice=True,
)
SHED = ElementRule(
    "shed",
    "a house for tools",
    (AttributeRule("name", TEXT, "its name", required=True),),
    (
        ElementRule(
            "size",
            "how large it is",
            (AttributeRule("width", NUMBER, "from left to right", "m", required=True),),
            required=True,
            default=(2.0,),
        ),
        TOOL,
        PLACE,
    ),
    make=Shed,
    passes_element=True,
    is_recursive=True,
)


class Told:
    """A report that stores a word for each finding."""

    def __init__(self):
        self.words: list[str] = []

    @property
    def count(self):
        return len(self.words)

    def missing_attribute(self, element, rule, attribute, owner):
        self.words.append(f"{rule.tag} of {owner.tag} lacks {attribute.name}")

    def malformed(self, element, rule, attribute, owner):
        self.words.append(f"{rule.tag} of {owner.tag} has a bad {attribute.name}")
        return 7.0 if attribute.name == "kg" else UNREADABLE

    def too_new(self, element, rule, attribute, owner):
        self.words.append(f"{attribute.name} is too new")

    def missing_child(self, element, rule, child, owner):
        self.words.append(f"{rule.tag} lacks {child.tag}")

    def empty_choice(self, element, rule, owner):
        self.words.append(f"{rule.tag} is empty")

    def unknown_choice(self, child, rule, owner):
        self.words.append(f"{child.tag} is no {rule.tag}")


def read(text: str, version=(1, 1)):
    root = parse(text, "shed.xml").root
    result = Told()
    return reader_of(SHED, version).read(root, root, result), result.words


FULL = (
    '<shed name="big"><size width="3"/><tool name="saw" kg="2"/><tool name="rope" length="9"/>'
    '<place><hook>1.5</hook></place><shed name="inner"><size width="1"/></shed></shed>'
)


def test_document_is_read_into_objects():
    shed, words = read(FULL)
    assert words == []
    assert (shed.name, shed.width, shed.place) == ("big", 3.0, Hook(1.5))
    assert shed.tools == (Tool("saw", 2.0), Tool("rope", None, 9.0))
    assert [inner.name for inner in shed.shed] == ["inner"]
    assert shed.element.tag == "shed"


def test_written_document_reads_back():
    shed, _ = read(FULL)
    text = write(Document(write_element(SHED, shed)))
    assert 'length="1"' not in text  # the default is not written
    reread, words = read(text)
    assert words == []
    assert reread.tools == shed.tools
    assert reread.place == shed.place


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("<shed/>", ["shed of shed lacks name", "shed lacks size"]),
        ('<shed name="a"><size/></shed>', ["size of shed lacks width"]),
        (
            '<shed name="a"><size width="wide"/><tool/></shed>',
            ["size of shed has a bad width", "tool of shed lacks name"],
        ),
        ('<shed name="a"><size width="1"/><place/></shed>', ["place is empty"]),
        ('<shed name="a"><size width="1"/><place><roof/></place></shed>', ["roof is no place"]),
        ('<shed name="a"><size width="1"/><place><hook/></place></shed>', ["hook of shed lacks height"]),
        ('<shed name="a"><size width="1"/><shed name="b"/></shed>', ["shed lacks size"]),
    ],
)
def test_all_errors_are_reported_and_no_object_is_returned(text, words):
    assert read(text) == (UNREADABLE, words)


def test_report_can_substitute_malformed_value():
    shed, words = read('<shed name="a"><size width="1"/><tool name="t" kg="much"/></shed>')
    assert words == ["tool of shed has a bad kg"]
    assert shed.tools[0].weight == 7.0


def test_schema_version_selects_attributes_and_elements():
    text = '<shed name="a"><size width="1"/><tool name="t" kg="2"/><place><bed length="1"/></place></shed>'
    assert read(text, (1, 0)) == (UNREADABLE, ["kg is too new", "bed is no place"])
    shed, words = read(text, (2, 0))
    assert words == []
    assert shed.tools[0].length == 3.0


def test_first_of_several_children_is_used():
    shed, _ = read('<shed name="a"><size width="1"/><size width="2"/></shed>')
    assert shed.width == 1.0


def test_second_read_reports_same_findings():
    text = '<shed name="a"><size width="x"/></shed>'
    assert read(text) == read(text)


def test_describe_element_lists_attributes():
    assert describe_element(TOOL).splitlines() == [
        "`<tool>`: something to work with",
        "",
        "- `name`: what it is called (text, required)",
        "- `kg`: how heavy it is (number in kg, since version 1.1)",
        "- `length`: how long it is (number in m, `1` when absent)",
    ]
    assert describe_element(SHED).splitlines()[-1] == (
        "- contains `<size>` (required), `<tool>` (any number), `<place>`, `<shed>` (any number)"
    )
    assert describe_element(PLACE).splitlines()[-1] == "- contains one of `<hook>`, `<bed>`"
    hook, bed = PLACE.children
    assert describe_element(ElementRule("wall", "a wall", children=(hook, bed))).splitlines()[1:] == [
        "",
        "- `<hook>`: a hook (number, required)",
        "- contains `<bed>`",
    ]
    assert describe_element(hook).splitlines()[-1] == "- the text inside: how high (number, required)"
    assert describe_element(bed).startswith("`<bed>`, since version 1.1: a bed")
    assert describe_attribute(SHED.attributes[0]) == "`name`: its name (text, required)"
