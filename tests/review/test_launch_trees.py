"""Names that move between a launch file and the files that it includes, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import subject

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PART, CALLER = "arm/launch/part.launch", "arm/launch/arm.launch"
OLD_PART = '<launch><node pkg="arm" type="driver" name="driver"/></launch>\n'
NEW_PART = """<launch>
  <arg name="ns" default="left"/>
  <group ns="$(arg ns)">
    <param name="tf_prefix" value="$(arg ns)_tf"/>
    <node pkg="arm" type="driver" name="driver"/>
  </group>
</launch>
"""
OLD_CALLER = """<launch>
  <group ns="right">
    <param name="tf_prefix" value="right_tf"/>
    <include file="$(find arm)/launch/part.launch"/>
  </group>
</launch>
"""
NEW_CALLER = """<launch>
  <include file="$(find arm)/launch/part.launch">{}</include>
</launch>
"""
LOST_NAMES = "programs that use the names of the node, its topics or its services do not find them"
LOST_FRAMES = "programs that look up the frames by their old names do not find them"


@pytest.fixture
def review_caller(repository, compare):
    """Return the changes of a launch file, with their reasons, when it and its included files change."""

    def run(old: dict[str, str], new: dict[str, str], caller: str = CALLER):
        repository.commit({**MANIFEST, **old})
        repository.write(new)
        changes = subject(compare(repository), caller).changes
        return {str(each.sentence): None if each.reason is None else str(each.reason) for each in changes}

    return run


def review_moved_group(review_caller, argument: str):
    return review_caller({PART: OLD_PART, CALLER: OLD_CALLER}, {PART: NEW_PART, CALLER: NEW_CALLER.format(argument)})


def test_group_that_moves_into_the_included_file_keeps_the_names_and_frames(review_caller):
    reasons = review_moved_group(review_caller, '<arg name="ns" value="right"/>')
    assert set(reasons.values()) == {None}
    assert f"parameter 'tf_prefix' removed: right_tf; {PART} sets it now" in reasons
    assert any(sentence.endswith("right removed; their full names stay the same") for sentence in reasons)


def test_group_that_the_included_file_replaces_by_another_one_is_breaking(review_caller):
    assert {LOST_NAMES, LOST_FRAMES} <= set(review_moved_group(review_caller, "").values())


def test_prefix_of_frames_that_the_included_file_sets_only_under_a_condition_is_breaking(review_caller):
    new_part = NEW_PART.replace("_tf", '_tf" if="$(eval ns == unknown)')
    caller = NEW_CALLER.format('<arg name="ns" value="right"/>')
    reasons = review_caller({PART: OLD_PART, CALLER: OLD_CALLER}, {PART: new_part, CALLER: caller})
    assert LOST_FRAMES in reasons.values()


PYTHON_PART = """from launch import LaunchDescription
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

def generate_launch_description():
    side = LaunchConfiguration("side", default="left")
    return LaunchDescription([Node(package="arm", executable="driver", parameters=[{"side": side}])])
