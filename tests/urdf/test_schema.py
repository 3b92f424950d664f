"""The table of elements agrees with the reader."""

from __future__ import annotations

import pytest

from linkwright.schema import AttributeRule, ElementRule
from linkwright.urdf import (
    Calibration,
    Dynamics,
    Limit,
    Mesh,
    Mimic,
    Pose,
    Safety,
    read,
)
from linkwright.urdf.schema import ROBOT, SHAPES
from linkwright.urdf.values import JOINT_TYPE, NUMBER, QUATERNION, RGBA, TEXT, VECTOR3, VERSION, number, numbers
from linkwright.xmltree import Document, Element, parse

VALUES = {
    TEXT: "b",
    NUMBER: "1",
    VECTOR3: "1 1 1",
    QUATERNION: "0 0 0 1",
    RGBA: "1 1 1 1",
    JOINT_TYPE: "revolute",
    VERSION: "1.0",
}
ALLOWED = {"URDF171", "URDF180"}  # no joint to mimic; the limits of URDF 1.2 are ignored without 'version'
VERSIONS = ("1.0", "1.2")


def full_element(rule: ElementRule, version: tuple[int, int]) -> Element:
    """Return an element with all its attributes and children.

    ``<geometry>`` has only its first child.
    """
    element = Element(
        rule.tag,
        {attribute.name: VALUES[attribute.type] for attribute in rule.attributes if attribute.since <= version},
    )
    if rule.tag == "origin":
        element.attributes.pop("quat_xyzw", None)
    if rule.tag in ("parent", "robot"):
        element.attributes["link" if rule.tag == "parent" else "name"] = "a"
    if rule.tag == "mimic":
        element.attributes["joint"] = "other"
    children = rule.children[:1] if rule.tag == "geometry" else rule.children
    element.children += [full_element(child, version) for child in children if child.since <= version]
    return element


def make_full_robot(version: str, shape: ElementRule = SHAPES[0]) -> Element:
    parsed = tuple(map(int, version.split(".")))
    robot = full_element(ROBOT, parsed)
    robot.attributes["version"] = version
    robot.children.append(Element("link", {"name": "a"}))
    for element in walk_elements(robot):
        if element.tag == "geometry":
            element.children = [full_element(shape, parsed)]
    return robot


def walk_elements(element: Element):
    yield element
    for child in element.elements():
        yield from walk_elements(child)


def all_rules(version, rule=ROBOT, path=()):
    path = (*path, rule.tag)
    if rule.since <= tuple(map(int, version.split("."))):
        yield path, rule
        for child in rule.children:
            yield from all_rules(version, child, path)


def find_element(element: Element, path: tuple[str, ...]) -> Element:
    for tag in path[1:]:
        element = next(child for child in element.elements(tag) if tag != "link" or child.attributes["name"] == "b")
    return element


def attribute_cases(choose):
    """Return parameters for each attribute of the table that `choose` accepts, in each version."""
    cases = []
    for version in VERSIONS:
        parsed = tuple(map(int, version.split(".")))
        for path, rule in all_rules(version):
            for attribute in rule.attributes:
                if attribute.since <= parsed and choose(attribute, parsed):
                    name = f"{version}/{'/'.join(path)}@{attribute.name}"
                    cases.append(pytest.param(version, path, attribute, id=name))
    return cases


def prepare_element(version, path):
    shape = next((shape for shape in SHAPES if shape.tag == path[-1]), SHAPES[0])
    robot = make_full_robot(version, shape)
    return robot, find_element(robot, path)


@pytest.mark.parametrize("version", VERSIONS)
def test_robot_with_all_schema_elements_is_read(version):
    result = read(Document(make_full_robot(version)))
    assert [diagnostic.message for diagnostic in result.diagnostics if diagnostic.code != "URDF180"] == []
    assert result.robot.joints["b"].safety is not None


@pytest.mark.parametrize(
    ("version", "path", "attribute"), attribute_cases(lambda rule, version: rule.is_required(version))
)
def test_required_attributes_are_required_by_reader(version, path, attribute: AttributeRule):
    robot, element = prepare_element(version, path)
    del element.attributes[attribute.name]
    assert any(f"no '{attribute.name}'" in diagnostic.message for diagnostic in read(Document(robot)).diagnostics)


@pytest.mark.parametrize(("version", "path", "attribute"), attribute_cases(lambda rule, _: rule.type != TEXT))
def test_malformed_values_are_reported(version, path, attribute: AttributeRule):
    robot, element = prepare_element(version, path)
    if attribute.name == "quat_xyzw":
        element.attributes.pop("rpy")
    element.attributes[attribute.name] = "nonsense"
    diagnostics = read(Document(robot)).diagnostics
    assert any("'nonsense'" in diagnostic.message for diagnostic in diagnostics)


@pytest.mark.parametrize(
    ("version", "path", "attribute"),
    attribute_cases(
        lambda rule, version: not rule.is_required(version) and rule.name not in ("lower", "upper", "rgba", "quat_xyzw")
    ),
)
def test_optional_attributes_may_be_missing(version, path, attribute: AttributeRule):
    robot, element = prepare_element(version, path)
    del element.attributes[attribute.name]
    result = read(Document(robot))
    assert result.robot is not None
    assert {diagnostic.code for diagnostic in result.diagnostics} <= ALLOWED


@pytest.mark.parametrize(
    ("path", "values"),
    [
        ("robot joint limit", Limit()),
        ("robot joint mimic", Mimic("")),
        ("robot joint safety_controller", Safety(0)),
        ("robot joint dynamics", Dynamics()),
        ("robot joint calibration", Calibration()),
        ("robot joint origin", Pose()),
        ("robot link visual geometry mesh", Mesh("")),
    ],
)
def test_schema_defaults_match_model(path, values):
    rule = ROBOT
    for tag in path.split()[1:]:
        rule = rule.child_rules.get(tag)
    for attribute in rule.attributes:
        if attribute.default:
            default = getattr(values, attribute.name)
            parsed = number(attribute.default) if attribute.type is NUMBER else numbers(attribute.default)
            assert parsed == default


def test_minimal_robot_text_is_read():
    text = '<robot name="a" version="1.0"><link name="b"/></robot>'
    assert read(parse(text, "x")).robot is not None
