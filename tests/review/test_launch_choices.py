"""Values of Python launch files that both branches of a statement assign, and guarded environment variables."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

LAUNCH = """import os
from launch import LaunchDescription
from launch_ros.actions import Node
from others.launching import Waiter, Starter

def generate_launch_description():
{code}
    node = Node(package='arm', executable='drive', remappings=mappings)
    return LaunchDescription([node])
"""
PLAIN = "    mappings = [('cmd_vel_unstamped', 'cmd_vel'), ('odom', 'robot/odom')]"
CHOSEN = """    if os.environ.get('STAMPED'):
        mappings = [('cmd_vel', 'robot/cmd_vel'), ('odom', 'robot/odom')]
    else:
        mappings = [('cmd_vel_unstamped', 'cmd_vel'), ('odom', 'robot/odom')]"""


@pytest.fixture
def review_code(repository, compare):
    """Review a change to the code of a launch file; return its lines and the breaking ones."""

    def run(old: str, new: str):
        path = "arm/launch/arm.launch.py"
        repository.commit({"arm/package.xml": PACKAGE_XML, path: LAUNCH.format(code=old)})
        repository.write({path: LAUNCH.format(code=new)})
        result = compare(repository)
        return [line for found in result.subjects for line in sentences(found)], breaking(result)

    return run


def test_remappings_that_a_statement_chooses_have_its_condition(review_code):
    lines, _ = review_code(PLAIN, CHOSEN)
    node = "node 'arm/drive': "
    assert [line for line in lines if line.startswith(node)] == [
        f"{node}remapping cmd_vel robot/cmd_vel (if `os.environ.get('STAMPED')`) added",
        f"{node}remapping cmd_vel_unstamped cmd_vel -> cmd_vel (unless `os.environ.get('STAMPED')`)",
    ]


@pytest.mark.parametrize(
    "branches",
    [
        "    if os.name:\n        mappings = [('a', 'b')]\n    else:\n        mappings = [('a', 'b')]",
        "    mappings = [('a', 'b')] if os.environ.get('A') else [('a', 'b')]",
    ],
)
def test_equal_values_of_all_branches_are_no_change(review_code, branches):
    lines, _ = review_code("    mappings = [('a', 'b')]", branches)
    assert not [line for line in lines if "remapping" in line]


def test_value_that_a_branch_replaces_has_its_condition(review_code):
    override = "    if os.environ.get('A'):\n        mappings = [('odom', 'robot/odom')]"
    lines, _ = review_code(PLAIN, f"{PLAIN}\n{override}")
    assert "node 'arm/drive': remapping cmd_vel_unstamped cmd_vel -> cmd_vel (unless `os.environ.get('A')`)" in lines
    assert not [line for line in lines if "odom" in line and line.startswith("node")]


def test_value_that_a_branch_extends_is_not_known(review_code):
    lines, _ = review_code(PLAIN, f"{PLAIN}\n    if os.environ.get('A'):\n        mappings += [('a', 'b')]")
    assert not [line for line in lines if "(if" in line or "(unless" in line]


def test_action_of_both_lists_has_no_condition(repository, compare):
    code = """from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    first = Node(package='arm', executable='first')
    second = Node(package='arm', executable='second')
    nodes = [first]
CHOICE    return LaunchDescription(nodes)
"""
    choice = "    if first:\n        nodes = [first, second]\n"
    path = "arm/launch/arm.launch.py"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: code.replace("CHOICE", "")})
    repository.write({path: code.replace("CHOICE", choice)})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert not [line for line in lines if "'arm/first'" in line]


@pytest.mark.parametrize(
    ("reading", "is_breaking"),
    [
        ("os.environ['MODEL']", True),
        ("'MODEL' in os.environ and os.environ['MODEL'] == 'a'", False),
        ("'MODEL' not in os.environ or os.environ['MODEL'] == 'a'", False),
        ("'MODEL' in os.environ or os.environ['MODEL'] == 'a'", True),
        ("os.environ['MODEL'] if 'MODEL' in os.environ else ''", False),
        ("'' if 'MODEL' in os.environ else os.environ['MODEL']", True),
        ("os.environ.get('MODEL') and os.environ['MODEL']", False),
        ("'OTHER' in os.environ and os.environ['MODEL']", True),
        ("os.environ['ROS_DISTRO']", False),
        ("os.environ['LD_LIBRARY_PATH']", False),
    ],
)
def test_environment_variable_that_is_only_read_if_it_is_set_is_not_required(review_code, reading, is_breaking):
    lines, found = review_code(PLAIN, f"{PLAIN}\n    model = {reading}")
    assert any(line.startswith("use of environment variable") for line in lines)
    assert [line.partition(" '")[0] for line in found] == ["use of environment variable"] * is_breaking


@pytest.mark.parametrize(
    ("code", "is_breaking"),
    [
        ("    if 'MODEL' in os.environ:\n        model = os.environ['MODEL']", False),
        ("    if 'MODEL' not in os.environ:\n        a = ''\n    else:\n        a = os.environ['MODEL']", False),
        ("    try:\n        model = os.environ['MODEL']\n    except KeyError:\n        model = ''", False),
        ("    try:\n        model = os.environ['MODEL']\n    except TypeError:\n        model = ''", True),
    ],
)
def test_environment_variable_in_a_guarded_block_is_not_required(review_code, code, is_breaking):
    assert bool(review_code(PLAIN, f"{PLAIN}\n{code}")[1]) is is_breaking


def test_added_file_lists_actions_of_other_packages_and_event_handlers(repository, compare):
    text = """from launch import LaunchDescription
