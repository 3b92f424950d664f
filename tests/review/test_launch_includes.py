"""Changes of what launch files start through the files that they include, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

PART = """<launch>
  <arg name="camera" default="true"/>
  <node pkg="arm" type="camera.py" name="camera" if="$(arg camera)"/>
</launch>
"""
MODEL = '<launch><param name="robot_description" textfile="arm.urdf"/></launch>'
FILE = """<launch>
  <arg name="camera" default="true"/>
  <include file="$(find elsewhere)/launch/safety.launch"/>
  <include file="$(dirname)/part.launch"><arg name="camera" value="$(arg camera)"/></include>
  <include file="$(dirname)/model.launch"/>
  <include file="$(find elsewhere)/launch/laser_pipeline.launch"><arg name="scan" value="front"/></include>
  <include file="$(find elsewhere)/launch/rviz.launch"/>
</launch>
"""
SAFETY, PART_INCLUDE, MODEL_INCLUDE, LASER, RVIZ = (line + "\n" for line in FILE.splitlines()[2:7])
STOPS = "its nodes no longer start"
CAMERA_STOPS = "by default, 'arm/camera.py' no longer starts"


@pytest.fixture
def review_reasons(repository, compare):
    """Review a replacement in a launch file that includes others.

    Return the changes with their reasons.
    """

    def run(old: str, new: str):
        assert old in FILE
        files = {"arm/launch/part.launch": PART, "arm/launch/model.launch": MODEL}
        repository.commit({"arm/launch/arm.launch": FILE, **files})
        repository.write({"arm/launch/arm.launch": FILE.replace(old, new)})
        changes = subject(compare(repository), "arm/launch/arm.launch").changes
        return {str(each.sentence): None if each.reason is None else str(each.reason) for each in changes}

    return run


@pytest.mark.parametrize(
    ("line", "reason"),
    [(SAFETY, STOPS), (PART_INCLUDE, STOPS), (MODEL_INCLUDE, None), (LASER, STOPS), (RVIZ, None)],
)
def test_removed_include_is_breaking_if_its_nodes_start_by_default(review_reasons, line, reason):
    assert list(review_reasons(line, "").values()) == [reason]


def test_removed_include_is_not_breaking_if_its_nodes_were_switched_off(repository, compare):
    text = FILE.replace('default="true"', 'default="false"')
    repository.commit({"arm/launch/arm.launch": text, "arm/launch/part.launch": PART})
    repository.write({"arm/launch/arm.launch": text.replace(PART_INCLUDE, "")})
    (change,) = subject(compare(repository), "arm/launch/arm.launch").changes
    assert change.reason is None


def test_removed_include_is_not_breaking_if_the_file_starts_its_nodes(review_reasons):
    node = '  <node pkg="arm" type="camera.py" name="camera"/>\n'
    assert set(review_reasons(PART_INCLUDE, node).values()) == {None}


def test_include_of_a_file_with_the_same_role_replaces_another(review_reasons):
    found = review_reasons(LASER, '  <include file="$(find elsewhere)/launch/pipeline.launch"/>\n')
    assert set(found.values()) == {None}
    assert (
        "include of '$(find elsewhere)/launch/laser_pipeline.launch' replaced by "
        "include of '$(find elsewhere)/launch/pipeline.launch'"
    ) in found


def test_include_of_a_file_with_another_role_does_not_replace_it(review_reasons):
    found = review_reasons(SAFETY, '  <include file="$(find elsewhere)/launch/mux.launch"/>\n')
    assert list(found.values()) == [None, STOPS]


DRIVER = """<launch>
  <arg name="host" default="a"/>
  <arg name="target" default="b"/>
  <arg name="mode"/>
  <include file="$(find laser)/old.launch">
    <arg name="host" value="$(arg host)"/>
    <arg name="target" value="$(arg target)"/>
    <arg name="mode" value="$(arg mode)"/>
  </include>
