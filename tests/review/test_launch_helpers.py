"""Lists in Python launch files, in a review.

They are passed to functions, or put together from other lists.
"""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MIXIN = """from launch_ros.actions import Node


class Mixin:
    @staticmethod
    def viewer(file, **kwargs):
        return Node(package="arm", executable="viewer", arguments=["-d", file], **kwargs)

    @staticmethod
    def driver(parameters, remappings=None):
        return Node(package="arm", executable="driver", parameters=parameters, remappings=remappings)
"""
FILE = """from arm.mixin import Mixin
from arm_moveit import settings
from elsewhere import make_node
from launch import LaunchDescription

NAME = "left"


def generate_launch_description():
    return LaunchDescription([
        Mixin.viewer("a", remappings=[("b", NAME + "/b"), ("c", NAME + "/c")], parameters=settings(1)),
        Mixin.driver([{"rate": 1}, "a.yaml"], remappings=[("d", "e"), ("f", "g")]),
        make_node(remappings=[("h", "i"), ("j", "k")]),
    ])
"""
LIST = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch_ros.actions import Node


def generate_launch_description():
    arguments = [DeclareLaunchArgument("rate", default_value="1")]
    nodes = []
    nodes.append(Node(package="arm", executable="driver"))
    nodes.append(Node(package="arm", executable="hand"))
    return LaunchDescription([*arguments, *nodes])
"""
RETURNED = "Description([*arguments, *nodes])"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('("b", NAME + "/b"), ("c", NAME + "/c")', '("c", NAME + "/c"), ("b", NAME + "/b")', []),
        ('("d", "e"), ("f", "g")', '("f", "g"), ("d", "e")', []),
        ('("h", "i"), ("j", "k")', '("j", "k"), ("h", "i")', []),
        ('("b", NAME + "/b"), ', '("b", NAME + "/b"), ("z", NAME + "/z"), ',
         ["node 'arm/viewer': remapping z left/z added"]),
        ("parameters=settings(1)", 'parameters=settings(1) + [{"use_sim_time": True}]',
         ["node 'arm/viewer': parameter use_sim_time True added"]),
        ('{"rate": 1}', '{"rate": 2}', ["node 'arm/driver': parameter rate 1 -> 2"]),
        ('("d", "e")', '("d", "x")', ["node 'arm/driver': remapping d e -> x"]),
        ('("h", "i")', '("h", "x")', ["action 'make_node': remapping h i -> x"]),
    ],
)  # fmt: skip
def test_lists_that_functions_get_are_compared_by_their_items(repository, compare, old, new, expected):
    assert old in FILE
    files = {"arm/arm/mixin.py": MIXIN, "arm/arm/__init__.py": ""}
    repository.commit({"arm/launch/arm.launch.py": FILE, **files})
    repository.write({"arm/launch/arm.launch.py": FILE.replace(old, new)})
    subjects = [each for each in compare(repository).subjects if each.path == "arm/launch/arm.launch.py"]
    assert [text for each in subjects for text in sentences(each)] == expected


@pytest.mark.parametrize("items", ["arguments + nodes", "[*arguments] + nodes"])
def test_list_that_is_put_together_is_no_other_code(repository, compare, items):
    repository.commit({"arm/launch/arm.launch.py": LIST})
    repository.write({"arm/launch/arm.launch.py": LIST.replace(RETURNED, f"Description({items})")})
    assert not compare(repository).subjects


LISTED = 'arguments = [DeclareLaunchArgument("rate", default_value="1")]\n'
ADDED = 'arguments = []\n    arguments.append(DeclareLaunchArgument("rate", default_value="1"))\n'


@pytest.mark.parametrize("declared", [LISTED, ADDED])
def test_argument_in_a_list_that_the_description_does_not_get_is_not_declared(repository, compare, declared):
    text = LIST.replace(LISTED, declared)
    repository.commit({"arm/launch/arm.launch.py": text.replace(RETURNED, "Description(nodes)")})
    repository.write({"arm/launch/arm.launch.py": text})
    (subject,) = compare(repository).subjects
    assert sentences(subject) == ["argument 'rate' added: default 1"]


LOOP = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, LaunchConfigurationEquals
from launch.substitutions import EqualsSubstitution, LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    programs = [("arm", "driver"), ("arm", "hand")]
    description = LaunchDescription([DeclareLaunchArgument("map", default_value="")])
    for package, program in programs:
        description.add_action(Node(package=package, executable=program))
    description.add_action(Node(
        package="tf2_ros",
        executable="static_transform_publisher",
        condition=LaunchConfigurationEquals("map", ""),
        arguments=["0", "0", "0", "0", "0", "0", "map", [LaunchConfiguration("map"), "camera"]],
    ))
    return description
"""


def test_items_of_a_loop_over_pairs_are_actions(review_changes):
    changes, found = review_changes("arm.launch.py", LOOP, ', ("arm", "hand")', "")
    assert changes == found == ["node 'arm/hand' removed"]


