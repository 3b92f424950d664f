"""Launch files in Python: loading, and the location of errors."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.launch.frontend import python_file
from linkwright.launch.frontend.launch_file import load_launch_file
from linkwright.launch.frontend.python_file import load_python_launch_file
from linkwright.packages.share_layout import find_share_of_sources

Write = Callable[[str, str], Path]

HEAD = "from launch import LaunchDescription\n"


def load_diagnostic(path: Path) -> Diagnostic:
    with pytest.raises(LinkwrightError) as caught:
        load_python_launch_file(path)
    (diagnostic,) = caught.value.diagnostics
    return diagnostic


def marked_text(diagnostic: Diagnostic) -> str:
    """Return the text at the location of the diagnostic, in one line."""
    span, source = diagnostic.span, diagnostic.source
    assert span is not None
    assert source is not None
    return source.text[source.offset(span.line, span.column) : source.offset(span.end_line, span.end_column)]


def test_launch_file_has_absolute_file_variable(write: Write) -> None:
    path = write(
        "a.launch.py",
        HEAD + "HERE = __file__\ndef generate_launch_description():\n"
        "    assert HERE.endswith('a.launch.py')\n    return LaunchDescription()\n",
    )
    assert load_python_launch_file(path).entities == []


def test_missing_file_is_reported_with_hint(write: Write, tmp_path: Path) -> None:
    write("display.launch.py", "")
    diagnostic = load_diagnostic(tmp_path / "dispaly.launch.py")
    assert diagnostic.code == "LAUNCH101"
    assert diagnostic.hint == "did you mean 'display.launch.py'?"
    assert "does not exist" in (load_diagnostic(tmp_path / "no" / "x.launch.py").hint or "")
    assert "is a folder" in load_diagnostic(tmp_path).message


def test_unreadable_file_is_reported(write: Write, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write("a.launch.py", "")

    def refuse(*_arguments: object, **_more: object) -> str:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(python_file, "read_text", refuse)  # root, as on some test machines, may read all files
    assert load_diagnostic(path).code == "LAUNCH102"


def test_binary_file_is_rejected(tmp_path: Path) -> None:
    path = tmp_path / "a.launch.py"
    path.write_bytes(b"\xff\xfe\x00")
    assert load_diagnostic(path).code == "LAUNCH102"


def test_syntax_error_is_reported_with_line(write: Write) -> None:
    diagnostic = load_diagnostic(write("a.launch.py", "x = 1\nfor y in (1, 2:\n    pass\n"))
    assert diagnostic.code == "LAUNCH103"
    assert diagnostic.span is not None
    assert diagnostic.span.line == 2
    assert "Traceback" not in diagnostic.message


def test_indentation_error_is_reported_with_line(write: Write) -> None:
    diagnostic = load_diagnostic(write("a.launch.py", "def f():\npass\n"))
    assert diagnostic.code == "LAUNCH103"
    assert diagnostic.span is not None
    assert diagnostic.span.line == 2


def test_exception_points_at_innermost_user_line(write: Write) -> None:
    path = write(
        "a.launch.py",
        "import json\ndef helper(text):\n    return json.loads(text)\n"
        "def generate_launch_description():\n    return helper('{')\n",
    )
    diagnostic = load_diagnostic(path)
    assert diagnostic.code == "LAUNCH104"
    assert "raised JSONDecodeError: Expecting property name" in diagnostic.message
    assert diagnostic.span is not None
    assert (diagnostic.span.file, diagnostic.span.line) == (str(path), 3)
    (note,) = diagnostic.notes
    assert note.span is not None
    assert note.span.line == 5


@pytest.mark.parametrize(
    ("line", "message", "hint"),
    [
        (
            "from launch.actions import DeclareLaunchArgumet",
            "cannot import name 'DeclareLaunchArgumet' from 'launch.actions'",
            "did you mean 'DeclareLaunchArgument'",
        ),
        ("from launch.action import DeclareLaunchArgument", "cannot import name", "import it from 'launch.actions'"),
        (
            "from launch.actions import Node",
            "cannot import name 'Node'",
            "import it from 'launch_ros.actions' or 'rclpy.node'",
        ),
        ("import launch.substitution.x", "No module named 'launch.substitution.x'", None),
        ("import launch.substitutons", "No module named 'launch.substitutons'", "'substitutions'"),
        ("import launch_rso", "No module named 'launch_rso'", "did you mean 'launch_ros' or 'launch'?"),
        ("import numpyyy", "No module named 'numpyyy'", "install the Python package that provides 'numpyyy'"),
        ("import launch; launch.actions.Nod", "has no attribute 'Nod'", None),
        ("import launch; launch.actions.LogInf", "has no attribute 'LogInf'", "did you mean 'LogInfo'"),
        ("LaunchDescripton()", "name 'LaunchDescripton' is not defined", "did you mean 'LaunchDescription'?"),
        (
            "LaunchDescription(initial_entites=[])",
            "unexpected keyword argument 'initial_entites'",
            "did you mean 'initial_entities'?",
        ),
        ("1 / 0", "raised ZeroDivisionError: division by zero", None),
        ("{}['x']", "raised KeyError: x", None),
        ("raise RuntimeError", "raised RuntimeError", None),
    ],
)
def test_exceptions_have_plain_messages_and_hints(write: Write, line: str, message: str, hint: str | None) -> None:
    diagnostic = load_diagnostic(write("a.launch.py", f"{HEAD}{line}\n"))
    assert diagnostic.code == "LAUNCH104"
    assert message in diagnostic.message
    assert "standins" not in diagnostic.message
    if hint:
        assert hint in (diagnostic.hint or "")
    assert diagnostic.span is not None
    assert diagnostic.span.line == 2


NODE = "from launch_ros.actions import Node\n"


def test_misspelled_node_argument_has_hint(write: Write) -> None:
    diagnostic = load_diagnostic(write("a.launch.py", f"{NODE}Node(executable='a', paramters=[])\n"))
    assert diagnostic.hint == "did you mean 'parameters'?"
    diagnostic = load_diagnostic(write("b.launch.py", f"{NODE}Node(exectuable='a')\n"))
    assert diagnostic.hint == "argument 'executable' is missing; the call passes 'exectuable'"


def test_multiline_call_is_located_at_first_line(write: Write) -> None:
    diagnostic = load_diagnostic(
        write("a.launch.py", f"{NODE}n = Node(\n    executable='a',\n    parameters={{'a': 1}},\n)\n")
    )
    assert diagnostic.code == "LAUNCH132"
    assert diagnostic.message == "'parameters' of a node must be a list"
    assert diagnostic.span is not None
    assert diagnostic.span.line == 2
    assert marked_text(diagnostic).startswith(("Node(", "n = Node("))


def test_columns_count_characters(write: Write) -> None:
    diagnostic = load_diagnostic(write("a.launch.py", "x = '机器人'; y = nothing\n"))
    assert diagnostic.span is not None
    assert marked_text(diagnostic) in ("nothing", "x = '机器人'; y = nothing")


def test_missing_package_is_reported(write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)  # the search includes folders below the current one
    diagnostic = load_diagnostic(
        write(
            "a.launch.py",
            "from ament_index_python.packages import get_package_share_path\n"
            "get_package_share_path('my_robot_descriptoin')\n",
        )
    )
    assert diagnostic.code == "PKG101"
    assert diagnostic.span is not None
    assert diagnostic.span.line == 2
    assert diagnostic.hint == "did you mean 'my_robot_description'?"


def test_package_error_can_be_caught_by_ros_name(write: Write) -> None:
    path = write(
        "a.launch.py",
        HEAD + "from ament_index_python.packages import get_package_share_directory, PackageNotFoundError\n"
        "def generate_launch_description():\n"
        "    try:\n        get_package_share_directory('nope_nope')\n"
        "    except PackageNotFoundError:\n        return LaunchDescription()\n",
    )
    assert load_python_launch_file(path).entities == []


@pytest.mark.parametrize(
    ("text", "code", "message"),
    [
        ("def generate_launch_descripton():\n    pass\n", "LAUNCH105", "has no function 'generate_launch_description'"),
        ("def generate_launch_description():\n    pass\n", "LAUNCH106", "returned None, not a LaunchDescription"),
        ("def generate_launch_description():\n    return []\n", "LAUNCH106", "returned a list"),
    ],
)
def test_missing_or_invalid_launch_description_is_rejected(write: Write, text: str, code: str, message: str) -> None:
    diagnostic = load_diagnostic(write("a.launch.py", text))
    assert diagnostic.code == code
    assert message in diagnostic.message


def test_non_action_in_group_is_rejected(write: Write) -> None:
    diagnostic = load_diagnostic(
        write("a.launch.py", "from launch.actions import GroupAction\nGroupAction(['a node'])\n")
    )
    assert "expected launch actions, got 'a node' of type str" in diagnostic.message


@pytest.mark.skipif(sys.platform == "win32", reason="symbolic links need a privilege on Windows")
class TestLinkedShareFolder:
    """A package whose share folder has another layout than its sources.

    The folder contains links to them.
    """

    @pytest.fixture
    def share(self, write: Write, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
        monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
        write("arm/package.xml", "<package format='3'><name>arm</name><version>1.0.0</version></package>")
        write(
            "arm/CMakeLists.txt", "project(arm)\ninstall(DIRECTORY start/ DESTINATION share/${PROJECT_NAME}/launch)\n"
        )
        write("arm/start/sound.launch.py", "def generate_launch_description():\n    raise ValueError(__file__)\n")
        write("arm/start/syntax.launch.py", "def generate_launch_description(\n")
        write("arm/start/tag.launch.xml", "<launch><let name='a'/></launch>")
        write("arm/start/other.launch.py", "")
        return find_share_of_sources("arm", tmp_path / "arm")

    @pytest.mark.parametrize("name", ["sound.launch.py", "syntax.launch.py", "tag.launch.xml"])
    def test_messages_name_source_file_in_workspace(self, share: Path, tmp_path: Path, name: str) -> None:
        assert share != tmp_path / "arm"
        with pytest.raises(LinkwrightError) as caught:
            load_launch_file(share / "launch" / name)
        (diagnostic,) = caught.value.diagnostics
        assert diagnostic.span is not None
        assert diagnostic.span.file == str(tmp_path / "arm" / "start" / name)

    def test_launch_file_sees_its_installed_path(self, share: Path) -> None:
        with pytest.raises(LinkwrightError) as caught:
            load_launch_file(share / "launch" / "sound.launch.py")
        assert str(share / "launch" / "sound.launch.py") in caught.value.diagnostics[0].message

    def test_message_without_line_names_source_file(self, share: Path, tmp_path: Path) -> None:
        with pytest.raises(LinkwrightError) as caught:
            load_launch_file(share / "launch" / "other.launch.py")
        message = caught.value.diagnostics[0].message
        assert str(Path("start", "other.launch.py")) in message
        assert str(tmp_path / "cache") not in message
