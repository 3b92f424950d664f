"""The lines of a review about Python launch files that fail or choose between lists of nodes."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

LAUNCH = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from arm.modules import cpu, load

BOTH = ["left", "right"]
ONE = ["left"]
TABLE = {"both": 1, "one": 2, "none": 3}


def spawner(name):
    return Node(package="controller_manager", executable="spawner", arguments=[name])


def setup(context):
    kind = LaunchConfiguration("kind").perform(context)
    if kind not in ("both", "one"):
        raise RuntimeError("no such kind")
    nodes = []
    if kind == "both":
        nodes.extend(spawner(item) for item in BOTH)
    return nodes


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("kind", default_value="both"),
        OpaqueFunction(function=setup),
    ])
"""
CHECK = '    if kind not in ("both", "one"):\n        raise RuntimeError("no such kind")\n'
NESTED = "".join(f"    {line}\n" for line in CHECK.splitlines())
ARGUMENT = '        DeclareLaunchArgument("kind"'


def test_a_loop_over_a_chosen_list_starts_the_same_nodes(review_changes):
    new = 'names = BOTH if kind == "both" else ONE\n        nodes.extend(spawner(item) for item in names)'
    assert review_changes("arm.launch.py", LAUNCH, "nodes.extend(spawner(item) for item in BOTH)", new) == ([], [])


def test_the_items_of_a_chosen_list_have_its_condition(review_changes):
    old, new = (f"in (BOTH if kind == 'both' and {name} else ONE)" for name in ("gpu", "cpu"))
    text = LAUNCH.replace("in BOTH", old)
    spawned = "controller_manager/spawner' of"
    changes, found_breaking = review_changes("arm.launch.py", text, old, new)
    assert any(f"{spawned} 'right'" in change and "and cpu`" in change for change in changes)
    assert found_breaking == []


def test_no_controller_is_lost_and_none_has_the_name_of_a_variable_if_a_list_is_unknown(review_changes):
    changes, found_breaking = review_changes("arm.launch.py", LAUNCH, "for item in BOTH", "for item in load(kind)")
    assert any("'$(eval item)'" in change for change in changes)
    assert found_breaking == []


@pytest.mark.parametrize(
    ("new", "failures"),
    [
        (CHECK.replace('"one")', '"one", "none")').replace("no such", "unknown"), []),
        (CHECK.replace('("both", "one")', "TABLE").replace("no such", "unknown"), []),
        ("    if kind:\n" + NESTED.replace("no such", "unknown"), []),
        (CHECK.replace(', "one"', "").replace("no such", "unknown"),
         ["added: raise RuntimeError('unknown kind')"]),
        (CHECK + "    if kind == 'both':\n        pass\n    elif kind == 'one':\n        pass\n    else:\n"
         "        exit()\n", []),
        (CHECK + "    if kind == 'both':\n        pass\n    else:\n        exit()\n", ["added: exit()"]),
        (CHECK + "    if context:\n        if kind:\n            exit()\n", ["added: exit()"]),
    ],
)  # fmt: skip
def test_only_a_failure_under_other_conditions_is_new(review_changes, new, failures):
    _, found_breaking = review_changes("arm.launch.py", LAUNCH, CHECK, new)
    assert found_breaking == failures


@pytest.mark.parametrize(("default", "count"), [(', default_value=""', 0), ("", 1)])
def test_a_new_argument_with_a_default_does_not_fail(repository, compare, default, count):
    check = "    arms = LaunchConfiguration('arms').perform(context)\n    if arms not in TABLE:\n        exit(arms)\n"
    argument = f'        DeclareLaunchArgument("arms"{default}),\n{ARGUMENT}'
    repository.commit({"arm/launch/arm.launch.py": LAUNCH})
    repository.write({"arm/launch/arm.launch.py": LAUNCH.replace(CHECK, CHECK + check).replace(ARGUMENT, argument)})
    changes = [change for _, change in compare(repository).breaking_changes]
    assert sum("exit" in str(change.sentence) for change in changes) == count


