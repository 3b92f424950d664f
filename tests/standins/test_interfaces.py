"""``from sensor_msgs.msg import JointState`` and its like, in a Python that has no ROS."""

from __future__ import annotations

import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

import linkwright
from linkwright.messages import get_message
from linkwright.standins.interfaces import find_spec

SOURCES = Path(linkwright.__file__).parent.parent

PREAMBLE = f"""
import sys
sys.path.insert(0, {str(SOURCES)!r})
from linkwright.standins import interfaces, modules
interfaces.install()
interfaces.install()
modules.install()
sys.path.append(modules.FOLDER)
"""

MANIFEST = """<?xml version="1.0"?>
<package format="3"><name>my_msgs</name><version>0.0.1</version><description>d</description>
<maintainer email="a@example.com">a</maintainer><license>MIT</license></package>
"""


def run_program(program, folder):
    """Return the output of a program in a folder."""
    result = subprocess.run(
        [sys.executable, "-c", PREAMBLE + textwrap.dedent(program)],
        cwd=folder, capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip
    assert result.returncode == 0, result.stderr
    return result.stdout


@pytest.fixture
def workspace(tmp_path):
    package = tmp_path / "src" / "my_msgs"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text(MANIFEST)
    (package / "msg" / "Count.msg").write_text("int32 n 5\n")
    (package / "msg" / "Wrong.msg").write_text("int32 X\n")
    return tmp_path


def test_messages_services_and_actions_are_importable(tmp_path):
    program = """
        from sensor_msgs.msg import JointState
        from sensor_msgs.msg._joint_state import JointState as Same
        from std_srvs.srv import SetBool, Trigger
        from std_srvs.srv._set_bool import SetBool_Request, SetBool_Response
        from example_interfaces.action import Fibonacci
        from example_interfaces.action._fibonacci import Fibonacci_Goal, Fibonacci_SendGoal_Request
        import nav_msgs
        import geometry_msgs.msg as geometry
        from linkwright import messages
        assert JointState is Same is messages.JointState
        assert SetBool.Request is SetBool_Request and SetBool.Response is SetBool_Response
        assert Fibonacci.Goal is Fibonacci_Goal
        assert Fibonacci.Impl.SendGoalService.Request is Fibonacci_SendGoal_Request
        print(nav_msgs.msg.Odometry, geometry.Twist().linear.x, 'TwistStamped' in dir(geometry))
        from tf2_msgs.msg import *
        assert TFMessage is messages.TFMessage
    """
    assert run_program(program, tmp_path) == "<class 'nav_msgs.msg._odometry.Odometry'> 0.0 True\n"


def test_missing_names_raise_import_error_with_suggestion(tmp_path):
    program = """
        for line in ("from std_msgs.msg import Strng", "from std_msgs.msg import JointState", "import nomsgs.msg",
                     "from std_msgs.srv import A", "import std_msgs.msg._strng", "import std_msgs.other",
                     "from std_msgs.msg import strng"):
            try:
                exec(line)
            except ImportError as error:
                print(type(error).__name__, error)
        import std_msgs.msg
        print(hasattr(std_msgs.msg, "something"), hasattr(std_msgs, "other"))
    """
    lines = run_program(program, tmp_path).splitlines()
    assert lines[0] == "ImportError cannot import name 'Strng' from 'std_msgs.msg': did you mean 'String'?"
    assert lines[1].startswith("ImportError cannot import name 'JointState' from 'std_msgs.msg': it has Bool, Byte, ")
    assert lines[2] == "ModuleNotFoundError No module named 'nomsgs'"
    assert lines[3] == "ModuleNotFoundError No module named 'std_msgs.srv'"
    assert lines[4] == "ModuleNotFoundError No module named 'std_msgs.msg._strng'"
    assert lines[5] == "ModuleNotFoundError No module named 'std_msgs.other'"
    assert lines[6].startswith("ImportError cannot import name 'strng' from 'std_msgs.msg'")
    assert lines[7] == "False False"


@pytest.mark.parametrize("below", ["", "src", "src/my_msgs"])
def test_workspace_package_is_importable_without_build(workspace, below):
    # In src, Python itself would import the folders my_msgs and my_msgs/msg as empty packages.
    program = """
        sys.path.insert(0, "")
        from my_msgs.msg import Count
        from my_msgs.msg._count import Count as Same
        assert Count is Same
        print(Count())
        try:
            from my_msgs.msg import Wrong
        except ImportError as error:
            print(error)
    """
    first, second = run_program(program, workspace / below).splitlines()
    assert first == "my_msgs.msg.Count(n=5)"
    assert second.endswith("Wrong.msg:1:7: 'X' is not a valid name for a field")


@pytest.mark.parametrize("line", ["from my_msgs.msg import Wrong", "import my_msgs.msg._wrong"])
def test_malformed_interface_file_raises_one_traceback(workspace, line):
    program = textwrap.dedent(PREAMBLE) + f"{line}\n"
    result = subprocess.run(
        [sys.executable, "-c", program], cwd=workspace, capture_output=True, text=True, check=False, timeout=60
    )
    assert result.returncode == 1
    assert result.stderr.count("Traceback") == 1
    last = result.stderr.splitlines()[-1]
    assert last.startswith("ImportError: ")
    assert last.endswith("Wrong.msg:1:7: 'X' is not a valid name for a field")


def test_installed_package_takes_precedence(tmp_path):
    package = tmp_path / "std_msgs" / "msg"
    package.mkdir(parents=True)
    (tmp_path / "std_msgs" / "__init__.py").touch()
    (package / "__init__.py").write_text("class String: installed = True\n")
    program = """
        sys.path.insert(0, "")
        from std_msgs.msg import String
        print(String.installed)
    """
    assert run_program(program, tmp_path) == "True\n"


def test_python_package_and_messages_can_share_a_name(workspace):
    module = workspace / "src" / "my_msgs" / "my_msgs"
    module.mkdir()
    (module / "__init__.py").write_text("helper = 1\n")
    program = """
        sys.path.insert(0, "src/my_msgs")
        import my_msgs
        from my_msgs.msg import Count
        print(my_msgs.helper, Count().n)
    """
    assert run_program(program, workspace) == "1 5\n"


def test_rosidl_runtime_py_functions_work(tmp_path):
    program = """
        from rosidl_runtime_py import message_to_yaml, message_to_csv, message_to_ordereddict, set_message_fields
        from rosidl_runtime_py import get_message_interfaces, get_interfaces
        from rosidl_runtime_py.convert import get_message_slot_types
        from rosidl_runtime_py.utilities import get_message, get_service, get_action, get_interface
        from rosidl_parser.definition import BasicType, UnboundedSequence
        from rosidl_runtime_py.utilities import import_message_from_namespaced_type
        Header = get_message("std_msgs/msg/Header")
        message = Header(frame_id="a")
        print(message_to_yaml(message), message_to_csv(message), message_to_ordereddict(message)["frame_id"])
        set_message_fields(message, {"frame_id": "b"})
        assert message.frame_id == "b"
        slots = get_message_slot_types(get_message("sensor_msgs/msg/JointState"))
        assert slots["position"] == UnboundedSequence(BasicType("double"))
        assert import_message_from_namespaced_type(slots["header"]) is Header
        assert get_action("turtlesim/action/RotateAbsolute") and get_service("std_srvs/srv/Empty")
        assert get_message_interfaces(["turtlesim"]) == {"turtlesim": ["msg/Color", "msg/Pose"]}
        assert get_interfaces(["std_srvs"]) == {"std_srvs": ["srv/Empty", "srv/SetBool", "srv/Trigger"]}
        for wrong in ("std_msgs/msg/Foo", "foo_msgs/msg/Foo", "std_msgs/Foo", "std_srvs/srv/Empty"):
            try:
                get_message(wrong)
            except Exception as error:
                print(type(error).__name__)
        for values, kind in (({"frame": "a"}, AttributeError), ({"stamp": 3}, TypeError)):
            try:
                set_message_fields(message, values)
            except kind as error:
                print(error)
    """
    assert run_program(program, tmp_path).splitlines() == [
        "stamp:",
        "  sec: 0",
        "  nanosec: 0",
        "frame_id: a",
        " 0,0,a a",
        "AttributeError",
        "ModuleNotFoundError",
        "ValueError",
        "ValueError",
        "std_msgs/msg/Header has no field 'frame'",
        "'stamp' must be a mapping of fields to values, not 3",
    ]


def test_other_modules_are_not_intercepted():
    assert find_spec("std_msgs.msg.something.deeper") is None
    assert find_spec("std_msgs.launch") is None
    assert find_spec("Std_msgs") is None
    assert find_spec("json") is None
    assert find_spec("std_msgs.msg") is not None
    assert get_message("std_msgs/msg/String")
