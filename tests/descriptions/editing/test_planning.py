"""The smallest edit of a text for an edit of a robot."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from linkwright.descriptions import Description, examine
from linkwright.descriptions.editing import WITHOUT_AXIS, EditPlan, EditRefusedError, EditRequest, plan_edit
from linkwright.diagnostics import Diagnostic
from linkwright.geometry.single import Pose
from linkwright.urdf import Robot
from linkwright.xmltree import Element, Overlay
from tests.corpora import OWN, Model

XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


def edit_text(folder: Path, text: str, request: EditRequest, **files: str) -> str:
    """Return the text of the only changed file after an edit."""
    path = folder / "robot.urdf.xacro"
    path.write_bytes(text.encode())
    for name, content in files.items():
        (folder / name.replace("_", ".")).write_text(content)
    plan = plan_edit(examine(path), request)
    (changed,) = plan.texts.values()
    return changed


def refused(folder: Path, text: str, request: EditRequest) -> Diagnostic:
    path = folder / "robot.urdf.xacro"
    path.write_text(text)
    with pytest.raises(EditRefusedError) as caught:
        plan_edit(examine(path), request)
    return caught.value.diagnostic


def robot_text(body: str, joint: str = '<origin xyz="0 0 0.250"/>') -> str:
    return (
        f'<robot name="r" {XACRO}>\n  {body}\n  <link name="a"/>\n  <link name="b"/>\n'
        f'  <joint name="j" type="revolute">\n    {joint}\n    <parent link="a"/>\n    <child link="b"/>\n'
        f'    <limit lower="-1" upper="1" effort="1" velocity="1"/>\n  </joint>\n</robot>\n'
    )


def changed_lines(before: str, after: str) -> list[str]:
    """Return the lines that an edit changes."""
    old = before.splitlines()
    return [line.strip() for line in after.splitlines() if line not in old]


@pytest.mark.parametrize(
    ("body", "joint", "target", "line"),
    [
        ("", '<origin xyz="0  0 0.250"/>', (0, 0, 0.3), '<origin xyz="0  0 0.3"/>'),
        ("", '<origin xyz="0 0 0.250"/>', (0.1, 0, 0.25), '<origin xyz="0.1 0 0.250"/>'),
        ("", "<origin xyz='1e-1 0 0'/>", (0.2, 0.5, 0), "<origin xyz='0.2 0.5 0'/>"),
        ("", '<origin rpy="0 0 1"/>', (0.2, 0, 0), '<origin rpy="0 0 1" xyz="0.2 0 0"/>'),
        ("", '<origin xyz="0 0 ${0.25}"/>', (0, 0, 0.3), '<origin xyz="0 0 ${0.3}"/>'),
        (
            '<xacro:property name="h" value="0.25"/>',
            '<origin xyz="0 0 ${h}"/>',
            (0, 0, 0.3),
            '<xacro:property name="h" value="0.3"/>',
        ),
        (
            '<xacro:property name="h" value="0.5"/>',
            '<origin xyz="0 0 ${h/2 - 0}"/>',
            (0, 0, 0.3),
            '<origin xyz="0 0 ${h/2 + 0.05}"/>',
        ),
        (
            '<xacro:property name="h" value="0.5"/>',
            '<origin xyz="0 0 ${-h/2}"/>',
            (0, 0, -0.3),
            '<xacro:property name="h" value="0.6"/>',
        ),
        (
            '<xacro:property name="h" value="0.5"/>',
            '<origin xyz="0 ${h} ${h/2}"/>',
            (0, 0.5, 0.3),
            '<origin xyz="0 ${h} ${h/2 + 0.05}"/>',
        ),
        (
            '<xacro:property name="h" value="0.5"/><xacro:property name="k" value="${h}"/>',
            '<origin xyz="0 0 ${k}"/>',
            (0, 0, 0.3),
            '<xacro:property name="h" value="0.3"/><xacro:property name="k" value="${h}"/>',
        ),
        (
            '<xacro:property name="at" value="1 2 3"/>',
            '<origin xyz="${at}"/>',
            (1, 2.5, 3),
            '<xacro:property name="at" value="1 2.5 3"/>',
        ),
        (
            '<xacro:arg name="h" default="0.5"/>',
            '<origin xyz="0 0 $(arg h)"/>',
            (0, 0, 0.3),
            '<xacro:arg name="h" default="0.3"/>',
        ),
        (
            '<xacro:property name="h" value="0.5"/><gazebo><x>${h}</x></gazebo>',
            '<origin xyz="0 0 ${h if h > 0 else 1}"/>',
            (0, 0, 0.6),
            '<origin xyz="0 0 ${(h if h > 0 else 1) + 0.1}"/>',
        ),
        (
            '<xacro:property name="h" value="0.5"/><gazebo><x>${h}</x></gazebo>',
            '<origin xyz="0 0 -${h}"/>',
            (0, 0, -0.6),
            '<origin xyz="0 0 -0.6"/>',
        ),
    ],
)
def test_position_edit_changes_text_that_produced_it(
    tmp_path: Path, body: str, joint: str, target: tuple[float, ...], line: str
) -> None:
    text = robot_text(body, joint)
    after = edit_text(tmp_path, text, EditRequest("joint", "j", xyz=target))
    assert changed_lines(text, after) == [line]


@pytest.mark.parametrize(
    ("joint", "rpy", "line"),
    [
        ('<origin rpy="0 0 ${pi/2}"/>', (0, 0, math.pi / 4), '<origin rpy="0 0 ${pi/4}"/>'),
        ('<origin rpy="0 0 ${pi/2}"/>', (0, 0, -2 * math.pi / 3), '<origin rpy="0 0 ${-2*pi/3}"/>'),
        ('<origin rpy="0 0 ${pi/2}"/>', (0, 0, math.radians(33)), '<origin rpy="0 0 ${radians(33)}"/>'),
        ('<origin rpy="0 0 ${pi/2}"/>', (0, 0, 0.7), '<origin rpy="0 0 0.7"/>'),
        ('<origin rpy="0 0 ${radians(30)}"/>', (0, 0, math.radians(12.5)), '<origin rpy="0 0 ${radians(12.5)}"/>'),
        ('<origin rpy="0 0 ${-90*pi/180}"/>', (0, 0, math.radians(45)), '<origin rpy="0 0 ${45*pi/180}"/>'),
        ('<origin rpy="0 0 1.5708"/>', (0, 0, math.radians(45)), '<origin rpy="0 0 0.785398163"/>'),
        ('<origin xyz="0 0 1"/>', (0, 0, 0.5), '<origin xyz="0 0 1" rpy="0 0 0.5"/>'),
    ],
)
def test_angles_keep_their_notation(tmp_path: Path, joint: str, rpy: tuple[float, ...], line: str) -> None:
    text = robot_text("", joint)
    assert changed_lines(text, edit_text(tmp_path, text, EditRequest("joint", "j", rpy=rpy))) == [line]


def test_quaternion_is_kept(tmp_path: Path) -> None:
    text = robot_text("", '<origin quat_xyzw="0 0 0 1"/>')
    after = edit_text(tmp_path, text, EditRequest("joint", "j", rpy=(0, 0, math.pi / 2)))
    assert changed_lines(text, after) == ['<origin quat_xyzw="0 0 0.707106781 0.707106781"/>']


def test_unchanged_value_plans_no_edit(tmp_path: Path) -> None:
    path = tmp_path / "robot.urdf"
    path.write_text(robot_text(""))
    assert plan_edit(examine(path), EditRequest("joint", "j", xyz=(0, 0, 0.25), rpy=(0, 0, 0))).texts == {}


def test_missing_origin_and_axis_are_inserted_with_indentation(tmp_path: Path) -> None:
    text = robot_text("", "").replace("\n", "\r\n").replace("    ", "\t\t")
    after = edit_text(tmp_path, text, EditRequest("joint", "j", xyz=(0, 0, 0.5)))
    assert '\r\n\t\t<origin xyz="0 0 0.5"/>\r\n\t\t<parent' in after
    assert "\n" not in after.replace("\r\n", "")
    after = edit_text(tmp_path, text, EditRequest("axis", "j", xyz=(0, 0, 1)))
    assert '<child link="b"/>\r\n\t\t<axis xyz="0 0 1"/>\r\n' in after


def test_zero_axis_is_rejected(tmp_path: Path) -> None:
    assert refused(tmp_path, robot_text(""), EditRequest("axis", "j", xyz=(0, 0, 0))).code == "EDIT102"


WHEELS = f"""<robot name="r" {XACRO}>
  <xacro:macro name="wheel" params="side y at:='0 0 0'">
    <link name="${{side}}"><visual><origin xyz="${{at}}"/><geometry><sphere radius="0.1"/></geometry></visual></link>
    <joint name="${{side}}_joint" type="fixed">
      <origin xyz="0.1 ${{y}} ${{lift * 2}}"/><parent link="base"/><child link="${{side}}"/>
    </joint>
  </xacro:macro>
  <xacro:property name="lift" value="0.05"/>
  <link name="base"/>
  <xacro:wheel side="left" y="0.2"/>
  <xacro:wheel side="right" y="${{-0.2}}"/>