def test_a_new_argument_whose_empty_value_is_replaced_does_not_fail(repository, compare):
    check = """    arms = LaunchConfiguration('arms').perform(context)
    if not arms:
        arms = 'both'
    if arms not in TABLE:
        exit(arms)
"""
    argument = f'        DeclareLaunchArgument("arms", default_value=""),\n{ARGUMENT}'
    repository.commit({"arm/launch/arm.launch.py": LAUNCH})
    repository.write({"arm/launch/arm.launch.py": LAUNCH.replace(CHECK, CHECK + check).replace(ARGUMENT, argument)})
    assert not breaking(compare(repository))


HELPER = """def resolve(arms, name="both"):
    if arms not in TABLE:
        raise RuntimeError(arms)
    if name not in TABLE:
        raise RuntimeError(name)


def setup(context):
"""


@pytest.mark.parametrize(
    ("call", "failures"),
    [
        ("resolve(LaunchConfiguration('arms').perform(context))", []),
        ("resolve(LaunchConfiguration('arms').perform(context), kind)", []),
        ("resolve(arms='a', name=LaunchConfiguration('arms').perform(context))", ["added: raise RuntimeError(arms)"]),
        ("resolve(kind + 'x')", ["added: raise RuntimeError(arms)"]),
        ("resolve(LaunchConfiguration('arms').perform(context), kind + 'x')", ["added: raise RuntimeError(name)"]),
        ("resolve(*kind)", []),
    ],
)
def test_the_tests_of_a_helper_hold_for_the_arguments_of_its_calls(review_changes, call, failures):
    argument = f'        DeclareLaunchArgument("arms", default_value="both"),\n{ARGUMENT}'
    old = LAUNCH[LAUNCH.index("def setup") :]
    new = old.replace("def setup(context):\n", HELPER).replace(ARGUMENT, argument)
    new = new.replace(CHECK, f"{CHECK}    {call}\n")
    _, found_breaking = review_changes("arm.launch.py", LAUNCH, old, new)
    assert found_breaking == failures


def test_the_condition_of_a_failure_has_the_conditions_around_it(repository, compare):
    check = "    if context or nodes:\n        if kind in BOTH:\n            exit(1)\n"
    repository.commit({"arm/launch/arm.launch.py": LAUNCH})
    repository.write({"arm/launch/arm.launch.py": LAUNCH.replace(CHECK, CHECK + check)})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.reason) == "the launch file fails if `(context or nodes) and kind in BOTH`"


def test_a_launch_file_that_lost_an_import_fails(review_changes):
    line = "from launch.substitutions import LaunchConfiguration\n"
    expected = "uses 'LaunchConfiguration', which it no longer defines or imports"
    assert review_changes("arm.launch.py", LAUNCH, line, "") == ([expected], [expected])


def test_names_that_nothing_defines_are_told_of_an_added_launch_file(repository, compare):
    path = "arm/launch/arm.launch.py"
    repository.commit({"README.md": ""})
    repository.write({path: LAUNCH.replace('kind == "both"', "kind == sides")})
    result = compare(repository)
    assert sentences(subject(result, path))[1:] == ["uses 'sides', which nothing defines"]
    assert not breaking(result)


SPAWNER = """def spawner(name, inactive=True):
    arguments = [name, "--controller-manager", "/cm"]
    if inactive:
        arguments.append("--inactive")
    else:
        arguments.append("--activate")
    if name_of_robot():
        arguments.extend(["--namespace", "arm"])
    arguments.extend(["--timeout", "5"])
    return Node(package="controller_manager", executable="spawner", arguments=arguments)
"""


@pytest.mark.parametrize(("call", "word"), [("item", "--inactive"), ("item, inactive=False", "--activate")])
def test_arguments_that_a_function_adds_to_a_list_are_told(review_changes, call, word):
    start, end = LAUNCH.index("def spawner"), LAUNCH.index("\n\ndef setup")
    text = LAUNCH.replace(LAUNCH[start:end], SPAWNER).replace("spawner(item)", f"spawner({call})")
    changes, _ = review_changes("arm.launch.py", text, 'BOTH = ["left", "right"', 'BOTH = ["left", "right", "top"')
    added = "--namespace (if `name_of_robot()`), arm (if `name_of_robot()`)"
    words = f"[top, --controller-manager, /cm, {word}, {added}, --timeout, 5]"
    assert f"node 'controller_manager/spawner' of 'top' added: if `kind == 'both'`, arguments {words}" in changes