from launch.actions import RegisterEventHandler
from launch.event_handlers import OnProcessExit
from others.launching import Starter, Waiter

def generate_launch_description():
    starter = Starter(package='arm', executable='drive', parameters=[{'rate': 5}])
    return LaunchDescription([
        starter,
        Waiter(target=starter),
        RegisterEventHandler(OnProcessExit(target_action=starter)),
    ])
"""
    repository.commit({"arm/package.xml": PACKAGE_XML})
    repository.write({"arm/launch/arm.launch.py": text})
    (line,) = [line for found in compare(repository).subjects for line in sentences(found)]
    assert line == (
        "launch file added: action 'Starter' (parameter rate 5, package arm, executable drive), "
        "action 'Waiter' (target Starter), event handler OnProcessExit of Starter"
    )


def test_changed_code_of_functions_is_reported_with_their_names(repository, compare):
    code = """from launch import LaunchDescription

def read(name):
    values = {'a': 1}
    return values[name]

def write(name):
    print(name)

def generate_launch_description():
    return LaunchDescription([])
"""
    path = "arm/launch/arm.launch.py"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: code})
    changed = code.replace("return values[name]", "values.pop('b', None)\n    return dict(values)")
    repository.write({path: changed.replace("    print(name)", "    open(name, 'w').write(name)")})
    (line,) = [line for found in compare(repository).subjects for line in sentences(found)]
    assert line.startswith("other code changed in 'read()', 'write()', such as ")


def test_settings_that_code_changes_are_told_with_their_conditions(repository, compare):
    code = """from launch import LaunchDescription
from launch.actions import OpaqueFunction
from launch_ros.actions import Node

def setup(context):
    values = {'rate': 5}
    names = []
    fast = context.launch_configurations['fast']
    if fast == '1':
        values['gain'] = 2
    node = Node(package='arm', executable='drive', parameters=[values], remappings=names)
    return [node]

def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=setup)])
"""
    path = "arm/launch/arm.launch.py"
    new = code.replace("values['gain'] = 2", "names.append(('image', 'eye'))\n    else:\n        values['slow'] = True")
    repository.commit({"arm/package.xml": PACKAGE_XML, path: code})
    repository.write({path: new.replace("'fast'", "'quick'")})
    line = next(line for line in sentences(subject(compare(repository), path)) if line.startswith("other code"))
    assert line == (
        "other code changed in 'setup()', such as `if fast == '1': names.append(('image', 'eye'))` added, "
        "`if not (fast == '1'): values['slow'] = True` added, `if fast == '1': values['gain'] = 2` removed"
    )


RETURNING = """from launch import LaunchDescription
from launch.actions import OpaqueFunction
from launch_ros.actions import Node

def setup(context):
    first = Node(package='arm', executable='first')
RETURN    return [first, Node(package='arm', executable='second')]

def generate_launch_description():
    return LaunchDescription([OpaqueFunction(function=setup)])