</launch>
"""
TARGET = '    <arg name="target" value="$(arg target)"/>\n'


def _find_driver_changes(repository, compare, text: str):
    repository.commit({"arm/launch/arm.launch": DRIVER})
    repository.write({"arm/launch/arm.launch": text})
    changes = subject(compare(repository), "arm/launch/arm.launch").changes
    return {str(each.sentence): None if each.reason is None else str(each.reason) for each in changes}


def test_include_of_another_file_of_a_package_with_most_arguments_replaces_the_old_one(repository, compare):
    file = "$(find laser)/launch/sensor.launch"
    found = _find_driver_changes(
        repository, compare, DRIVER.replace("$(find laser)/old.launch", file).replace(TARGET, "")
    )
    assert found == {
        f"include of '$(find laser)/old.launch' replaced by include of '{file}'": None,
        f"include of '{file}': target $(arg target) removed": None,
        "argument 'target' is no longer used": "a value that a caller passes for 'target' has no effect",
    }


@pytest.mark.parametrize(
    "text",
    [
        DRIVER.replace("laser)/old.launch", "camera)/start.launch"),
        DRIVER.replace("laser)/old.launch", "laser)/start.launch").replace("mode)", "host)").replace(TARGET, ""),
    ],
)
def test_include_of_another_package_or_with_other_arguments_does_not_replace_the_old_one(repository, compare, text):
    assert STOPS in _find_driver_changes(repository, compare, text).values()


@pytest.mark.parametrize(
    ("old", "new", "is_replaced"),
    [
        ("ros_ign_gazebo)/launch/ign_gazebo", "ros_gz_sim)/launch/gz_sim", True),
        ("arm_worlds)/launch/empty", "gazebo_ros)/launch/empty_world", True),
        ("arm_worlds)/launch/empty", "gazebo_ros)/launch/spawn_arm", False),
        ("slam)/launch/mapping", "amcl)/launch/localization", False),
    ],
)
def test_include_of_another_simulator_with_the_same_arguments_replaces_the_old_one(
    repository, compare, old, new, is_replaced
):
    arguments = '<arg name="world" value="yard.sdf"/><arg name="paused" value="false"/>'
    text = f'<launch><include file="$(find {old}.launch">{arguments}</include></launch>'
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/launch/arm.launch": text})
    repository.write({"arm/launch/arm.launch": text.replace(old, new)})
    lines = [str(change.sentence) for change in subject(compare(repository), "arm/launch/arm.launch").changes]
    replaced = f"include of '$(find {old}.launch' replaced by include of '$(find {new}.launch'"
    assert (replaced in lines) is is_replaced


@pytest.mark.parametrize("use", ["<!-- $(arg target) -->", "$(eval arg('target') == 'b')"])
def test_argument_in_an_expression_is_used_and_one_in_a_comment_is_not(repository, compare, use):
    text = use if "<" in use else f'    <arg name="x" value="{use}"/>'
    found = _find_driver_changes(repository, compare, DRIVER.replace(TARGET, text))
    assert ("argument 'target' is no longer used" in found) is ("<" in use)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (
            'value="$(arg camera)"',
            'value="false"',
            "include of '$(dirname)/part.launch': camera $(arg camera) -> false (before, true by default)",
        ),
        ('default="true"', 'default="false"', "argument 'camera': default true -> false"),
    ],
)
def test_value_that_switches_off_a_node_of_an_included_file_is_breaking(review_reasons, old, new, expected):
    assert review_reasons(old, new) == {expected: CAMERA_STOPS}


def test_reason_for_several_removed_arguments_names_all_programs_that_stop(repository, compare):
    names = ("arm", "base", "camera", "door")
    arguments = "".join(f'<arg name="{name}" default="false"/>' for name in names)
    nodes = "".join(f'<node pkg="arm" type="{name}.py" name="{name}" if="$(arg {name})"/>' for name in names)
    passed = "".join(f'<arg name="{name}" value="true"/>' for name in names)
    include = '<launch><include file="$(dirname)/part.launch">{}</include></launch>\n'
    part = {"arm/launch/part.launch": f"<launch>{arguments}{nodes}</launch>\n"}
    repository.commit({"arm/launch/arm.launch": include.format(passed), **part})
    repository.write({"arm/launch/arm.launch": include.format("")})
    (change,) = subject(compare(repository), "arm/launch/arm.launch").changes
    programs = ", ".join(f"'arm/{name}.py'" for name in names)
    assert str(change.reason) == f"by default, {programs} no longer start"


@pytest.mark.parametrize(("line", "reason"), [(SAFETY, "by default, it no longer starts"), (MODEL_INCLUDE, None)])
def test_condition_that_does_not_hold_is_breaking_for_a_file_with_nodes(review_reasons, line, reason):
    assert list(review_reasons(line, line.replace("/>", ' if="false"/>')).values()) == [reason]


CONDITIONAL = """from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from moveit_configs_utils.launch_utils import DeclareBooleanLaunchArg