def test_substitutions_in_a_list_are_one_word_of_the_arguments(review_changes):
    changes, found = review_changes("arm.launch.py", LOOP, '"camera"', '"lidar"')
    assert len(changes) == 1
    assert changes == found
    assert changes[0].endswith("child frame '$(var map)camera' -> '$(var map)lidar'")


def test_comparison_of_an_argument_may_be_a_substitution(review_changes):
    new = 'IfCondition(EqualsSubstitution(LaunchConfiguration("map"), ""))'
    assert review_changes("arm.launch.py", LOOP, 'LaunchConfigurationEquals("map", "")', new) == ([], [])


def test_a_comparison_with_an_empty_text_shows_it_and_is_evaluated(review_changes):
    condition = '        condition=LaunchConfigurationEquals("map", ""),\n'
    changes, found = review_changes(
        "arm.launch.py", LOOP.replace(condition, ""), "        arguments", f"{condition}        arguments"
    )
    (line,) = changes
    assert line.endswith("condition if $(var map) == '' added")
    assert not found


SHELF = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import LaunchConfigurationEquals, LaunchConfigurationNotEquals
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("file", default_value="day"),
        Node(package="arm", executable="log", name="log"),
    ])
"""
EMPTY_ONLY = 'Node(package="arm", executable="log", name="log", condition=LaunchConfigurationEquals("file", "")),\n'
OTHERWISE = EMPTY_ONLY.replace("Equals", "NotEquals").replace('name="log", ', 'name="log", respawn=True, ')


@pytest.mark.parametrize(("new", "is_breaking"), [(EMPTY_ONLY, True), (f"{EMPTY_ONLY}        {OTHERWISE}", False)])
def test_a_node_that_two_opposite_conditions_start_still_starts_by_default(review_changes, new, is_breaking):
    old = 'Node(package="arm", executable="log", name="log"),\n'
    _, found = review_changes("arm.launch.py", SHELF, old, new)
    assert bool(found) is is_breaking


PROGRAM_GUARD = """

if __name__ == "__main__":
    generate_launch_description()
"""


def test_actions_of_a_file_that_calls_its_own_function_as_a_program_have_no_condition(review_changes):
    changes, found = review_changes("arm.launch.py", LOOP + PROGRAM_GUARD, ', ("arm", "hand")', "")
    assert changes == found == ["node 'arm/hand' removed"]


DECLARED = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

base_argument = DeclareLaunchArgument("base")


def generate_launch_description():
    node = Node(package="arm", executable="driver", parameters=[{"base": LaunchConfiguration("base")}])
    return LaunchDescription([base_argument, node])
"""
DECLARATION = 'base_argument = DeclareLaunchArgument("base")'
MODULE = f"""from launch.actions import DeclareLaunchArgument

BASE = "base"
{DECLARATION.replace('"base"', "BASE")}
mode_argument = DeclareLaunchArgument("mode", choices=["fast", "slow"])
"""
FUNCTION = """from launch.actions import DeclareLaunchArgument

def make(name):
    return DeclareLaunchArgument(name)

base_argument = make("base")
"""


@pytest.mark.parametrize(
    ("module", "imported", "expected"),
    [
        (MODULE, "from arm.common import base_argument", []),
        (MODULE, "from arm.common import mode_argument as base_argument",
         ["argument 'mode' added: choices [fast, slow] (required)"]),
        (FUNCTION, "from arm.common import base_argument", []),
        ("", "from elsewhere.common import base_argument", []),
    ],
)  # fmt: skip
def test_actions_imported_from_a_module_of_the_repository_belong_to_the_file(
    repository, compare, module, imported, expected
):
    repository.commit({"arm/launch/arm.launch.py": DECLARED, "arm/arm/common.py": module})
    new = DECLARED.replace(DECLARATION + "\n", "").replace("from launch_ros", f"{imported}\nfrom launch_ros")
    repository.write({"arm/launch/arm.launch.py": new})
    result = compare(repository)
    assert sorted(breaking(result)) == expected
    if module == MODULE:
        changes = sentences(subject(result, "arm/launch/arm.launch.py"))
        assert not any("other code" in sentence for sentence in changes)


SPAWNERS = """import os

from launch import LaunchDescription
from launch_ros.actions import Node

distro = os.environ["ROS_DISTRO"]
if distro == "iron" or distro == "humble":
    spawner = "spawner"
else:
    spawner = "spawner.py"


def generate_launch_description():
    arm = Node(package="controller_manager", executable=spawner, arguments=["arm", "-c", "/manager"])
    hand = Node(package="controller_manager", executable=spawner, arguments=["hand", "-c", "/manager"])
    return LaunchDescription([arm, hand])
"""
SPAWNER_FUNCTION = """    def spawn(name, *options):
        words = [name] + [option for option in options]
        return Node(package="controller_manager", executable=spawner, arguments=words)

    nodes = [spawn(name, "-c", "/manager") for name in ["arm", "hand"]]
    return LaunchDescription(nodes)
"""
SPAWNER_BODY = SPAWNERS[SPAWNERS.index("    arm = ") :]
NEW_TEST = 'if distro in ("humble", "iron")'
NAME = "node 'controller_manager/'spawner' if distro in ['humble', 'iron'] else 'spawner.py''"