</robot>
"""


def test_macro_argument_is_edited_in_macro_call(tmp_path: Path) -> None:
    after = edit_text(tmp_path, WHEELS, EditRequest("joint", "left_joint", xyz=(0.1, 0.3, 0.1)))
    assert changed_lines(WHEELS, after) == ['<xacro:wheel side="left" y="0.3"/>']
    after = edit_text(tmp_path, WHEELS, EditRequest("joint", "right_joint", xyz=(0.1, 0.05, 0.1)))
    assert changed_lines(WHEELS, after) == ['<xacro:wheel side="right" y="${0.05}"/>']


def test_macro_call_relying_on_default_gets_argument(tmp_path: Path) -> None:
    after = edit_text(tmp_path, WHEELS, EditRequest("visual", "left", xyz=(0, 0, 0.4)))
    assert changed_lines(WHEELS, after) == ['<xacro:wheel side="left" y="0.2" at="0 0 0.4"/>']


def test_edit_of_repeated_macro_text_is_rejected_with_side_effects(tmp_path: Path) -> None:
    diagnostic = refused(tmp_path, WHEELS, EditRequest("joint", "left_joint", xyz=(0.1, 0.2, 0.3)))
    assert diagnostic.code == "EDIT104"
    assert "joint 'right_joint'" in diagnostic.message
    assert diagnostic.span is not None
    assert diagnostic.span.line == 5
    assert [note.span.line for note in diagnostic.notes if note.span] == [8, 5]
    assert "'0.05'" in diagnostic.notes[0].message


def test_rejection_names_text_with_fewest_side_effects(tmp_path: Path) -> None:
    """The text of the sum in the macro is named.

    It affects fewer joints than the shared length.
    """
    joint = '<origin xyz="${lift} 0 0"/><parent link="base"/><child link="tip"/>'
    tip_joint = f'<link name="tip"/>\n  <joint name="far" type="fixed">{joint}</joint>\n</robot>'
    text = WHEELS.replace("</robot>", tip_joint)
    diagnostic = refused(tmp_path, text, EditRequest("joint", "left_joint", xyz=(0.1, 0.2, 0.3)))
    assert "joint 'right_joint'" in diagnostic.message
    assert "far" not in diagnostic.message
    assert any("joint 'far'" in note.message for note in diagnostic.notes)


SIDES = f"""<robot name="r" {XACRO}>
  <xacro:macro name="arm" params="side reflect">
    <link name="${{side}}"/>
    <joint name="${{side}}_joint" type="continuous">
      <origin xyz="0 ${{reflect * 0.2}} 0"/><parent link="base"/><child link="${{side}}"/>
      <axis xyz="0 ${{reflect}} 0"/>
    </joint>
  </xacro:macro>
  <link name="base"/>
  <xacro:arm side="left" reflect="1"/>
  <xacro:arm side="right" reflect="-1"/>
