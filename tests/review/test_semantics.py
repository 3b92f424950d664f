"""Changes of semantic descriptions (SRDF) in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences, subject

PATH = "arm_description/config/arm.srdf"
SRDF = """<?xml version="1.0"?>
<robot name="arm">
  <group name="manipulator"><chain base_link="base_link" tip_link="lower"/></group>
  <group name="hand"><joint name="left"/><joint name="right"/></group>
  <group_state name="home" group="manipulator"><joint name="upper_joint" value="0"/></group_state>
  <end_effector name="tool" group="hand" parent_link="lower"/>
  <virtual_joint name="fixed" type="fixed" parent_frame="world" child_link="base_link"/>
  <disable_collisions link1="base_link" link2="upper" reason="Adjacent"/>
</robot>
"""
STATE = '  <group_state name="home" group="manipulator"><joint name="upper_joint" value="0"/></group_state>\n'


@pytest.mark.parametrize(
    ("old", "new", "sentence", "reason"),
    [
        ('value="0"', 'value="1.5"', "group_state 'manipulator/home': upper_joint 0 -> 1.5", None),
        ('<joint name="left"/>', '<joint name="middle"/>', "group 'hand': + joint middle, - joint left",
         "programs that move the joint 'left' of the group 'hand' do not find it"),
        ('<joint name="left"/><joint name="right"/>', '<chain base_link="lower" tip_link="tip"/>',
         "group 'hand': + chain lower tip, - joint left, - joint right", None),
        ('<joint name="left"/>', '<joint name="left"/><joint name="middle"/>', "group 'hand': + joint middle", None),
        (STATE, "", "group_state 'manipulator/home' removed: upper_joint 0",
         "programs that move to the state 'manipulator/home' do not find it"),
        ('name="home"', 'name="rest"', "group_state 'manipulator/home' renamed to 'manipulator/rest'",
         "programs that move to the state 'manipulator/home' do not find it"),
        ('<group name="hand"', '<group name="gripper"', "group 'hand' renamed to 'gripper'",
         "programs that plan for the group 'hand' do not find it"),
        ('  <end_effector name="tool" group="hand" parent_link="lower"/>\n', "",
         "end_effector 'tool' removed: group hand, parent_link lower",
         "programs that use the end effector 'tool' do not find it"),
        ('group="hand" parent', 'group="manipulator" parent', "end_effector 'tool': group hand -> manipulator",
         "programs that move the end effector 'tool' move the group 'manipulator' instead of 'hand'"),
        ('parent_frame="world"', 'parent_frame="map"', "virtual_joint 'fixed': parent_frame world -> map",
         "MoveIt no longer plans in the frame 'world'"),
        ('  <virtual_joint name="fixed" type="fixed" parent_frame="world" child_link="base_link"/>\n', "",
         "virtual_joint 'fixed' removed: type fixed, parent_frame world, child_link base_link",
         "MoveIt no longer plans in the frame 'world'"),
        ('tip_link="lower"', 'tip_link="tool"', "group 'manipulator': + chain base_link tool, - chain base_link lower",
         "pose goals for the group 'manipulator' that name no link move 'tool' instead of 'lower'"),
        ('<chain base_link="base_link"', '<chain base_link="upper"',
         "group 'manipulator': + chain upper lower, - chain base_link lower", None),
        ('type="fixed" parent', 'type="planar" parent', "virtual_joint 'fixed': type fixed -> planar", None),
        ("</robot>", '  <disable_collisions link1="upper" link2="lower" reason="Never"/>\n</robot>',
         "disable_collisions: 1 pair added: lower - upper", None),
        ('  <disable_collisions link1="base_link" link2="upper" reason="Adjacent"/>\n', "",
         "disable_collisions: 1 pair removed: base_link - upper", None),
    ],
)  # fmt: skip
def test_changes_of_a_semantic_description(package, compare, old, new, sentence, reason):
    package.commit({PATH: SRDF})
    package.write({PATH: SRDF.replace(old, new)})
    (change,) = subject(compare(package), PATH).changes
    assert str(change.sentence) == sentence
    assert (None if change.reason is None else str(change.reason)) == reason


@pytest.mark.parametrize("value", ["0", "1.5"])
def test_state_without_a_group_had_no_users(package, compare, value):
    package.commit({PATH: SRDF.replace('name="home" group=', 'name="home" grup=')})
    package.write({PATH: SRDF.replace('value="0"', f'value="{value}"')})
    changes = subject(compare(package), PATH).changes
    assert "group_state" in str(changes[0].sentence)
    assert not any(change.reason for change in changes)


def test_joint_that_becomes_passive_is_not_breaking(package, compare):
    package.commit({PATH: SRDF})
    text = SRDF.replace('<joint name="left"/>', "")
    package.write({PATH: text.replace("</robot>", '<passive_joint name="left"/></robot>')})
    assert [change.reason for change in subject(compare(package), PATH).changes if change.reason] == []


GROUP_OF_JOINTS = """<robot name="arm"><group name="all">{members}<joint name="j1"/><joint name="j2"/></group></robot>
"""
TREE = """<robot name="arm"><link name="a"/><link name="b"/><link name="c"/>
  <joint name="${prefix}j1" type="revolute"><parent link="${prefix}a"/><child link="${prefix}b"/></joint>
  <joint name="${prefix}j2" type="revolute"><parent link="${prefix}b"/><child link="${prefix}c"/></joint>