@pytest.mark.parametrize(
    ("function", "nodes", "expected"),
    [
        (SPAWNER_FUNCTION, [], []),
        (
            SPAWNER_FUNCTION.replace('["arm", "hand"]', '["arm"]'),
            [f"{NAME} of 'hand' removed: arguments [hand, -c, /manager]"],
            [f"{NAME} of 'hand' removed: arguments [hand, -c, /manager]"],
        ),
        (
            SPAWNER_FUNCTION.replace('"-c", "/manager"', '"--inactive" if distro == "iron" else "--stopped"'),
            [
                f"{NAME} of '{name}': arguments [{name}, -c, /manager] -> "
                f"[{name}, '--inactive' if distro == 'iron' else '--stopped']"
                for name in ("arm", "hand")
            ],
            [],
        ),
    ],
)
def test_nodes_of_a_function_inside_of_the_function_that_returns_them_are_read(
    review_changes, function, nodes, expected
):
    changes, found = review_changes("arm.launch.py", SPAWNERS, SPAWNER_BODY, function)
    assert [change for change in changes if change.startswith("node ")] == nodes
    assert found == expected


def test_the_values_that_a_condition_allows_have_one_notation(review_changes):
    old = 'if distro == "iron" or distro == "humble"'
    changes, _ = review_changes("arm.launch.py", SPAWNERS, old, NEW_TEST)
    assert not [change for change in changes if change.startswith("node ")]


def test_code_outside_of_functions_is_not_told_as_code_of_the_function_that_changes_too(review_changes):
    helper = "def get():\n    print({})\n\n\ndef gen"
    old = "import os\nprint(1)\n" + SPAWNERS.removeprefix("import os\n").replace("def gen", helper.format(1))
    new = "import os\nprint(2)\nprint(3)\n" + SPAWNERS.removeprefix("import os\n").replace("def gen", helper.format(2))
    changes, _ = review_changes("arm.launch.py", old, old, new)
    assert [change for change in changes if "other code" in change] == ["other code changed, such as print(2)"]


DECLARING = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument


def declare(name, default, description=None):
    if description:
        return DeclareLaunchArgument(name, default_value=default, description=description)
    return DeclareLaunchArgument(name, default_value=default)


def generate_launch_description():
    return LaunchDescription([declare("rate", "10", "The rate."), declare("mode", "slow")])
"""


@pytest.mark.parametrize("test", ["description", "description is not None", "not description"])
def test_a_condition_on_a_constant_that_a_function_gets_is_decided(repository, compare, test):
    path, text = "arm/launch/arm.launch.py", DECLARING.replace("if description:", f"if {test}:")
    repository.commit({path: text})
    repository.write({path: text.replace('"10"', '"20"').replace('"slow"', '"fast"')})
    assert sentences(subject(compare(repository), path)) == [
        "argument 'rate': default 10 -> 20",
        "argument 'mode': default slow -> fast",
    ]


def test_second_review_sees_what_changed_since_the_first_one(repository, compare):
    """Parsed files are kept during a review, not longer."""
    repository.commit({"arm/launch/arm.launch.py": FILE, "arm/mixin.py": MIXIN})
    repository.write({"arm/mixin.py": MIXIN.replace('"viewer",', '"display",')})
    assert any("arm/display" in line for found in compare(repository).subjects for line in sentences(found))
    repository.write({"arm/mixin.py": MIXIN.replace('"viewer",', '"screen",')})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert any("arm/screen" in line for line in lines)
    assert not any("arm/display" in line for line in lines)


def test_line_about_an_added_module_with_actions_names_its_functions(repository, compare):
    repository.commit({"arm/launch/arm.launch.py": FILE})
    repository.write({"arm/arm/single.py": MIXIN + "\n\ndef make(name):\n    return Mixin.viewer(name)\n"})
    review_subject = subject(compare(repository), "arm/arm/single.py")
    assert sentences(review_subject) == ["functions for launch files added: 'make', 'Mixin'"]


def test_actions_of_a_launch_file_that_is_also_a_program_have_their_own_lines(repository, compare):
    text = """import sys
from launch import LaunchDescription, LaunchService
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package="arm", executable="driver", parameters=[{"rate": 1}]),
    ])


def main():
    service = LaunchService(argv=sys.argv[1:])
    service.include_launch_description(generate_launch_description())
    return service.run()


if __name__ == "__main__":
    main()
"""
    path = "arm/launch/arm.launch.py"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: text})
    repository.write({path: text.replace('"rate": 1', '"rate": 2')})
    (change,) = subject(compare(repository), path).changes
    assert str(change.sentence) == "node 'arm/driver': parameter rate 1 -> 2"
    assert change.location is not None
    assert change.location.line == 8