"""


@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("    if not context.ready:\n        return []\n",
         ["node 'arm/first', node 'arm/second': condition unless `not context.ready` added"]),
        ("    if not context.ready:\n        context.ready = 1\n", []),
        ("    if not context.ready:\n        return []\n    else:\n        context.ready = 1\n", []),
    ],
)  # fmt: skip
def test_actions_behind_a_return_have_its_condition(repository, compare, statement, expected):
    path = "arm/launch/arm.launch.py"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: RETURNING.replace("RETURN", "")})
    repository.write({path: RETURNING.replace("RETURN", statement)})
    result = compare(repository)
    lines = [line for found in result.subjects for line in sentences(found)]
    assert [line for line in lines if line.startswith("node")] == expected
    assert breaking(result) == []


def test_long_condition_is_compared_by_its_terms(repository, compare):
    path = "arm/launch/arm.launch.py"
    known = "    if not context.is_known_robot_with_a_long_name(first_argument, second_argument):\n        return []\n"
    added = "    if context.find_planning_variant_of_robot('planning_urdf_variant') != 'xacro':\n        return []\n"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: RETURNING.replace("RETURN", known)})
    repository.write({path: RETURNING.replace("RETURN", known + added + known.replace("known", "good"))})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    (line,) = [line for line in lines if line.startswith("node")]
    assert line == (
        "node 'arm/first', node 'arm/second': condition: "
        "unless `context.find_planning_variant_of_robot('planning_urdf_variant') != 'xacro'`, "
        "unless `not context.is_good_robot_with_a_long_name(first_argument, second_argument)` added"
    )


def test_equal_functions_beside_added_functions_are_not_reported(repository, compare):
    code = """import os
from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch.actions import ExecuteProcess

def config_file(pkg, name):
    path = os.path.join(get_package_share_directory(pkg), 'config', name)
    return path

def add_router():
    action = ExecuteProcess(cmd=['router'], output='screen')
    return action

def generate_launch_description():
    return LaunchDescription([add_router()])
"""
    path = "arm/launch/arm.launch.py"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: code})
    added = """def launch_file(pkg, name):
    path = os.path.join(get_package_share_directory(pkg), 'launch', name)
    return path

def write(name):
    action = open(name, 'w')
    return action

def add_router"""
    repository.write({path: code.replace("def add_router", added)})
    (line,) = [line for found in compare(repository).subjects for line in sentences(found)]
    assert "launch_file" in line
    assert "config_file" not in line
    assert "add_router" not in line


def test_values_of_equal_functions_are_still_reported(repository, compare):
    code = """from launch import LaunchDescription

TIMEOUT = 5

def wait(process):
    process.wait(TIMEOUT)

def generate_launch_description():
    return LaunchDescription([])
"""
    path = "arm/launch/arm.launch.py"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: code})
    repository.write({path: code.replace("TIMEOUT = 5", "TIMEOUT = 9")})
    assert [line for found in compare(repository).subjects for line in sentences(found)] == [
        "other code: TIMEOUT = 5 -> TIMEOUT = 9"
    ]


SECOND_LASER = """<launch>
  <arg name="second" default="$(optenv SECOND {default})"/>
  <group if="$(arg second)">
    <node pkg="laser" type="laser" name="rear"><param name="host" value="$(env LASER_IP)"/></node>
  </group>
  {more}
</launch>
"""


@pytest.mark.parametrize(
    ("default", "more", "is_breaking"),
    [
        ("false", "", False),
        ("true", "", True),
        ("false", '<node pkg="a" type="b" name="c" ns="$(env LASER_IP)"/>', True),
        ("false", '<group if="$(env LASER_IP)"><node pkg="a" type="b" name="c"/></group>', True),
    ],
)
def test_variable_that_only_nodes_read_which_do_not_start(repository, compare, default, more, is_breaking):
    repository.commit({"arm/launch/arm.launch": "<launch/>"})
    repository.write({"arm/launch/arm.launch": SECOND_LASER.format(default=default, more=more)})
    line = "use of environment variable 'LASER_IP' added"
    assert line in sentences(subject(compare(repository), "arm/launch/arm.launch"))
    assert (line in breaking(compare(repository))) is is_breaking


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("os.environ['MODELS'] = '/a'", "os.environ['MODELS'] = '/b'", "value /a -> /b"),
        ("os.environ['MODELS'] += ':/a'", "os.environ['MODELS'] += ':/b'", "appended value :/a -> :/b"),
    ],
)
def test_variable_that_a_statement_sets_is_compared_as_an_action(review_code, old, new, expected):
    found, _ = review_code(f"{PLAIN}\n    {old}", f"{PLAIN}\n    {new}")
    assert found == [f"environment variable 'MODELS': {expected}"]
    found, _ = review_code(f"{PLAIN}\n    if PLAIN:\n        {old}", f"{PLAIN}\n    if PLAIN:\n        {new}")
    assert [line for line in found if line.startswith("other code")]