</robot>
"""


@pytest.mark.parametrize(
    ("members", "lost"),
    [
        ('<chain base_link="a" tip_link="c"/>', []),
        ('<link name="b"/><link name="c"/>', []),
        ('<chain base_link="b" tip_link="c"/>', ["j1"]),
        ('<link name="b"/>', ["j2"]),
        ('<chain base_link="a" tip_link="part_of_another_repository"/>', []),
    ],
)
def test_joints_that_a_chain_or_link_of_the_group_brings_are_not_lost(package, compare, members, lost):
    package.commit({PATH: GROUP_OF_JOINTS.replace("{members}", members), "arm_description/urdf/tree.xacro": TREE})
    package.write({PATH: f'<robot name="arm"><group name="all">{members}</group></robot>'})
    (change,) = subject(compare(package), PATH).changes
    names = [] if change.reason is None else [name for name in ("j1", "j2") if f"'{name}'" in str(change.reason)]
    assert names == lost


def test_joints_of_a_group_in_the_group_are_not_lost(package, compare):
    text = GROUP_OF_JOINTS.replace("{members}", '<group name="part"/>')
    part = '<group name="part"><joint name="j1"/></group></robot>'
    package.commit({PATH: text.replace("</robot>", part)})
    package.write({PATH: text.replace("</robot>", part).replace('<joint name="j1"/><joint name="j2"/>', "", 1)})
    (change,) = subject(compare(package), PATH).changes
    assert str(change.reason) == "programs that move the joint 'j2' of the group 'all' do not find it"


def test_passive_joints_are_one_line(package, compare):
    package.commit({PATH: SRDF})
    joints = "".join(f'<passive_joint name="{name}"/>' for name in ("a", "b", "c"))
    package.write({PATH: SRDF.replace("</robot>", f"{joints}</robot>")})
    (change,) = subject(compare(package), PATH).changes
    assert (str(change.sentence), change.other_names) == ("passive_joint 'a' added", ("b", "c"))


def test_fixed_joint_that_leaves_a_group_is_not_breaking(package, compare):
    package.commit({PATH: SRDF, "arm_description/urdf/hand.xacro": '<robot><joint type="fixed" name="left"/></robot>'})
    package.write({PATH: SRDF.replace('<joint name="left"/>', "")})
    (change,) = subject(compare(package), PATH).changes
    assert str(change.sentence) == "group 'hand': - joint left"
    assert change.reason is None


@pytest.mark.parametrize(
    ("old", "new"),
    [('value="0"', 'value="0.0"'), ('link1="base_link" link2="upper"', 'link1="upper" link2="base_link"')],
)
def test_other_writing_is_no_change(package, compare, old, new):
    package.commit({PATH: SRDF})
    package.write({PATH: SRDF.replace(old, new)})
    assert compare(package).subjects == []


def test_removed_file_is_breaking(package, compare):
    package.commit({PATH: SRDF})
    package.write({PATH: None})
    (change,) = subject(compare(package), PATH).changes
    assert change.reason is not None


def test_group_in_a_macro_that_is_removed_is_breaking(package, compare):
    path = "arm_description/config/arm.srdf.xacro"
    group = '<group name="${prefix}arm"><chain base_link="base_link" tip_link="lower"/></group>'
    text = f"""<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="arm_srdf" params="prefix">{group}</xacro:macro>
</robot>"""
    package.commit({path: text})
    package.write({path: text.replace(group, "")})
    (change,) = subject(compare(package), path).changes
    assert (
        str(change.sentence) == "macro 'arm_srdf': group ${prefix}arm removed: chain base_link=base_link tip_link=lower"
    )
    assert str(change.reason) == "programs that plan for the group '${prefix}arm' do not find it"


MACROS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="allow" params="first second"><disable_collisions link1="${first}" link2="${second}"/></xacro:macro>
</robot>"""
CALLS = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="macros.xacro"/>
  <xacro:allow first="base_link" second="lower"/>
  <xacro:allow first="base_link" second="upper"/>
