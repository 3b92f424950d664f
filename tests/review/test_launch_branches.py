"""Changes of ``if`` statements in Python launch files in a review.

They are conditions of the actions in them.
"""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences

LAUNCH = """import os
from ament_index_python import get_packages_with_prefixes
from arm.values import mode, path, ready
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    actions = [DeclareLaunchArgument("speed", default_value="1")]
    driver = Node(package="arm", executable="driver")
    PLACE
    return LaunchDescription(actions)
"""


def launch_text(*lines: str) -> str:
    return LAUNCH.replace("PLACE", "\n    ".join(lines))


CHECK = "'nav2' in get_packages_with_prefixes()"
WITHOUT_CONDITION = launch_text("actions.append(driver)")
launch_in_condition = launch_text(f"if {CHECK}:", "    actions.append(driver)")


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (WITHOUT_CONDITION, launch_in_condition, [f"node 'arm/driver': condition if `{CHECK}` added"]),
        (launch_in_condition, WITHOUT_CONDITION, [f"node 'arm/driver': condition if `{CHECK}` removed"]),
        (launch_in_condition, launch_in_condition.replace("'nav2'", "'nav3'"),
         [f"node 'arm/driver': condition if `{CHECK}` -> if `'nav3' in get_packages_with_prefixes()`"]),
        (launch_text("actions += [Node(package='arm', executable='camera')]"),
         launch_text(f"if {CHECK}:", "    pass", "else:", "    actions += [Node(package='arm', executable='camera')]"),
         [f"node 'arm/camera': condition unless `{CHECK}` added"]),
        (launch_in_condition,
         launch_in_condition.replace("    actions.append(driver)",
                                     "    actions.append(driver)\n        print('ready')"),
         ["other code added: print('ready')"]),
        (launch_text("camera = Node(package='arm', executable='camera')", "actions.append(camera)"),
         launch_text(f"if {CHECK}:", "    camera = Node(package='arm', executable='camera')",
                     "else:", "    camera = Node(package='arm', executable='recorder')", "actions.append(camera)"),
         [f"node 'arm/camera': condition if `{CHECK}` added",
          f"node 'arm/recorder' added: unless `{CHECK}`"]),
    ],
)  # fmt: skip
def test_if_statement_is_a_condition_of_the_actions_in_it(review_changes, old, new, expected):
    found, _ = review_changes("arm.launch.py", old, old, new)
    assert found == expected


@pytest.mark.parametrize(
    "lines",
    [
        (
            "description = LaunchDescription([driver])",
            f"if {CHECK}:",
            "    description.add_action(Node(package='a', executable='b'))",
        ),
        ("actions.append(driver)", f"if {CHECK}:", "    print(driver)"),
        ("actions.append(driver)", f"if {CHECK}:", "    check(driver)"),
    ],
)
def test_actions_outside_of_an_if_statement_have_no_condition(review_changes, lines):
    new = launch_text(*lines)
    old = new.replace(f"if {CHECK}:", "if True:")
    found, breaking = review_changes("arm.launch.py", old, old, new)
    assert not [sentence for sentence in found if "arm/driver" in sentence]
    assert not breaking


CAMERA = "Node(package='arm', executable='camera', output='screen')"


def make_branches(first: str, second: str, test: str = CHECK) -> str:
    return launch_text(f"if {test}:", f"    actions += [driver, {first}]", "else:", f"    actions += [{second}]")


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        (make_branches(CAMERA, CAMERA), [f"node 'arm/driver' added: if `{CHECK}`"]),
        (make_branches(CAMERA, CAMERA.replace("screen", "log")),
         [f"node 'arm/camera': condition if `{CHECK}` added", f"node 'arm/driver' added: if `{CHECK}`",
          f"node 'arm/camera' added: unless `{CHECK}`, output log"]),
        (launch_text(f"if {CHECK}:", "    actions += [driver]", f"if ready():\n        actions += [{CAMERA}]"),
         ["node 'arm/camera': condition if `ready()` added", f"node 'arm/driver' added: if `{CHECK}`"]),
    ],
)  # fmt: skip
def test_equal_actions_of_both_branches_have_no_condition(review_changes, new, expected):
    old = launch_text(f"actions += [{CAMERA}]")
    found, _ = review_changes("arm.launch.py", old, old, new)
    assert sorted(found) == sorted(expected)


