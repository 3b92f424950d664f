"""The contents of Python, CMake and xacro files, read without running them."""

from __future__ import annotations

import ast

import pytest

from linkwright.diagnostics import SourceText
from linkwright.lint.xacro_names import is_constant, mentions
from linkwright.packages.readers.cmake import read_cmake
from linkwright.packages.readers.launch_files import read_launch_file
from linkwright.packages.readers.python_values import UNKNOWN, Pattern, PythonFile, SharePath
from linkwright.packages.readers.setup_py import read_setup
from tests.work import lines_run

_PREFACE = """
import os
from glob import glob
package = 'robot'
twice = 'a'
twice = 'b'
share = get_package_share_directory('robot')
def function(given): pass
"""


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        ("'share/' + package", "share/robot"),
        ("f'share/{package}/urdf'", "share/robot/urdf"),
        ("'%s/urdf' % package", "robot/urdf"),
        ("os.path.join('share', package, 'urdf')", "share/robot/urdf"),
        ("Path('share') / package / 'urdf'", "share/robot/urdf"),
        ("glob('urdf/*')", Pattern("urdf/*", recursive=False)),
        ("glob(os.path.join('urdf', '**'), recursive=True)", Pattern("urdf/**", recursive=True)),
        ("os.path.join(share, 'urdf/robot.urdf')", SharePath("robot", "/urdf/robot.urdf")),
        ("share + '/urdf/robot.urdf'", SharePath("robot", "/urdf/robot.urdf")),
        ("PathJoinSubstitution([FindPackageShare('a'), 'b', 'c'])", SharePath("a", "/b/c")),
        ("FindPackageShare(package='a').find('a')", SharePath("a")),
        ("['a', package]", ("a", "robot")),
        ("twice", UNKNOWN),
        ("given", UNKNOWN),
        ("os.path.join('a', '/b')", UNKNOWN),
        ("[x for x in y]", UNKNOWN),
        ("'%d' % package", UNKNOWN),
        ("f'{package!r}'", UNKNOWN),
        ("f(*a)", UNKNOWN),
    ],
)
def test_python_expressions_are_evaluated(expression, value):
    python = PythonFile(SourceText("x.py", f"{_PREFACE}result = {expression}\n"))
    result = python.assigned_expression("result")
    assert result is not None
    assert python.value(result) == value


def test_circular_assignment_has_unknown_value():
    python = PythonFile(SourceText("x.py", "a = b\nb = a\n"))
    assert python.value(ast.Name("a")) is UNKNOWN


def test_span_columns_count_characters():
    source = SourceText("x.py", "x = ['ä', 'ö', Node('é')]\n")
    python = PythonFile(source)
    span = python.span(next(python.calls("Node")))
    assert (span.column, span.end_column) == (16, 25)


def test_cmake_comments_strings_and_variables_are_parsed():
    text = """
    project(robot)  # project(other)
    #[[ install(DIRECTORY no DESTINATION x) ]]
    set(FOLDERS urdf)
    set(TWO a b)
    install(DIRECTORY ${FOLDERS} "mesh files" ${CMAKE_CURRENT_SOURCE_DIR}/rviz/ DESTINATION share/${PROJECT_NAME})
    install(PROGRAMS scripts/run.py DESTINATION lib/${PROJECT_NAME})
    add_executable(driver src/driver.cpp)
    ament_auto_package(INSTALL_TO_SHARE launch)
    """
    file = read_cmake(SourceText("CMakeLists.txt", text))
    assert file.project is not None
    assert file.project.text == "robot"
    assert [directory.text for directory in file.directories] == ["urdf", "mesh files", "rviz/", "launch"]
    assert [argument.text for argument in file.files] == ["scripts/run.py"]
    assert file.executables == {"driver", "run.py"}
    assert file.is_complete
    assert file.is_ament
    assert file.span(file.directories[1]).column == text.splitlines()[5].index("mesh files") + 1


@pytest.mark.parametrize(
    "text",
    [
        "install(DIRECTORY ${UNKNOWN} DESTINATION x)",
        "foreach(a ${b})\nendforeach()",
        "while(a)\nendwhile()",
        "include(other.cmake)",
        'install(CODE "x")',
    ],
)
def test_unsupported_cmake_code_is_incomplete(text):
    assert not read_cmake(SourceText("CMakeLists.txt", text)).is_complete


@pytest.mark.parametrize("text", ["", "(((", "install(", '"', "#[[", "install()", "project()", "set(A)", "\\"])
def test_cmake_reader_never_raises(text):
    read_cmake(SourceText("CMakeLists.txt", text))


