"""Checks say where a mistake is and what to do: of files, links, programs, and topics without messages."""

import sys

import pytest

from linkwright.diagnostics.lookalikes import lookalike_hint, plain_text
from linkwright.learning import NotYet, Work, expect_published
from linkwright.testing import SteppedGraph

TWIST = "geometry_msgs/msg/Twist"
SETUP = """from setuptools import setup
setup(name='p', entry_points={{'console_scripts': [{entries}]}})
"""
NODE = """import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from std_msgs.msg import String


def main():
    rclpy.init()
    node = rclpy.create_node('mover')
    {body}
    rclpy.spin(node)
"""


@pytest.fixture
def package(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "path", list(sys.path))
    for name in [name for name in sys.modules if name.partition(".")[0] == "p"]:
        monkeypatch.delitem(sys.modules, name)
    folder = tmp_path / "src" / "p"
    (folder / "p").mkdir(parents=True)
    (folder / "p" / "__init__.py").touch()
    dependency = "<build_depend>rviz2</build_depend>"
    (folder / "package.xml").write_text(f"<package format='3'><name>p</name>{dependency}</package>")
    return Work(tmp_path, lesson=tmp_path).package("p")


def write_program(package, body, entries="'move = p.move:main'"):
    (package.folder / "setup.py").write_text(SETUP.format(entries=entries))
    (package.folder / "p" / "move.py").write_text(NODE.format(body=body))


def test_missing_file_message_names_similar_file(package):
    (package.folder / "robot.urdf.txt").write_text("x")
    (package.workspace / "world.sdf").write_text("x")
    with pytest.raises(NotYet, match=r"has no file 'urdf/robot\.urdf'; it has 'robot\.urdf\.txt'"):
        package.file("urdf/robot.urdf")
    with pytest.raises(NotYet, match=r"has no file 'worlds/world\.world'; the workspace has 'world\.sdf'"):
        package.file("worlds/world.world")


@pytest.mark.parametrize(
    ("file", "text", "message"),
    [
        ("setup.py", "from setuptools import setup\nsetup(name='p',\n", r"setup\.py, line 2: .*never closed"),
        ("package.xml", "<package format='3'><name>p</name></export></package>", r"package\.xml, line 1, .*XML201"),
    ],
)
def test_a_package_that_cannot_be_built_is_refused(package, file, text, message):
    (package.folder / file).write_text(text)
    with pytest.raises(NotYet, match=message):
        Work(package.workspace, lesson=package.workspace).package("p")


def test_misplaced_link_is_reported(package):
    (package.folder / "r.urdf").write_text('<robot name="r"><link name="a"><link name="b"/></link></robot>')
    with pytest.raises(NotYet, match=r"no link is called 'b'; r\.urdf, line 1: it is inside <link>"):
        package.robot("r.urdf").link("b")


def test_build_depend_alone_is_not_enough(package):
    with pytest.raises(NotYet, match=r"line 1 has <build_depend>, but <exec_depend> is needed"):
        package.expect_dependencies("rviz2")


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ("'move = p.move.py:main'", "write 'move = p.move:main'"),
        ("'move = move:main'", "write 'move = p.move:main'"),
        ("'move = p.move'", "the entry names no function; write 'move = p.move:main'"),
        ("'move = p.move:start'", r"move\.py has no function 'start'; it has 'main'"),
        ("'other = p.move:main'\n'move = p.move:main'", "line 2: a comma is missing at the end of the line"),
        ("‘move = p.move:main’", "English keyboard"),
    ],
)
def test_entry_point_error_of_setup_py_is_explained(package, entries, message):
    write_program(package, "pass", entries)
    with pytest.raises(NotYet, match=message):
        package.program("move")


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("pass", "the node has no publisher"),
        ("node.create_publisher(Twist, 'cmd_vel', 10)", "is there a timer"),
        ("node.create_publisher(TwistStamped, 'cmd_vel', 10)", "publishes geometry_msgs/msg/TwistStamped there"),
        ("node.create_publisher(Twist, 'cmd_val', 10)", "the program publishes /cmd_val"),
        (
            "node.create_publisher(Twist, 'cmd_vel', 10), node.create_subscription(String, 'texts', print, 10)",
            "subscribes to /texts, but no node publishes it; messages of this type are published on /text",
        ),
    ],
)
def test_topic_without_messages_is_explained(package, body, message):
    from linkwright.messages import get_message

    write_program(package, body)
    with SteppedGraph() as test:
        commands = test.record("/cmd_vel", TWIST)
        test.start_program(package.program("move"))
        test.publish("/text", get_message("std_msgs/msg/String")(data="go"))
        test.advance(0.5)
        assert test.program_nodes == [("mover", "/")]
        with pytest.raises(NotYet, match=message):
            expect_published(test, "/cmd_vel", TWIST, commands)


def test_full_width_characters_are_replaced_or_reported():
    assert plain_text("０.２０ –１") == "0.20 -1"
    assert "'('" in lookalike_hint("init（）")
    assert lookalike_hint("init()") is None