CALLING = """import os
from arm.values import mode, path
from launch import LaunchDescription
from launch.actions import OpaqueFunction
from launch_ros.actions import Node


def start(context):
    EXTRA
    return [Node(package="arm", executable="driver")]


def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=start)])
"""
PLAIN = """import os
from arm.values import mode, path
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package="arm", executable="driver")])
"""


@pytest.mark.parametrize(
    ("extra", "expected"),
    [("", []), ("print('ready')", ["other code added: print('ready')"])],
)
def test_function_of_an_action_is_compared_by_its_contents(review_changes, extra, expected):
    found, _ = review_changes("arm.launch.py", PLAIN, PLAIN, CALLING.replace("EXTRA", extra))
    assert found == expected


GUARDED = CALLING.replace("EXTRA", "if TEST:\n        print('missing')\n        return []")


@pytest.mark.parametrize(
    ("test", "expected"),
    [
        ("not os.path.exists(path)", ["other code added: if not os.path.exists(path): ...; print('missing')"]),
        ("path is None", ["other code added: if path is None: ...; print('missing')"]),
        (
            "mode == 'off'",
            [
                "node 'arm/driver': condition unless `mode == 'off'` added",
                "other code added: if mode == 'off': ...; print('missing')",
            ],
        ),
    ],
)
def test_missing_file_or_value_is_no_condition_of_actions(review_changes, test, expected):
    found, _ = review_changes("arm.launch.py", PLAIN, PLAIN, GUARDED.replace("TEST", test))
    assert found == expected


UNPACKED = launch_text(
    "path, other = VALUE",
    "actions.append(Node(package='arm', executable='driver', parameters=[path], name=other))",
)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("'a.yaml', 'arm'", "'b.yaml', 'arm'", ["node 'arm/driver': parameters [a.yaml] -> [b.yaml]"]),
        (
            "load('a')",
            "load('b')",
            [
                "node 'arm/driver': name load(a)[1] -> load(b)[1]",
                "node 'arm/driver': parameters [load(a)[0]] -> [load(b)[0]]",
            ],
        ),
    ],
)
def test_unpacked_names_have_their_values(review_changes, old, new, expected):
    texts = [UNPACKED.replace("VALUE", value) for value in (old, new)]
    found, _ = review_changes("arm.launch.py", texts[0], *texts)
    assert found == expected


def test_only_values_that_a_changed_statement_uses_are_other_code(review_changes):
    text = launch_text(
        "count = 1",
        "unused = Node(package='arm', executable='other', output='screen')",
        "for number in range(count):",
        "    actions.append(Node(package='arm', executable='driver', name=f'driver{number}'))",
    )
    new = text.replace("count = 1", "count = 2").replace(", output='screen'", "")
    found, _ = review_changes("arm.launch.py", text, text, new)
    assert found == ["other code: count = 1 -> count = 2"]


CHOSEN = """from launch import LaunchDescription
from launch.actions import OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def start(context):
    size = LaunchConfiguration("size").perform(context)
{branches}
    return [Node(package="arm", executable="arm", parameters=[{{"file": f"config/{{file}}"}}])]


def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=start)])
"""
WRITTEN = """    if size == "2":
        file = "two.yaml"
    elif size == "3":
        file = "three.yaml"
    else:
        file = "three.yaml"
"""
LEFT_OUT = """    file = "three.yaml"
    if size == "3":
        print("three")
    elif size == "2":
        file = "{}.yaml"
"""


@pytest.mark.parametrize(("name", "is_changed"), [("two", False), ("flat", True)])
def test_branches_in_another_order_choose_the_same_values(repository, compare, name, is_changed):
    path = "arm/launch/arm.launch.py"
    repository.commit({path: CHOSEN.format(branches=WRITTEN)})
    repository.write({path: CHOSEN.format(branches=LEFT_OUT.format(name))})
    changed = [text for found in compare(repository).subjects for text in sentences(found) if "parameter file" in text]
    assert bool(changed) is is_changed
    assert all("three.yaml" in text and "flat.yaml" in text for text in changed)