</robot>
"""


def test_edit_with_equal_side_effects_keeps_side_argument(tmp_path: Path) -> None:
    request = EditRequest("axis", "left_joint", xyz=(0, 0.8, 0))
    assert "joint 'right_joint'" in refused(tmp_path, SIDES, request).message
    (tmp_path / "robot.urdf.xacro").write_text(SIDES)
    plan = plan_edit(examine(tmp_path / "robot.urdf.xacro"), replace(request, together=True))
    assert plan.side_effects == ("joint 'right_joint'",)
    assert changed_lines(SIDES, *plan.texts.values()) == ['<axis xyz="0 ${reflect - 0.2} 0"/>']


def test_together_option_edits_all_affected_elements(tmp_path: Path) -> None:
    path = tmp_path / "robot.urdf.xacro"
    path.write_text(WHEELS)
    plan = plan_edit(examine(path), EditRequest("joint", "left_joint", xyz=(0.1, 0.2, 0.3), together=True))
    assert plan.side_effects == ("joint 'right_joint'",)
    assert changed_lines(WHEELS, *plan.texts.values()) == ['<xacro:property name="lift" value="0.15"/>']


def test_factor_selecting_side_is_kept(tmp_path: Path) -> None:
    text = WHEELS.replace('side="left" y="0.2"', 'side="left" y="1"').replace('y="${{-0.2}}"', 'y="-1"')
    text = text.replace("0.1 ${y}", "0.1 ${y * 0.3}").replace('y="${-0.2}"', 'y="-1"')
    diagnostic = refused(tmp_path, text, EditRequest("joint", "left_joint", xyz=(0.1, 0.25, 0.1)))
    assert any("selects a side" in note.message for note in diagnostic.notes)


def test_property_used_by_plugin_is_kept(tmp_path: Path) -> None:
    body = '<xacro:property name="h" value="0.5"/>\n  <gazebo><plugin name="p"><height>${h}</height></plugin></gazebo>'
    text = robot_text(body, '<origin xyz="0 0 ${h}"/>')
    after = edit_text(tmp_path, text, EditRequest("joint", "j", xyz=(0, 0, 0.6)))
    assert changed_lines(text, after) == ['<origin xyz="0 0 ${h + 0.1}"/>']


def test_value_from_yaml_file_is_edited_there(tmp_path: Path) -> None:
    body = '<xacro:property name="c" value="${xacro.load_yaml(\'sizes.yaml\')}"/>'
    text = robot_text(body, "<origin xyz=\"0 0 ${c['mast']['height']}\" rpy=\"${c['mast']['tilt']} 0 0\"/>")
    sizes = "base: {height: 1}  # wide\nmast:\n  height: 0.250  # high\n  tilt: !degrees 10\n"
    assert edit_text(tmp_path, text, EditRequest("joint", "j", xyz=(0, 0, 0.3)), sizes_yaml=sizes) == sizes.replace(
        "0.250", "0.3"
    )
    turned = EditRequest("joint", "j", rpy=(math.radians(20), 0, 0))
    assert edit_text(tmp_path, text, turned, sizes_yaml=sizes) == sizes.replace("10", "20")


def test_block_is_edited_in_macro_call(tmp_path: Path) -> None:
    text = f"""<robot name="r" {XACRO}>
  <xacro:macro name="mount" params="name *origin"><link name="${{name}}"/>
    <joint name="${{name}}_joint" type="fixed"><xacro:insert_block name="origin"/>
      <parent link="base"/><child link="${{name}}"/></joint></xacro:macro>
  <link name="base"/>
  <xacro:mount name="one"><origin xyz="0 0 1"/></xacro:mount>
  <xacro:mount name="two"><origin xyz="0 0 1"/></xacro:mount>
