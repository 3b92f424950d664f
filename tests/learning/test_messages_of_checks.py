"""Messages of checks name the place of a mistake and its fix.

The tests cover files, links, programs, and topics without messages.
"""

import sys

import pytest

from linkwright.diagnostics.lookalikes import lookalike_hint, to_ascii_text
from linkwright.learning import NotYet, Work, expect_published
from linkwright.learning.checks.programs import describe_failure
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


@pytest.mark.parametrize(
    ("manifest", "message"),
    [
        ("<package format='3'><name>q</name></package>", r"has the name 'q'; write <name>p</name>"),
        ("<package format='3'></package>", r"has no <name>; write <name>p</name>"),
        ("<package format='3'>＜name>p</name></package>", r"package\.xml, line 1, .*ASCII character"),
    ],
)
def test_package_with_another_name_than_its_folder_is_explained(package, manifest, message):
    (package.folder / "package.xml").write_text(manifest, encoding="utf-8")
    with pytest.raises(NotYet, match=message):
        Work(package.workspace, lesson=package.workspace).package("p")


def test_package_beside_src_is_explained(package):
    package.folder.rename(package.workspace / "p")
    with pytest.raises(NotYet, match="beside the folder 'src'; move it into 'src'"):
        Work(package.workspace, lesson=package.workspace).package("p")
    (package.workspace / "p").rename(package.workspace / "q")
    package.folder.mkdir()
    with pytest.raises(NotYet, match=r"'src/p' has no file package\.xml"):
        Work(package.workspace, lesson=package.workspace).package("p")


def test_missing_file_message_names_file_beside_it(package):
    (package.folder / "rviz").mkdir()
    (package.folder / "rviz" / "mbot.rviz").write_text("x")
    with pytest.raises(NotYet, match=r"has no file 'rviz/urdf\.rviz'; it has 'rviz/mbot\.rviz'"):
        package.file("rviz/urdf.rviz")


JOINT = '<joint name="{name}" type="continuous"><parent link="a"/><child link="{child}"/>{axis}</joint>'


@pytest.mark.parametrize(
    ("links", "joints", "message"),
    [
        (
            "ab",
            [("j", "b", '<axis rpy="0 1 0"/>')],
            r"axis of the joint 'j' has no direction; write <axis xyz=\"0 1 0\"/>",
        ),
        ("abc", [("j", "b", ""), ("k", "b", "")], r"link 'b' is the child of two joints, 'j' and 'k'"),
        ("abb", [("j", "b", ""), ("k", "c", "")], r"link 'b' is defined twice"),
    ],
)
def test_copied_or_incomplete_joint_is_explained(package, links, joints, message):
    elements = [f'<link name="{name}"/>' for name in links]
    elements += [JOINT.format(name=name, child=child, axis=axis) for name, child, axis in joints]
    (package.folder / "r.urdf").write_text(f'<robot name="r">{"".join(elements)}</robot>')
    with pytest.raises(NotYet, match=message):
        package.robot("r.urdf").joint("j").expect_axis((0, 1, 0))


def test_other_place_of_installed_file_is_named(package):
    (package.folder / "launch").mkdir()
    (package.folder / "launch" / "d.launch.py").write_text("x")
    marker = "('share/ament_index/resource_index/packages', ['resource/p'])"
    files = f"{marker}, ('share/p', ['package.xml', 'launch/d.launch.py'])"
    (package.folder / "setup.py").write_text(f"from setuptools import setup\nsetup(name='p', data_files=[{files}])\n")
    with pytest.raises(NotYet, match=r"does not install 'launch/d\.launch\.py' in 'share/p/launch', but in 'share/p'"):
        package.expect_installed("launch/d.launch.py")


def test_called_function_is_not_taken_for_a_defined_one(package):
    write_program(package, "pass")
    text = (package.folder / "p" / "move.py").read_text()
    (package.folder / "p" / "move.py").write_text(
        text.replace("def main", "def man") + "if __name__ == 'x':\n    main()\n"
    )
    with pytest.raises(NotYet, match=r"move\.py has no function 'main'; it has 'man'"):
        package.program("move")


def test_module_beside_its_folder_is_named(package):
    write_program(package, "pass")
    (package.folder / "p" / "move.py").rename(package.folder / "move.py")
    with pytest.raises(NotYet, match=r"move 'move\.py' into the folder 'p'"):
        package.program("move")


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ("('share/p', glob('launch/*'))", "write 'from glob import glob' at the top of the file"),
        ("('share/p', []) ('share/q', [])", "a comma is missing at the end of an entry of data_files"),
    ],
)
def test_mistake_in_data_files_is_explained(package, entries, message):
    (package.folder / "setup.py").write_text(f"from setuptools import setup\nsetup(name='p', data_files=[{entries}])\n")
    with pytest.raises(NotYet, match=message):
        package.expect_installed()


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
        ("'move = p.move.main'", "the entry names no function; write 'move = p.move:main'"),
        ("'move = p.move:start'", r"move\.py has no function 'start'; it has 'main'"),
        ("'other = p.move:main'\n'move = p.move:main'", "line 2: a comma is missing at the end of the line"),
        ("‘move = p.move:main’", "ASCII character"),
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
    assert to_ascii_text("０.２０ –１") == "0.20 -1"
    assert "'('" in lookalike_hint("init（）")
    assert lookalike_hint("init()") is None


def test_timeout_of_a_busy_computer_is_explained(tmp_path):
    assert "too busy" in describe_failure(TimeoutError(), tmp_path)
