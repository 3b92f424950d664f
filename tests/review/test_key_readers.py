"""Keys and names that a YAML file loses although programs that did not change read them."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

PATH = "a/config/arm.yaml"
SETTINGS = """arm:
  speed: 1.0
  echo:
    code: 8
camera_names: [front, belly_camera]
modes: [belly_camera, rear_camera]
"""
READER = """import yaml
settings = yaml.safe_load(open("arm.yaml"))["arm"]
code = settings["echo"]["code"]
"""
VIEWER = 'void start() { show("belly_camera"); show("rear_camera"); }\n'
LAUNCH = '<launch><rosparam command="load" file="$(find a)/config/arm.yaml"/></launch>\n'
FILES = {
    "a/package.xml": PACKAGE_XML.replace("arm_description", "a"),
    "a/src/viewer.cpp": VIEWER,
    "a/launch/arm.launch": LAUNCH,
    PATH: SETTINGS,
}
ECHO = "  echo:\n    code: 8\n"


def find_breaking_changes(repository, compare, files, old, new, changed=()):
    assert old in SETTINGS
    repository.commit({**FILES, **files})
    repository.write({PATH: SETTINGS.replace(old, new), **dict(changed)})
    result = compare(repository)
    return [(str(change.sentence), str(change.reason)) for _, change in result.breaking_changes]


def test_removed_key_that_an_unchanged_program_reads_is_breaking(repository, compare):
    reason = "'a/scripts/reader.py' reads the key 'echo' and does not find it"
    changes = find_breaking_changes(repository, compare, {"a/scripts/reader.py": READER}, ECHO, "")
    assert changes == [("arm.echo.code 8 removed", reason)]


@pytest.mark.parametrize(
    ("reader", "old", "new"),
    [
        (READER.replace("arm.yaml", "leg.yaml"), ECHO, ""),
        (READER.replace('["echo"]["code"]', '.get("echo", {}).get("code", 8)'), ECHO, ""),
        (READER.replace('code = settings["echo"]["code"]', '# code = settings["echo"]["code"]'), ECHO, ""),
        (READER.replace('settings["echo"]["code"]', '["echo", "code"]'), ECHO, ""),
        (READER, ECHO, "other:\n  echo:\n    code: 8\n"),
        (READER, "  speed: 1.0\n", ""),
    ],
)
def test_removed_key_that_no_program_is_sure_to_read_is_not_breaking(repository, compare, reader, old, new):
    assert find_breaking_changes(repository, compare, {"a/scripts/reader.py": reader}, old, new) == []


def test_removed_key_whose_reader_changed_is_not_breaking(repository, compare):
    changed = {"a/scripts/reader.py": f"{READER}print(code)\n"}
    assert find_breaking_changes(repository, compare, {"a/scripts/reader.py": READER}, ECHO, "", changed) == []


def test_removed_parameter_of_a_node_is_not_breaking(repository, compare):
    text = "arm:\n  ros__parameters: {rate: 1, echo: 8}\n"
    repository.commit({**FILES, "a/scripts/reader.py": READER, PATH: text})
    repository.write({PATH: text.replace(", echo: 8", "")})
    assert breaking(compare(repository)) == []


def test_name_that_a_list_loses_is_breaking_if_an_unchanged_source_uses_it(repository, compare):
    changes = find_breaking_changes(repository, compare, {}, "[front, belly_camera]", "[front]")
    reason = "'a/src/viewer.cpp' still uses the name 'belly_camera'"
    assert changes == [("camera_names [front, belly_camera] -> [front]", reason)]


@pytest.mark.parametrize(
    ("files", "old", "new", "changed"),
    [
        ({}, "[belly_camera, rear_camera]", "[belly_camera]", {}),
        ({"a/launch/arm.launch": "<launch/>"}, "[front, belly_camera]", "[front]", {}),
        ({}, "[front, belly_camera]", "[front]", {"a/src/viewer.cpp": f"{VIEWER}\n"}),
        ({}, "[front, belly_camera]", "[belly_camera]", {}),
    ],
)
def test_other_items_of_lists_are_not_breaking(repository, compare, files, old, new, changed):
    assert find_breaking_changes(repository, compare, files, old, new, changed) == []


NODE = "arm_node:\n  ros__parameters:\n    rate: 10.0\n"
LIMITS = "    limits:\n      speed: 1.0\n      force: 5.0\n"
DECLARED = 'void start() { declare_parameter("limits.speed", 1.0); }\n'


@pytest.mark.parametrize(
    ("sources", "changed", "is_breaking"),
    [
        ({"a/src/arm.cpp": DECLARED}, {"a/src/arm.cpp": "void start() {}\n"}, False),
        ({"a/src/arm.cpp": DECLARED}, {"a/src/arm.cpp": "// limits\n" + DECLARED}, True),
        ({"a/src/arm.cpp": DECLARED, "a/src/leg.cpp": DECLARED}, {"a/src/arm.cpp": "void start() {}\n"}, True),
        ({"a/src/arm.cpp": DECLARED}, {"a/src/arm.cpp": None, "a/src/new.cpp": DECLARED}, True),
        ({"a/src/arm.cpp": DECLARED}, {}, True),
        ({}, {}, True),
    ],
)
def test_a_removed_group_of_parameters_is_breaking_unless_its_readers_stop_reading_it(
    repository, compare, sources, changed, is_breaking
):
    repository.commit({"a/package.xml": FILES["a/package.xml"], PATH: NODE + LIMITS, **sources})
    repository.write({PATH: NODE, **changed})
    (found,) = (found for found in compare(repository).subjects if found.path == PATH)
    reason = "the node 'arm_node' starts without these parameters"
    assert [str(change.reason) for change in found.changes] == [reason if is_breaking else "None"]


@pytest.mark.parametrize(
    ("old_name", "new_name", "is_breaking"), [("arm_node", "arm", False), ("arm", "arm_node", True)]
)
def test_renamed_node_of_a_file_is_breaking_unless_the_file_follows_its_source(
    repository, compare, old_name, new_name, is_breaking
):
    source = 'auto node = std::make_shared<rclcpp::Node>("arm");\n'
    old_text, new_text = (NODE.replace("arm_node", name) for name in (old_name, new_name))
    repository.commit({"a/package.xml": FILES["a/package.xml"], PATH: old_text, "a/src/arm.cpp": source})
    repository.write({PATH: new_text})
    found = breaking(compare(repository))
    assert found == ([f"{old_name}.ros__parameters.rate 10.0 removed"] if is_breaking else [])


@pytest.mark.parametrize(("name", "is_breaking"), [("arm", False), ("leg", True)])
def test_renamed_node_with_several_parameters_follows_its_source(repository, compare, name, is_breaking):
    source = f'auto node = std::make_shared<rclcpp::Node>("{name}");\n'
    repository.commit({"a/package.xml": FILES["a/package.xml"], PATH: NODE + LIMITS, "a/src/arm.cpp": source})
    repository.write({PATH: (NODE + LIMITS).replace("arm_node", "arm")})
    assert breaking(compare(repository)) == (["arm_node renamed to arm"] if is_breaking else [])


@pytest.mark.parametrize(
    ("path", "launch_name", "is_breaking"),
    [
        ("a/config/leg.yaml", "leg.yaml", False),
        ("a/config/leg.yaml", "other.yaml", True),
        (None, "leg.yaml", True),
    ],
)
def test_node_that_moved_to_a_file_which_launch_files_load_has_its_parameters(
    repository, compare, path, launch_name, is_breaking
):
    leg = NODE.replace("arm_node", "leg_node")
    launch = (
        f'<launch><node pkg="a" exec="leg"><param from="$(find-pkg-share a)/config/{launch_name}"/></node></launch>'
    )
    files = {"a/package.xml": FILES["a/package.xml"], PATH: NODE + leg, "a/launch/leg.launch.xml": launch}
    repository.commit(files)
    repository.write({PATH: NODE, **({path: leg} if path else {})})
    found = [line for line in breaking(compare(repository)) if "leg_node" in line]
    assert bool(found) == is_breaking


@pytest.mark.parametrize(
    ("sources", "is_breaking"),
    [
        ({"b/package.xml": PACKAGE_XML.replace("arm_description", "arm_node")}, False),
        ({"b/package.xml": PACKAGE_XML.replace("arm_description", "other")}, True),
        ({"b/package.xml": PACKAGE_XML.replace("arm_description", "arm_node"), "b/src/b.cpp": 'Node n("arm_node");\n'},
         True),
        ({"b/package.xml": PACKAGE_XML.replace("arm_description", "arm_node"),
          "b/urdf/b.xacro": '<robot name="b"><ros2_control name="arm_node" type="system"/></robot>\n'}, True),
    ],
)  # fmt: skip
def test_a_removed_section_with_the_name_of_a_package_needs_a_node_of_that_name(
    repository, compare, sources, is_breaking
):
    repository.commit({"a/package.xml": FILES["a/package.xml"], PATH: f"leg:\n  rate: 1\n{NODE}", **sources})
    repository.write({PATH: "leg:\n  rate: 1\n"})
    assert bool(breaking(compare(repository))) is is_breaking


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ('declare_parameter("arm_rates.x", 1.0);', []),
        ('declare_parameter(name + "_rates.x", 1.0);', []),
        ('declare_parameter(name + "_rate.x", 1.0);', ["/**.ros__parameters.arm_rates.x 1.0 removed"]),
    ],
)
def test_a_file_that_loses_all_parameters_of_its_nodes(repository, compare, source, expected):
    text = "/**:\n  ros__parameters:\n    {}\n"
    files = {"a/package.xml": FILES["a/package.xml"], "a/src/arm.cpp": f"void start() {{ {source} }}\n"}
    repository.commit({**files, PATH: text.format("arm_rates:\n      x: 1.0")})
    repository.write({"a/src/arm.cpp": "void start() {}\n", PATH: text.format("")})
    found = [(str(change.sentence), str(change.reason)) for _, change in compare(repository).breaking_changes]
    reason = "the nodes that load the file start without these parameters"
    assert [line for line, own_reason in found if own_reason == reason] == expected


START = """import os
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    file = os.path.join(get_package_share_directory("a"), "config", "arm.yaml")
    return LaunchDescription([Node(package="a", executable="lamp", name="lamp", parameters=[file])])