</robot>"""
LOOP = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:include filename="macros.xacro"/>
  <xacro:property name="links" value="${['lower', 'upper']}"/>
  <xacro:macro name="rest" params="links">
    <xacro:if value="${len(links) > 0}">
      <xacro:allow first="base_link" second="${links[0]}"/>
      <xacro:rest links="${links[1:]}"/>
    </xacro:if>
  </xacro:macro>
  <xacro:rest links="${links}"/>
</robot>"""
CALLED = "arm_description/config/arm.srdf.xacro"
DEFINED = "arm_description/config/macros.xacro"


@pytest.fixture
def calls(package):
    package.commit({CALLED: CALLS, DEFINED: MACROS})
    return package


def test_renamed_links_and_joints_are_known_before_groups_are_compared(package, compare):
    """Everything that only follows the new prefix has no line."""
    names = ("upper_joint", "left", "right", "upper", "lower", "base_link")
    prefixed = SRDF
    for name in names:
        prefixed = prefixed.replace(f'"{name}"', f'"arm_{name}"')
    prefixed = prefixed.replace("manipulator", "arm").replace('value="0"', 'value="1.5"')
    package.commit({PATH: SRDF})
    package.write({PATH: prefixed})
    result = compare(package)
    assert sentences(subject(result, PATH)) == [
        (
            "links and joints renamed: left -> arm_left, base_link -> arm_base_link, lower -> arm_lower, "
            "right -> arm_right and 2 more"
        ),
        "group_state 'arm/home': arm_upper_joint 0 -> 1.5",
        "group 'manipulator' renamed to 'arm'",
    ]


def test_other_spelling_of_the_same_expansion_is_no_change(calls, compare):
    calls.write({CALLED: LOOP})
    assert [sentences(part) for part in compare(calls).subjects] == []


def test_included_file_changes_the_semantic_description(calls, compare):
    calls.write({DEFINED: MACROS.replace('link2="${second}"', 'link2="${second}_link"')})
    assert sentences(subject(compare(calls), CALLED)) == [
        "links and joints renamed: lower -> lower_link, upper -> upper_link",
    ]


def test_semantic_description_that_xacro_refuses_is_breaking(calls, compare):
    calls.write({DEFINED: MACROS.replace("${first}", "${first.__class__}")})
    result = compare(calls)
    (change,) = subject(result, CALLED).changes
    assert str(change.sentence).startswith("can no longer be read: arm_description/config/macros.xacro:2: ")
    assert change.reason is not None


@pytest.mark.parametrize("start", ["<!-- made by the assistant -->\n", "\n", "  "])
def test_a_semantic_description_is_read_as_moveit_does(repository, compare, start):
    repository.commit({PATH: start + SRDF})
    repository.write({PATH: start + SRDF.replace('value="0"', 'value="1.5"')})
    assert sentences(subject(compare(repository), PATH)) == ["group_state 'manipulator/home': upper_joint 0 -> 1.5"]


def test_files_that_cannot_be_read_for_the_same_reason_are_one_note(repository, compare):
    paths = [PATH.replace("arm.srdf", f"{name}.srdf") for name in ("a", "b", "c")]
    repository.commit(dict.fromkeys(paths, SRDF.replace("</robot>", "</robots>")))
    repository.write(dict.fromkeys(paths, SRDF.replace("</robot>", "</robots>").replace('"0"', '"1"')))
    result = compare(repository)
    assert result.subjects == []
    (note,) = result.notes
    assert str(note).startswith(f"3 changed files are not compared, such as '{paths[0]}': neither version can be read")


def test_many_pairs_of_a_lost_link_are_summarized(package, compare):
    pair = '  <disable_collisions link1="%s" link2="%s" reason="Never"/>\n'
    pairs = [("cover", f"link_{number}") for number in range(24)]
    kept = "".join(pair % ("base_link", f"link_{number}") for number in range(24))
    text = SRDF.replace("</robot>", f"{kept}%s</robot>")
    package.commit({PATH: text % "".join(pair % names for names in [*pairs, ("link_0", "link_1")])})
    package.write({PATH: text % ""})
    assert sentences(subject(compare(package), PATH)) == [
        "disable_collisions: 25 pairs removed: 24 with cover, link_0 - link_1"
    ]


