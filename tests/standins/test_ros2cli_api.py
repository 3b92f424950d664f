"""The functions of ``ros2pkg.api``, ``ros2run.api`` and ``ros2topic.api`` that programs use."""

from __future__ import annotations

from argparse import ArgumentTypeError

import pytest
import rclpy
from ros2pkg.api import PackageNotFound, get_executable_paths, get_package_names, get_prefix_path
from ros2run.api import MultipleExecutables, get_executable_path, run_executable
from ros2topic.api import get_msg_class, get_topic_names, get_topic_names_and_types, positive_int, unsigned_int
from std_msgs.msg import Int32, String

from linkwright.packages import PackageFinder, use_finder


@pytest.fixture
def node(monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    rclpy.init(args=[])
    yield rclpy.create_node("tested", namespace="robot")
    rclpy.try_shutdown()


def test_packages_and_executables_are_listed(tmp_path):
    program = tmp_path / "lib" / "arm" / "move"
    hidden = tmp_path / "lib" / "arm" / ".cache" / "x"
    for path in (program, hidden):
        path.parent.mkdir(parents=True)
        path.write_text("#!/bin/sh\n")
        path.chmod(0o755)
    (tmp_path / "lib" / "arm" / "data.txt").write_text("")
    marker = tmp_path / "share" / "ament_index" / "resource_index" / "packages" / "arm"
    marker.parent.mkdir(parents=True)
    marker.write_text("")
    (tmp_path / "share" / "arm").mkdir()
    (tmp_path / "share" / "arm" / "package.xml").write_text("<package><name>arm</name></package>")
    finder = PackageFinder(start=tmp_path, environment={"AMENT_PREFIX_PATH": str(tmp_path)})
    with use_finder(finder):
        assert "arm" in get_package_names()
        assert get_prefix_path("arm") == str(tmp_path)
        assert get_prefix_path("none") is None
        assert get_executable_paths(package_name="arm") == [str(program)]
        with pytest.raises(PackageNotFound):
            get_executable_paths(package_name="none")


def make_package(folder, *programs):
    """Create an unbuilt package that installs programs."""
    (folder / "arm").mkdir()
    (folder / "arm" / "package.xml").write_text("<package><name>arm</name></package>")
    for program in programs:
        path = folder / "arm" / program
        path.parent.mkdir(exist_ok=True)
        path.write_text("#!/bin/sh\nexit $1\n")
        path.chmod(0o755)
    (folder / "arm" / "CMakeLists.txt").write_text(
        f"install(PROGRAMS {' '.join(programs)} DESTINATION lib/${{PROJECT_NAME}})\n"
    )
    return PackageFinder(start=folder, environment={})


def test_programs_of_unbuilt_packages_are_found_and_run(tmp_path, capsys):
    with use_finder(make_package(tmp_path, "scripts/move")):
        path = get_executable_path(package_name="arm", executable_name="move")
        assert path == str(tmp_path / "arm" / "scripts" / "move")
        assert get_executable_path(package_name="arm", executable_name="none") is None
        with pytest.raises(PackageNotFound):
            get_executable_path(package_name="leg", executable_name="move")
    assert run_executable(path=path, argv=["0"]) == 0
    assert capsys.readouterr().out == ""
    assert run_executable(path=path, argv=["3"], prefix=["/bin/sh"]) == 3
    assert "[ros2run]: Process exited with failure 3" in capsys.readouterr().out
    assert run_executable(path=None, argv=[]) == 1
    assert "the program was not found" in capsys.readouterr().out


def test_two_programs_of_a_name_are_an_error(tmp_path):
    for folder in ("a", "b"):
        program = tmp_path / "lib" / "arm" / folder / "move"
        program.parent.mkdir(parents=True)
        program.write_text("#!/bin/sh\n")
        program.chmod(0o755)
    (tmp_path / "share" / "arm").mkdir(parents=True)
    (tmp_path / "share" / "arm" / "package.xml").write_text("<package><name>arm</name></package>")
    marker = tmp_path / "share" / "ament_index" / "resource_index" / "packages" / "arm"
    marker.parent.mkdir(parents=True)
    marker.write_text("")
    finder = PackageFinder(start=tmp_path, environment={"AMENT_PREFIX_PATH": str(tmp_path)})
    with use_finder(finder), pytest.raises(MultipleExecutables) as raised:
        get_executable_path(package_name="arm", executable_name="move")
    assert len(raised.value.paths) == 2


def test_topics_and_message_classes_are_found(node, capsys):
    node.create_publisher(String, "talk", 1)
    node.create_publisher(String, "_quiet", 1)
    assert ("/robot/talk", ["std_msgs/msg/String"]) in get_topic_names_and_types(node=node)
    assert "/robot/_quiet" not in get_topic_names(node=node)
    assert "/robot/_quiet" in get_topic_names(node=node, include_hidden_topics=True)
    assert get_msg_class(node, "talk") is String
    assert get_msg_class(node, "/none") is None
    assert "topic [/none] does not appear to be published yet" in capsys.readouterr().out
    with pytest.raises(RuntimeError, match="must not contain"):
        get_msg_class(node, "a b")
    node.create_subscription(Int32, "talk", print, 1)
    with pytest.raises(RuntimeError, match="more than one type"):
        get_msg_class(node, "talk")


def test_argument_types_parse_integers():
    assert (unsigned_int("0"), positive_int("1")) == (0, 1)
    for read, text in ((unsigned_int, "-1"), (positive_int, "0")):
        with pytest.raises(ArgumentTypeError):
            read(text)
