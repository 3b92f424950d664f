"""Any tree of elements is read without a crash, and every loss is reported."""

from __future__ import annotations

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from linkwright.diagnostics import has_errors, render, to_data
from linkwright.kinematics import KinematicTree
from linkwright.schema import ElementRule
from linkwright.urdf import read, save, to_gv, tree_text
from linkwright.urdf.schema import ROBOT
from linkwright.urdf.values import JOINT_TYPE, JOINT_TYPES, NUMBER, QUATERNION, RGBA, TEXT, VECTOR3, VERSION
from linkwright.xmltree import Document, Element, parse, write

INVALID_VALUES = [
    "",
    " ",
    "x",
    "1 ",
    "1,5",
    "inf",
    "1e999",
    "${x}",
    "-pi",
    "5cm",
    "0 0",
    "0 0 0 0",
    "255 0 0 1",
    "2.0",
    "é",
    "a b",
]
VALID_VALUES = {
    TEXT: ["a", "b", "c", ""],
    NUMBER: ["0", "1", "-90", " 2.5"],
    VECTOR3: ["0 0 0", "1 -2 .5", "0 0 90", " 1  2 3 "],
    QUATERNION: ["0 0 0 1", "0 0 0 0", "1 2 3 4"],
    RGBA: ["1 1 1 1", "0 .5 0 1"],
    JOINT_TYPE: [*JOINT_TYPES],
    VERSION: ["1.0", "1.1", "1.2"],
}
OTHER_RULES = [ElementRule(tag, "") for tag in ("gazebo", "xacro:if", "limits", "geomtry", "cube")]


@st.composite
def elements(draw, rule: ElementRule, sloppy: bool) -> Element:
    element = Element(rule.tag)
    for attribute in rule.attributes:
        if not sloppy or draw(st.integers(0, 9)):
            valid_values = VALID_VALUES[attribute.type]
            values = st.sampled_from(
                INVALID_VALUES + valid_values if sloppy and not draw(st.integers(0, 9)) else valid_values
            )
            element.attributes[attribute.name] = draw(values)
    children = list(rule.children)
    if rule.tag == "geometry":
        children = [draw(st.sampled_from(children))]
    for child in children:
        count = draw(st.integers(0, 3)) if child.is_repeated else draw(st.integers(0, 1 if sloppy else 9)) > 0
        element.children += [draw(elements(child, sloppy)) for _ in range(count)]
    if sloppy and not draw(st.integers(0, 9)):
        element.children.append(draw(elements(draw(st.sampled_from(OTHER_RULES)), sloppy)))
    return element


@st.composite
def robots(draw, sloppy: bool) -> Element:
    """Generate a robot whose joints form a tree of its links, or almost a tree."""
    root = draw(elements(ROBOT, sloppy))

    def sound() -> bool:
        return not sloppy or draw(st.integers(0, 19)) > 0

    links = list(root.elements("link")) or [Element("link")]
    joints = list(root.elements("joint"))[: len(links) - 1]
    for place, link in enumerate(links):
        if sound():
            link.attributes["name"] = f"link{place}"
    while len(joints) < len(links) - 1:
        joints.append(Element("joint", {"type": "fixed"}))
    for place, joint in enumerate(joints, start=1):
        ends = {"parent": draw(st.integers(0, place - 1)), "child": place}
        joint.children = [child for child in joint.children if not (isinstance(child, Element) and child.tag in ends)]
        if sound():
            joint.attributes["name"] = f"joint{place}"
            joint.children += [Element(tag, {"link": f"link{end}"}) for tag, end in ends.items()]
    other_elements = [child for child in root.elements() if child.tag not in ("link", "joint")]
    root.children = [*draw(st.permutations(other_elements[:3])), *links, *joints]
    root.attributes = {"name": "r", "xmlns:xacro": "http://www.ros.org/wiki/xacro", **root.attributes}
    return root


def check_robot(root: Element) -> None:
    reading = read(Document(root))
    if reading.robot is None:
        assert has_errors(reading.diagnostics)
        return
    robot = reading.robot
    elements_of_links = [element for element in root.elements("link") if "name" in element.attributes]
    written = sum(1 for link in elements_of_links for tag in ("visual", "collision") for _ in link.elements(tag))
    shape_count = sum(len(link.visuals) + len(link.collisions) for link in robot.links.values())
    assert written == shape_count or has_errors(reading.diagnostics)
    assert robot.root in robot.links
    to_gv(robot)
    tree_text(robot)
    tree = KinematicTree(robot)
    assert tree.forward([0.0] * len(tree.joint_names)).shape == (len(tree.link_names), 4, 4)
    reread = read(parse(save(robot), "saved.urdf"))
    assert reread.robot == robot


@settings(max_examples=150, suppress_health_check=[HealthCheck.data_too_large])
@given(robots(sloppy=False))
def test_valid_elements_are_read_without_loss(root):
    check_robot(root)


@settings(max_examples=150, suppress_health_check=[HealthCheck.data_too_large])
@given(robots(sloppy=True))
def test_arbitrary_elements_are_read_without_crash(root):
    check_robot(root)


@settings(max_examples=100, suppress_health_check=[HealthCheck.data_too_large])
@given(robots(sloppy=True))
def test_findings_can_be_rendered_and_serialized(root):
    for diagnostic in read(parse(write(Document(root)), "robot.urdf")).diagnostics:
        assert diagnostic.span is not None
        assert diagnostic.code in render(diagnostic)
        assert to_data(diagnostic)["line"] >= 1