@pytest.mark.parametrize(
    ("links", "text"), [(["a"], "24 pairs added: all with a"), (["a", "b"], "48 pairs added: all with one of a, b")]
)
def test_many_pairs_of_new_links_need_not_be_all_pairs_of_them(package, compare, links, text):
    """The new links have no pair with base_link."""
    pair = '  <disable_collisions link1="%s" link2="%s" reason="Never"/>\n'
    others = [f"link_{number}" for number in range(24)]
    kept = "".join(pair % ("base_link", other) for other in others)
    package.commit({PATH: SRDF.replace("</robot>", f"{kept}</robot>")})
    added = "".join(pair % (link, other) for link in links for other in others)
    package.write({PATH: SRDF.replace("</robot>", f"{kept}{added}</robot>")})
    assert sentences(subject(compare(package), PATH)) == [f"disable_collisions: {text}"]


def test_very_many_pairs_are_counted_by_their_links(package, compare):
    pair = '  <disable_collisions link1="%s" link2="%s" reason="Never"/>\n'
    links = [f"link_{number}" for number in range(12)]
    kept = "".join(pair % ("base_link", link) for link in links)
    text = SRDF.replace("</robot>", f"{kept}%s</robot>")
    package.commit({PATH: text % ""})
    pairs = [(link, other) for link in links for other in links if link < other]
    package.write({PATH: text % "".join(pair % names for names in pairs)})
    (line,) = sentences(subject(compare(package), PATH))
    counts = [int(item.split(" ")[0]) for item in line.split(": ")[2].split(", ")]
    assert sum(counts) == len(pairs)
    assert line.startswith(f"disable_collisions: {len(pairs)} pairs added: 11 with link_0, 10 with link_1, ")


def test_renamed_virtual_joint_is_renamed_in_the_groups_that_have_it(package, compare):
    """Programs do not move a fixed joint."""
    text = SRDF.replace('<joint name="left"/>', '<joint name="left"/><joint name="fixed"/>')
    package.commit({PATH: text})
    package.write({PATH: text.replace('"fixed"', '"to_world"').replace('type="to_world"', 'type="fixed"')})
    (change,) = subject(compare(package), PATH).changes
    assert str(change.sentence) == "virtual_joint 'fixed' renamed to 'to_world'"
    assert change.reason is None


def test_renamed_virtual_joint_that_moves_is_breaking(package, compare):
    text = SRDF.replace('type="fixed"', 'type="planar"')
    package.commit({PATH: text})
    package.write({PATH: text.replace('"fixed"', '"to_world"')})
    (change,) = subject(compare(package), PATH).changes
    assert str(change.reason) == "controllers and programs that name the joint 'fixed' do not find it"


TWO_HANDS = """<robot name="arms">
  <group name="hands"><link name="palm"/></group>
  <end_effector name="left" group="hands" parent_link="l_hand"/>
  <end_effector name="right" group="hands" parent_link="r_hand"/>
</robot>
"""


def test_an_end_effector_that_follows_the_new_name_of_its_group_is_no_other_one(package, compare):
    package.commit({PATH: SRDF})
    package.write({PATH: SRDF.replace('"hand"', '"gripper"')})
    changes = subject(compare(package), PATH).changes
    reasons = [str(change.reason) for change in changes if "end_effector" in str(change.sentence)]
    assert reasons == ["None"]


OTHER_LINKS = TWO_HANDS.replace("_hand", "_tip")
REASON = "grasps of the end effector 'left' move 'l_tip' instead of 'l_hand' to their poses"


def test_links_that_a_group_gets_in_addition_are_not_renamed(package, compare):
    """An end effector with another parent link has grasps with another meaning."""
    package.commit({PATH: TWO_HANDS})
    package.write({PATH: OTHER_LINKS.replace('<link name="palm"/>', '<link name="l_tip"/><link name="r_tip"/>')})
    changes = subject(compare(package), PATH).changes
    assert "end_effector 'left': parent_link l_hand -> l_tip" in [str(change.sentence) for change in changes]
    assert REASON in [str(change.reason) for change in changes]


def test_links_that_both_robots_have_are_not_renamed(package, compare):
    names = ("l_hand", "r_hand", "l_tip", "r_tip")
    robot = '<robot name="arms">' + "".join(f'<link name="{name}"/>' for name in names) + "</robot>"
    package.commit({PATH: TWO_HANDS, "arm_description/urdf/arms.urdf": robot})
    package.write({PATH: OTHER_LINKS})
    assert sentences(subject(compare(package), PATH)) == [
        "end_effector 'left': parent_link l_hand -> l_tip",
        "end_effector 'right': parent_link r_hand -> r_tip",
    ]


def test_links_with_other_names_in_the_same_places_are_renamed(package, compare):
    package.commit({PATH: TWO_HANDS})
    package.write({PATH: OTHER_LINKS})
    assert sentences(subject(compare(package), PATH)) == ["links and joints renamed: l_hand -> l_tip, r_hand -> r_tip"]