</robot>
"""
    after = edit_text(tmp_path, text, EditRequest("joint", "two_joint", xyz=(0, 0, 2)))
    assert changed_lines(text, after) == ['<xacro:mount name="two"><origin xyz="0 0 2"/></xacro:mount>']


def test_included_file_is_edited_only_if_writable(tmp_path: Path) -> None:
    (tmp_path / "part.xacro").write_text(f'<robot {XACRO}><xacro:property name="h" value="0.5"/></robot>')
    text = robot_text('<xacro:include filename="part.xacro"/>', '<origin xyz="0 0 ${h}"/>')
    path = tmp_path / "robot.urdf.xacro"
    path.write_text(text)
    request = EditRequest("joint", "j", xyz=(0, 0, 0.6))
    part = os.path.realpath(tmp_path / "part.xacro")
    assert list(plan_edit(examine(path), request).texts) == [part]

    rejection = Diagnostic("EDIT106", "no")
    plan = plan_edit(examine(path), request, lambda file: rejection if file == part else None)
    assert changed_lines(text, *plan.texts.values()) == ['<origin xyz="0 0 ${h + 0.1}"/>']
    with pytest.raises(EditRefusedError) as caught:
        plan_edit(examine(path), request, lambda _: rejection)
    assert caught.value.diagnostic is rejection


def test_missing_elements_and_infinite_values_are_rejected(tmp_path: Path) -> None:
    assert refused(tmp_path, robot_text(""), EditRequest("joint", "k", xyz=(0, 0, 1))).code == "EDIT101"
    assert refused(tmp_path, robot_text(""), EditRequest("visual", "a", 0, xyz=(0, 0, 1))).code == "EDIT101"
    assert refused(tmp_path, robot_text(""), EditRequest("joint", "j", xyz=(0, 0, math.inf))).code == "EDIT102"
    with pytest.raises(EditRefusedError):
        plan_edit(examine(robot_text("")), EditRequest("joint", "j", xyz=(0, 0, 1)))


# --- the robots of the corpus -----------------------------------------------------------------------------------------


def parts_of(robot_model: Robot) -> list[tuple[Any, str, int]]:
    parts: list[tuple[Any, str, int]] = [("joint", name, 0) for name in robot_model.joints]
    parts += [("axis", name, 0) for name, joint in robot_model.joints.items() if joint.type not in WITHOUT_AXIS]
    for link in robot_model.links.values():
        parts += [("visual", link.name, i) for i in range(len(link.visuals))]
        parts += [("collision", link.name, i) for i in range(len(link.collisions))]
        parts += [("inertial", link.name, 0)] if link.inertial is not None else []
    return parts


def apply_edit(robot_model: Robot, request: EditRequest) -> Robot:
    """Return the robot that an edit should produce."""
    assert request.xyz is not None
    x, y, z = request.xyz
    name, i = request.name, request.index
    if request.part == "axis":
        joint = replace(robot_model.joints[name], axis=(x, y, z))
        return replace(robot_model, joints={**robot_model.joints, name: joint})
    if request.part == "joint":
        joint = replace(robot_model.joints[name], origin=moved_origin(robot_model.joints[name].origin, request))
        return replace(robot_model, joints={**robot_model.joints, name: joint})
    link = robot_model.links[name]
    if request.part == "inertial":
        assert link.inertial is not None
        inertial = replace(link.inertial, origin=moved_origin(link.inertial.origin, request))
        return replace(robot_model, links={**robot_model.links, name: replace(link, inertial=inertial)})
    field = f"{request.part}s"
    shapes = list(getattr(link, field))
    shapes[i] = replace(shapes[i], origin=moved_origin(shapes[i].origin, request))
    return replace(robot_model, links={**robot_model.links, name: replace(link, **{field: tuple(shapes)})})


def moved_origin(origin: Pose, request: EditRequest) -> Pose:
    assert request.xyz is not None
    x, y, z = request.xyz
    rpy = origin.rpy if request.rpy is None else (request.rpy[0], request.rpy[1], request.rpy[2])
    return Pose((x, y, z), rpy)


def round_value(value: Any) -> Any:
    """Round poses and axes to the nanometer, so that robots can be compared."""
    if isinstance(value, float):
        return round(value, 7) + 0.0
    if isinstance(value, dict):
        return {key: round_value(member) for key, member in value.items()}
    return tuple(map(round_value, value)) if isinstance(value, (tuple, list)) else value


def robot_facts(robot_model: Robot) -> Any:
    joints = {
        name: (joint.type, joint.parent, joint.child, joint.origin.xyz, joint.origin.rpy, joint.axis)
        for name, joint in robot_model.joints.items()
    }
    links = {
        name: [
            [
                (shape.name, shape.origin.xyz, shape.origin.rpy, repr(shape.geometry))
                for shape in (*link.visuals, *link.collisions)
            ]
        ]
        for name, link in robot_model.links.items()
    }
    masses = {
        name: (link.inertial.mass, link.inertial.origin.xyz, link.inertial.origin.rpy)
        for name, link in robot_model.links.items()
        if link.inertial is not None
    }
    return round_value(joints), round_value(links), round_value(masses)


def without_edits(root: Element) -> Iterator[tuple[str, dict[str, str], str]]:
    """Return a document without origins and axes."""
    for element in root.walk():
        if element.tag not in ("origin", "axis"):
            yield element.tag, element.attributes, " ".join(element.text().split())


def describe_model(model: Model) -> Description:
    return examine(model.path, arguments=model.arguments, packages=model.packages)


def planned(before: Description, request: EditRequest) -> EditPlan | Diagnostic:
    try:
        return plan_edit(before, request)
    except EditRefusedError as refusal:
        return refusal.diagnostic


ROBOTS = [model for model in OWN.models if model.data["links"]]
NUMBERS = st.integers(-2000, 2000).map(lambda number: number / 1000)


def test_joint_without_axis_has_no_axis_to_edit(tmp_path: Path) -> None:
    text = robot_text("").replace('type="revolute"', 'type="floating"')
    diagnostic = refused(tmp_path, text, EditRequest("axis", "j", xyz=(0, 0, 1)))
    assert diagnostic.code == "EDIT101"
    assert "'j' has no axis" in diagnostic.message


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.data())
def test_expansion_changes_only_edited_values(data: st.DataObject) -> None:
    model = data.draw(st.sampled_from(ROBOTS))
    before = describe_model(model)
    assert before.robot is not None
    parts = parts_of(before.robot)
    if not parts:
        return
    part, name, index = data.draw(st.sampled_from(parts))
    xyz = data.draw(st.tuples(NUMBERS, NUMBERS, NUMBERS).filter(any))
    rpy = None if part == "axis" else data.draw(st.none() | st.tuples(NUMBERS, NUMBERS, NUMBERS))
    request = EditRequest(part, name, index, xyz=xyz, rpy=rpy)
    plan = planned(before, request)
    if isinstance(plan, Diagnostic):
        assert plan.code in ("EDIT104", "EDIT105")
        assert plan.span is not None
        return
    after = examine(model.path, arguments=model.arguments, packages=model.packages, overlay=Overlay({**plan.texts}))
    assert after.robot is not None
    assert robot_facts(after.robot) == robot_facts(apply_edit(before.robot, request))
    assert list(without_edits(after.document.root)) == list(without_edits(before.document.root))
    assert [text for path, text in plan.old_texts.items() if text == plan.texts[path]] == []