def generate_launch_description():
    ld = LaunchDescription()
    ld.add_action(DeclareBooleanLaunchArg("db", default_value=False))
    ld.add_action(IncludeLaunchDescription("db.launch.py", condition=IfCondition(LaunchConfiguration("db"))))
    return ld
"""


def test_boolean_argument_of_moveit_has_a_default(review_changes):
    line = next(line for line in CONDITIONAL.splitlines() if "IncludeLaunchDescription(" in line)
    assert review_changes("arm.launch.py", CONDITIONAL, f"{line}\n", "") == (
        ["argument 'db' is no longer used", "include of 'db.launch.py' removed: if $(var db)"],
        ["argument 'db' is no longer used"],
    )


def test_name_of_an_included_file_may_contain_an_argument(repository, compare):
    file = '<launch><include file="$(dirname)/part.launch" if="true"><arg name="kind" value="a"/></include></launch>'
    part = '<launch><arg name="kind"/><include file="$(dirname)/$(arg kind).launch"/></launch>'
    files = {"arm/launch/part.launch": part, "arm/launch/a.launch": "<launch/>"}
    repository.commit({"arm/launch/arm.launch": file, **files})
    repository.write({"arm/launch/arm.launch": file.replace('if="true"', 'if="false"')})
    (change,) = subject(compare(repository), "arm/launch/arm.launch").changes
    assert change.reason is None


def test_many_arguments_that_an_include_passes_are_one_change(review_reasons):
    arguments = "".join(f'<arg name="a{number}" value="{number}"/>' for number in range(3))
    found = review_reasons('<arg name="scan" value="front"/>', f'<arg name="scan" value="front"/>{arguments}')
    assert found == {
        "include of '$(find elsewhere)/launch/laser_pipeline.launch': arguments added: a0 0, a1 1, a2 2": None
    }


def test_xml_file_that_others_include_is_a_launch_file(repository, compare):
    text = '<?xml version="1.0"?>\n<!-- a - part -->\n<launch><node pkg="arm" type="driver" name="driver"/></launch>'
    repository.commit({"arm/launch/parts/driver.xml": text, "arm/plugins.xml": "<library/>"})
    repository.write(
        {"arm/launch/parts/driver.xml": text.replace('"driver"/>', '"motor"/>'), "arm/plugins.xml": "<a/>"}
    )
    (result,) = [each for each in compare(repository).subjects if each.path == "arm/launch/parts/driver.xml"]
    assert [str(change.sentence) for change in result.changes] == ["node 'arm/driver': name driver -> motor"]


def test_argument_that_an_including_file_has_is_declared(repository, compare):
    part = '<launch><node pkg="arm" exec="driver" name="driver"/></launch>'
    file = """<launch>
      <arg name="mode" default="online"/>
      <include file="$(find-pkg-share arm)/launch/part.launch.xml"/>
    </launch>"""
    repository.commit({"arm/launch/arm.launch.xml": file, "arm/launch/part.launch.xml": part})
    new = part.replace('"driver"/>', '"driver" args="$(var mode)"/>')
    repository.write({"arm/launch/part.launch.xml": new})
    (change,) = subject(compare(repository), "arm/launch/part.launch.xml").changes
    assert (str(change.sentence), change.reason) == ("node 'arm/driver': arguments $(var mode) added", None)


def test_node_that_moves_into_a_file_of_a_package_without_manifest_is_moved(repository, compare):
    node = '<node pkg="gazebo" type="gazebo" name="gazebo"/>'
    repository.commit({"worlds/launch/arm.launch": f"<launch>{node}</launch>"})
    include = '<include file="$(find worlds)/launch/start.launch"/>'
    files = {"worlds/launch/arm.launch": f"<launch>{include}</launch>"}
    repository.write({**files, "worlds/launch/start.launch": f"<launch>{node}</launch>"})
    changes = subject(compare(repository), "worlds/launch/arm.launch").changes
    assert [change.reason for change in changes] == [None, None]
    assert str(changes[1].sentence) == "node 'gazebo/gazebo' moved to worlds/launch/start.launch"


SPAWNER = "#!/usr/bin/env python3\nimport roslaunch\n\nFILE = '{}'\nroslaunch.main(['roslaunch', 'elsewhere', FILE])\n"


@pytest.mark.parametrize(("name", "is_breaking"), [("safety.launch", False), ("unsafety.launch", True)])
def test_an_include_can_become_a_node_whose_script_starts_the_file(repository, compare, name, is_breaking):
    manifest = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    repository.commit({**manifest, "arm/launch/arm.launch": FILE, "arm/scripts/start.py": SPAWNER.format(name)})
    node = '  <node pkg="arm" type="start.py" name="start"/>\n'
    repository.write({"arm/launch/arm.launch": FILE.replace(SAFETY, node)})
    changes = subject(compare(repository), "arm/launch/arm.launch").changes
    assert any(change.reason is not None for change in changes) is is_breaking


@pytest.mark.parametrize(("name", "is_replaced"), [("pad", True), ("stick", False)])
def test_a_node_of_an_added_include_with_the_same_name_replaces_the_node(repository, compare, name, is_replaced):
    text = '<launch><node pkg="joy" exec="game_pad" name="pad"/></launch>'
    manifest = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    repository.commit({**manifest, "arm/launch/arm.launch.xml": text})
    include = '<launch><include file="$(find-pkg-share arm)/launch/joy.launch.xml"/></launch>'
    added = f'<launch><node pkg="joy" exec="joy_node" name="{name}"/></launch>'
    repository.write({"arm/launch/arm.launch.xml": include, "arm/launch/joy.launch.xml": added})
    found = sentences(subject(compare(repository), "arm/launch/arm.launch.xml"))
    line = "node 'joy/game_pad' replaced by node 'joy/joy_node' in arm/launch/joy.launch.xml"
    assert (line in found) is is_replaced


@pytest.mark.parametrize("count", [1, 2])
def test_an_include_of_another_file_of_a_package_under_another_condition_replaces_the_old_one(review_changes, count):
    text = """<launch>
      <arg name="plan" default="true"/>
      <include file="$(find-pkg-share other)/launch/move_group.launch" if="$(var plan)">
        <arg name="debug" value="true"/><arg name="hand" value="left"/><arg name="info" value="true"/>
      </include>
    </launch>"""
    include = text[text.index("<include") : text.index("</include>") + len("</include>")]
    new = include.replace(' if="$(var plan)"', "").replace("move_group", "demo").replace('"info"', '"fake"')
    more = "\n".join(new.replace("demo", name) for name in ("demo", "test")[:count])
    changes, _ = review_changes("arm.launch.xml", text, include, more)
    replaced = [change for change in changes if "replaced by" in change]
    assert len(replaced) == (count == 1)
    assert any(change.endswith("condition if $(var plan) removed") for change in changes) == (count == 1)


MANAGER = '<node pkg="nav2_lifecycle_manager" exec="lifecycle_manager" name="lifecycle_manager_localization"/>'
PLANNER = '<node pkg="nav2_planner" exec="planner_server"/>'
NAV2 = "$(find-pkg-share nav2_bringup)/launch/{}_launch.py"


@pytest.mark.parametrize(
    ("node", "file", "arguments", "is_moved"),
    [
        (MANAGER, "bringup", "", True),
        (MANAGER, "localization", "", True),
        (MANAGER, "navigation", "", False),
        (MANAGER, "bringup", '<arg name="slam" value="True"/>', False),
        (MANAGER, "bringup", '<arg name="namespace" value="robot"/>', False),
        (MANAGER.replace("_localization", ""), "bringup", "", False),
        (PLANNER, "bringup", '<arg name="slam" value="True"/>', True),
        (PLANNER, "localization", "", False),
    ],
)
def test_a_node_moves_to_an_included_file_of_nav2_that_starts_it(repository, compare, node, file, arguments, is_moved):
    path, name = "arm/launch/arm.launch.xml", NAV2.format(file)
    include = f'<include file="{name}">{arguments}</include>'
    repository.commit({path: f"<launch>{node}</launch>", "arm/launch/other.launch.xml": f"<launch>{include}</launch>"})
    repository.write({path: f"<launch>{include}</launch>"})
    changes = subject(compare(repository), path).changes
    told = [change for change in changes if str(change.sentence).endswith(f"moved to {name}")]
    assert bool(told) is is_moved
    assert any(change.reason is not None for change in changes) is not is_moved


def test_a_node_that_an_included_file_of_nav2_starts_anyway_has_not_moved(review_changes):
    include = f'<include file="{NAV2.format("bringup")}"/>'
    changes, _ = review_changes("arm.launch.xml", f"<launch>{include}{PLANNER}</launch>", PLANNER, "")
    assert changes == ["node 'nav2_planner/planner_server' removed"]