@pytest.mark.parametrize(
    ("data_files", "is_complete"),
    [
        ("[('share/a', ['b'])]", True),
        ("[('share/a', glob('b') + ['c', 'd' + '/e'])]", True),
        ("[('share/a', ['b'])] + [('share/c', ['d'])]", True),
        ("[*other()]", False),
        ("other()", False),
        ("[('share/a', other())]", False),
        ("[('share/a', [x for x in y])]", False),
        ("unknown", False),
    ],
)
def test_setup_is_complete_only_if_data_files_are_known(data_files, is_complete):
    setup = read_setup(SourceText("setup.py", f"setup(name='a', data_files={data_files})"))
    assert setup.has_call
    assert setup.is_complete is is_complete


@pytest.mark.parametrize(
    "text", ["", "setup()", "setup(**a)", "setup(data_files=3)", "x = 1", "setup(entry_points=a)", "\0", "("]
)
def test_setup_reader_never_raises(text):
    read_setup(SourceText("setup.py", text))


def test_parts_of_longer_paths_are_not_files():
    text = """
share = os.path.join(get_package_share_directory('a'), 'urdf.d')
model = os.path.join(share, 'robot.urdf')
"""
    facts = read_launch_file(SourceText("x.launch.py", text), "x.launch.py")
    assert [(path.package, path.path) for path in facts.paths] == [("a", "urdf.d/robot.urdf")]


@pytest.mark.parametrize("text", ["", "Node()", "Node(package=1)", "Command()", "FindPackageShare()", "\0", "def"])
def test_launch_reader_never_raises(text):
    read_launch_file(SourceText("x.launch.py", text), "x.launch.py")


def test_mentions_of_text_are_found():
    names = mentions("${a + xacro.arg('b')}/$(find c)/$(arg d)${[x for x in e.f]}$${g}")
    assert {"a", "e", "f"} <= names.names
    assert "g" not in names.names
    assert names.arguments == {"b", "d"}
    assert names.packages == (("c", 29),)
    assert not names.is_open
    assert not names.has_open_arguments


@pytest.mark.parametrize("text", ["${$(arg a)_radius}", "${a$(arg b)}", "${$(env X)}"])
def test_computed_names_are_open(text):
    assert mentions(text).is_open


@pytest.mark.parametrize("text", ["${'$(arg a)' == 'b'}", "${$(arg a) + 1}", "${a} $(arg b)"])
def test_strings_and_whole_expressions_are_not_open(text):
    assert not mentions(text).is_open


@pytest.mark.parametrize("text", ["$(arg ${a})", "${xacro.arg(a)}"])
def test_computed_arguments_are_open(text):
    assert mentions(text).has_open_arguments


@pytest.mark.parametrize("text", ["${", "$$", "${}", "${(}", "$(", "$()", "$(arg)", "$(find)", "${'\\u'}", "${1 if}"])
def test_mentions_accepts_malformed_text(text):
    mentions(text)


def test_constant_expressions_are_recognized():
    assert is_constant("true")
    assert is_constant("${1 == 1}")
    assert not is_constant("${a}")
    assert not is_constant("$(arg a)")
    assert not is_constant("$(optenv A 1)")


def test_bare_calls_have_offsets():
    (call,) = mentions("x ${ sorted([2, 1])} ${[range(3) for range in a]}").bare_calls
    assert (call.name, call.offset) == ("sorted", 5)


def test_python_syntax_warnings_are_suppressed():
    assert read_launch_file(SourceText("x.launch.py", "a = '\\d'"), "x.launch.py").error is None


@pytest.mark.parametrize(
    "text",
    [
        "a = b + []\nb = a + []\nsetup(data_files=a)",
        f"setup(data_files={' + '.join(['[]'] * 3000)})",
        f"setup(name={'(' * 150}1{')' * 150})",
        f"setup(name={'-' * 50_000}1)",
    ],
)
def test_readers_survive_circular_and_deep_lists(text):
    read_setup(SourceText("setup.py", text))
    read_launch_file(SourceText("x.launch.py", text), "x.launch.py")


def test_launch_reader_effort_is_linear_in_sum_length():
    def work(terms):
        text = f"a = {' + '.join(['b'] * terms)}"
        return lines_run(lambda: read_launch_file(SourceText("x.launch.py", text), "x.launch.py"))

    work(100)
    assert work(300) < 4.5 * work(100)