"""
INNER, ALL = "arm/launch/inner.launch.py", "arm/launch/all.launch.xml"
DIRECT = '<include file="$(find-pkg-share arm)/launch/inner.launch.py"><arg name="side" value="right"/></include>'
ALL_TEXT = '<launch>{}<include file="$(find-pkg-share arm)/launch/inner.launch.py"/></launch>\n'
ALL_INCLUDE = '<include file="$(find-pkg-share arm)/launch/all.launch.xml">{}</include>'
TEXT = "<launch>{}</launch>\n"


@pytest.mark.parametrize(
    ("passed", "namespace", "reason"),
    [
        ("right", "", None),
        ("left", "", "its nodes no longer start"),
        ("right", '<push-ros-namespace namespace="robot"/>', LOST_NAMES),
    ],
)
def test_include_that_another_included_file_makes_with_the_same_arguments_is_not_lost(
    review_caller, passed, namespace, reason
):
    caller = "arm/launch/arm.launch.xml"
    files = {INNER: PYTHON_PART, ALL: ALL_TEXT.format(namespace)}
    old = TEXT.format(ALL_INCLUDE.format("") + DIRECT)
    new = TEXT.format(ALL_INCLUDE.format(f'<arg name="side" value="{passed}"/>'))
    reasons = review_caller({**files, caller: old}, {caller: new}, caller)
    (removal,) = [reason for sentence, reason in reasons.items() if "inner.launch.py' removed" in sentence]
    assert removal == reason


REMAP = '<remap from="cmd" to="base/cmd"/>'
CMD_CALLER = '<launch>{}<include file="$(find arm)/launch/part.launch"/></launch>\n'
CMD_PART = '<launch>{}<node pkg="lamp" type="driver" name="driver">{}</node></launch>\n'
LOST_CMD = "if the node publishes or serves 'base/cmd', programs that use it do not find it"


@pytest.mark.parametrize("part", [CMD_PART.format(REMAP, ""), CMD_PART.format("", REMAP)])
def test_remapping_that_moves_into_the_included_file_breaks_nothing(review_caller, part):
    old = {PART: CMD_PART.format("", ""), CALLER: CMD_CALLER.format(REMAP)}
    reasons = review_caller(old, {PART: part, CALLER: CMD_CALLER.format("")})
    line = f"remapping of 'cmd' for the nodes that follow removed: base/cmd; {PART} sets it now"
    assert reasons == {line: None}


def test_remapping_to_another_name_in_the_included_file_is_breaking(review_caller):
    old = {PART: CMD_PART.format("", ""), CALLER: CMD_CALLER.format(REMAP)}
    new = {PART: CMD_PART.format("", REMAP.replace("base", "arm")), CALLER: CMD_CALLER.format("")}
    assert list(review_caller(old, new).values()) == [LOST_CMD]


@pytest.mark.parametrize(
    ("part", "caller", "moved", "line", "reason"),
    [
        (CMD_PART.format("", "{}"), CMD_CALLER, REMAP, "node 'lamp/driver': remapping cmd base/cmd removed", LOST_CMD),
        (CMD_PART.format("{}", ""), CMD_CALLER, REMAP,
         "remapping of 'cmd' for the nodes that follow removed: base/cmd", LOST_CMD),
        (CMD_PART.format("{}", ""), CMD_CALLER, '<param name="tf_prefix" value="left"/>',
         "parameter 'tf_prefix' removed: left", LOST_FRAMES),
    ],
)  # fmt: skip
def test_setting_that_moves_to_the_including_file_is_lost_only_without_it(
    review_caller, part, caller, moved, line, reason
):
    old = {PART: part.format(moved), CALLER: caller.format("")}
    reasons = review_caller(old, {PART: part.format(""), CALLER: caller.format(moved)}, PART)
    assert reasons == {f"{line}; {CALLER} sets it now": f"where the file is started without {CALLER}, {reason}"}


def test_namespace_that_moves_between_an_included_and_an_including_file_changes_only_without_the_latter(review_caller):
    group = '<launch><group ns="left">'
    part, caller = CMD_PART.format("", ""), CMD_CALLER.format("")
    inner = part.replace("<launch>", group).replace("</launch>", "</group></launch>")
    outer = caller.replace("<launch>", group).replace("</launch>", "</group></launch>")
    reasons = review_caller({PART: part, CALLER: outer}, {PART: inner, CALLER: caller}, PART)
    line = f"node 'lamp/driver': namespace left added; {CALLER} no longer sets it"
    assert reasons == {line: f"where the file is started without {CALLER}, {LOST_NAMES}"}


def test_an_argument_of_the_including_file_is_not_that_of_the_included_one(repository, compare):
    part = """<launch>
<arg name="robot" default="door"/>
<include file="$(find other)/$(arg robot).launch"/>
</launch>
"""
    caller = """<launch>
<arg name="robot"/>
<include file="$(find arm)/launch/part.launch"><arg name="robot" value="robot/$(arg robot)"/></include>
</launch>
"""
    repository.commit({**MANIFEST, "arm/launch/part.launch": part, "arm/launch/all.launch": caller})
    repository.write({"arm/launch/all.launch": caller.replace('<arg name="robot" value="robot/$(arg robot)"/>', "")})
    changes = subject(compare(repository), "arm/launch/all.launch").changes
    reasons = " ".join(str(change.reason) for change in changes)
    assert "'$(find other)/robot/$(robot of the including file).launch' no longer starts" in reasons