ACTIONS = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    driver = Node(package="arm", executable="driver")
    return LaunchDescription([driver])
"""


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        ("[driver, hand]", ["uses 'hand', which it does not define or import"]),
        ("[driver] + [*hands]", ["uses 'hands', which it does not define or import"]),
        ("[driver, map]", ["the built-in function 'map' is in a list of actions"]),
        ("list([driver])", []),
    ],
)
def test_actions_that_are_not_defined_are_breaking(review_changes, new, expected):
    _, found = review_changes("arm.launch.py", ACTIONS, "[driver]", new)
    assert found == expected


@pytest.mark.parametrize(
    ("arguments", "is_breaking"),
    [
        ("[('a', 'b') ('c', 'd')]", True),
        ("[['a'] ['c', 'd']]", True),
        ("['a' ('c')]", True),
        ("[('a', 'b'), ('c', 'd')]", False),
        ("[['a', 'c'][0]]", False),
    ],
)
@pytest.mark.filterwarnings("ignore::SyntaxWarning")
def test_a_missing_comma_between_items_is_breaking(review_changes, arguments, is_breaking):
    new = f'executable="driver", arguments={arguments}'
    _, found = review_changes("arm.launch.py", ACTIONS, 'executable="driver"', new)
    text = "a comma is missing: an item of a list is called or indexed by the next one"
    assert found == ([text] if is_breaking else [])


@pytest.mark.parametrize(
    ("test", "condition"),
    [
        ("kind.endswith('.json')", "not kind.endswith('.json')"),
        ("kind == 'both' or kind in load()", "kind != 'both' and kind not in load()"),
        ("not kind", "kind"),
        ("kind and context", "not (kind and context)"),
    ],
)
def test_a_failure_in_an_else_branch_is_new_under_the_opposite_condition(repository, compare, test, condition):
    repository.commit({"arm/launch/arm.launch.py": LAUNCH})
    added = f"    if {test}:\n        print(kind)\n    else:\n        raise ValueError(kind)\n"
    repository.write({"arm/launch/arm.launch.py": LAUNCH.replace(CHECK, CHECK + added)})
    ((_, change),) = compare(repository).breaking_changes
    assert str(change.reason) == f"the launch file fails if `{condition}`"


@pytest.mark.parametrize(
    ("module", "argument", "is_breaking"),
    [
        ("launch_ros.actions", "arguements=['-d']", True),
        ("launch_ros.actions", "required=True", True),
        ("launch_ros.actions", "respawn_delay=2.0, emulate_tty=True, ros_arguments=[]", False),
        ("launch_ros.actions", "node_name='talker'", False),
        ("own_actions", "arguements=['-d']", False),
    ],
)
def test_an_argument_that_a_class_does_not_have_is_breaking(review_changes, module, argument, is_breaking):
    text = LAUNCH.replace("launch_ros.actions", module).replace("arguments=[name]", "name=name")
    _, found_breaking = review_changes("arm.launch.py", text, "name=name", f"name=name, {argument}")
    expected = f"unknown argument {argument.partition('=')[0]} added"
    assert any(expected in change for change in found_breaking) is is_breaking


def test_an_added_file_with_an_argument_that_a_class_does_not_have_fails(repository, compare):
    repository.commit({"README.md": "An arm."})
    repository.write({"arm/launch/arm.launch.py": LAUNCH.replace("arguments=[name]", "argument=[name]")})
    (change,) = subject(compare(repository), "arm/launch/arm.launch.py").changes
    assert "unknown argument argument" in str(change.sentence)
    assert str(change.sentence).endswith("; an action has wrong arguments, so that the file fails")