"""
XML = '<launch><arg name="arm"/><node pkg="a" exec="lamp" name="lamp"><param from="config/arm.yaml"/></node></launch>'
OTHER = 'auto node = std::make_shared<rclcpp::Node>("arm_node");\n'
SECOND = START.replace("[Node", '[Node(package="a", executable="arm", parameters=[file]), Node')


@pytest.mark.parametrize(
    ("launches", "is_breaking"),
    [
        ({"a/launch/lamp.launch.py": START}, False),
        ({"a/launch/lamp.launch.xml": XML}, False),
        ({"a/launch/lamp.launch.py": START, "a/launch/arm.launch.py": START.replace("lamp", "leg")}, False),
        # the old node gets the file, another program may be the old node, or an included file may start it
        ({"a/launch/lamp.launch.py": START.replace("lamp", "arm_node")}, True),
        ({"a/launch/lamp.launch.py": START, "a/launch/arm.launch.py": START.replace("lamp", "arm_node")}, True),
        ({"a/launch/lamp.launch.py": SECOND}, True),
        ({"a/launch/lamp.launch.py": START + "    # x\n    IncludeLaunchDescription(file)\n"}, True),
        ({"a/launch/lamp.launch.py": START.replace("arm.yaml", "other.yaml")}, True),
    ],
)
def test_renamed_node_of_a_file_that_only_the_new_node_got_is_not_breaking(repository, compare, launches, is_breaking):
    files = {"a/package.xml": FILES["a/package.xml"], "a/src/arm.cpp": OTHER, **launches}
    more = NODE + "    force: 2.0\n    speed: 3.0\n"
    repository.commit({**files, PATH: more})
    repository.write({PATH: more.replace("arm_node", "lamp")})
    (found,) = (found for found in compare(repository).subjects if found.path == PATH)
    assert [str(change.sentence) for change in found.changes] == ["arm_node renamed to lamp"]
    assert [change.reason is not None for change in found.changes] == [is_breaking]
