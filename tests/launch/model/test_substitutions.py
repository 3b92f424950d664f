"""Substitutions of launch: their values, and the errors that they report."""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path

import pytest
from launch.substitution import Substitution
from launch.substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnonName,
    AnySubstitution,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FileContent,
    FindExecutable,
    IfElseSubstitution,
    LaunchConfiguration,
    LocalSubstitution,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    PathJoinSubstitution,
    PythonExpression,
    SubstitutionFailure,
    TextSubstitution,
    ThisLaunchFile,
    ThisLaunchFileDir,
)
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch_ros.substitutions import ExecutableInPackage, FindPackagePrefix, FindPackageShare

from launch import LaunchContext
from linkwright.diagnostics import LinkwrightError
from linkwright.packages import PackageFinder, use_finder


@pytest.fixture
def context() -> LaunchContext:
    context = LaunchContext()
    context.launch_configurations.update(model="arm", gui="true", count="2")
    return context


def perform_text(substitution: Substitution, context: LaunchContext) -> str:
    return context.perform_substitution(substitution)


def test_texts_and_substitutions_are_joined(context: LaunchContext) -> None:
    parts = ["xacro ", LaunchConfiguration("model"), TextSubstitution(text=".urdf"), Path("/x")]
    assert perform_substitutions(context, normalize_to_list_of_substitutions(parts)) == "xacro arm.urdf/x"


@pytest.mark.parametrize("invalid_value", [3, None, [3], b"x"])
def test_non_text_values_are_rejected(invalid_value: object) -> None:
    with pytest.raises(TypeError, match="expected a text"):
        normalize_to_list_of_substitutions(invalid_value)


def test_launch_configuration_returns_value_or_default(context: LaunchContext) -> None:
    assert perform_text(LaunchConfiguration("model"), context) == "arm"
    assert perform_text(LaunchConfiguration(["mo", "del"]), context) == "arm"
    assert perform_text(LaunchConfiguration("none", default="d"), context) == "d"
    assert perform_text(LaunchConfiguration("none", default=["d", LaunchConfiguration("count")]), context) == "d2"
    assert perform_text(LaunchConfiguration("none", default=5), context) == "5"


def test_unset_launch_configuration_suggests_name_and_line(context: LaunchContext) -> None:
    with pytest.raises(LinkwrightError, match="launch configuration 'modle' is not set") as caught:
        perform_text(LaunchConfiguration("modle"), context)
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "LAUNCH121"
    assert diagnostic.hint == "did you mean 'model'?"
    assert diagnostic.span is not None
    assert diagnostic.span.file == __file__
    assert diagnostic.source is not None
    assert 'LaunchConfiguration("modle")' in diagnostic.source.line(diagnostic.span.line)


def test_environment_variable_returns_value_or_default(context: LaunchContext, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MBOT_COLOR", "here")
    assert perform_text(EnvironmentVariable("MBOT_COLOR"), context) == "here"
    assert perform_text(EnvironmentVariable("LINKWRIGHT_NONE", default_value="d"), context) == "d"
    with pytest.raises(LinkwrightError, match="environment variable 'MBOT_COLUOR' is not set") as caught:
        perform_text(EnvironmentVariable("MBOT_COLUOR"), context)
    assert caught.value.diagnostics[0].hint == "did you mean 'MBOT_COLOR'?"


def test_local_substitution_evaluates_attributes(context: LaunchContext) -> None:
    context.extend_locals({"event": ValueError("x")})
    assert perform_text(LocalSubstitution("event.args"), context) == "('x',)"
    for expression in ("evnt", "event.argz"):
        with pytest.raises(LinkwrightError):
            perform_text(LocalSubstitution(expression), context)


def test_this_launch_file_returns_path_and_folder(context: LaunchContext) -> None:
    with pytest.raises(LinkwrightError, match="the launch description was not read from a file"):
        perform_text(ThisLaunchFile(), context)
    context.extend_locals({"current_launch_file_path": "/a/b.launch.py"})
    assert perform_text(ThisLaunchFile(), context) == "/a/b.launch.py"
    assert perform_text(ThisLaunchFileDir(), context) == "/a"


def test_path_join_joins_parts(context: LaunchContext) -> None:
    joined = PathJoinSubstitution(["/a", ["b_", LaunchConfiguration("model")], "c"])
    assert perform_text(joined, context) == "/a/b_arm/c"
    assert perform_text(joined / "d", context) == "/a/b_arm/c/d"


def test_find_executable_returns_path_on_path_variable(context: LaunchContext) -> None:
    assert os.access(perform_text(FindExecutable(name="sh"), context), os.X_OK)
    with pytest.raises(LinkwrightError, match="program 'no-such-program' is not on PATH"):
        perform_text(FindExecutable(name="no-such-program"), context)


@pytest.mark.parametrize("program", ["xacro", "gz", "ign", "gazebo", "gzserver"])
def test_builtin_programs_are_found_if_not_installed(
    context: LaunchContext, monkeypatch: pytest.MonkeyPatch, program: str
) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    assert perform_text(FindExecutable(name=program), context) == program


def test_file_content_returns_text(context: LaunchContext, tmp_path: Path) -> None:
    (tmp_path / "x").write_text("inside")
    assert perform_text(FileContent(str(tmp_path / "x")), context) == "inside"
    with pytest.raises(LinkwrightError, match="does not exist"):
        perform_text(FileContent(str(tmp_path / "y")), context)


@pytest.mark.parametrize(
    ("expression", "value"),
    [
        (["'", LaunchConfiguration("gui"), "' == 'true'"], "True"),
        (["2 * ", LaunchConfiguration("count")], "4"),
        (["cos(0) + math.sin(0)"], "1.0"),
    ],
)
def test_python_expression_is_evaluated(context: LaunchContext, expression: list[object], value: str) -> None:
    assert perform_text(PythonExpression(expression), context) == value


def test_python_expression_uses_given_module(context: LaunchContext) -> None:
    assert perform_text(PythonExpression(["os.sep"], ["os"]), context) == os.sep


def test_unquoted_python_expression_suggests_quotes(context: LaunchContext) -> None:
    with pytest.raises(LinkwrightError, match="NameError") as caught:
        perform_text(PythonExpression([LaunchConfiguration("model"), " == 'arm'"]), context)
    assert "put quotes around" in (caught.value.diagnostics[0].hint or "")


@pytest.mark.parametrize(
    ("substitution", "value"),
    [
        (NotSubstitution("true"), "false"),
        (NotSubstitution(LaunchConfiguration("gui")), "false"),
        (AndSubstitution("true", "1"), "true"),
        (AndSubstitution("true", "False"), "false"),
        (OrSubstitution("0", "True"), "true"),
        (OrSubstitution("0", "false"), "false"),
        (AnySubstitution("false", "false", "true"), "true"),
        (AllSubstitution("true", "false"), "false"),
        (AllSubstitution("true", "1"), "true"),
        (EqualsSubstitution("a", "a"), "true"),
        (EqualsSubstitution("a", "b"), "false"),
        (EqualsSubstitution("true", "1"), "true"),
        (EqualsSubstitution("1.0", "1"), "true"),
        (EqualsSubstitution(LaunchConfiguration("count"), 2), "true"),
        (EqualsSubstitution(None, ""), "true"),
        (NotEqualsSubstitution("a", "b"), "true"),
        (NotEqualsSubstitution("true", "True"), "false"),
        (IfElseSubstitution(LaunchConfiguration("gui"), "yes", "no"), "yes"),
        (IfElseSubstitution("false", if_value="yes"), ""),
    ],
)
def test_logic_substitutions_return_true_or_false(
    context: LaunchContext, substitution: Substitution, value: str
) -> None:
    assert perform_text(substitution, context) == value


def test_logic_substitutions_reject_other_values(context: LaunchContext) -> None:
    with pytest.raises(LinkwrightError, match="NotSubstitution needs 'true' or 'false', not 'arm'"):
        perform_text(NotSubstitution(LaunchConfiguration("model")), context)


def test_package_substitutions_find_share_prefix_and_executable(context: LaunchContext, tmp_path: Path) -> None:
    share = tmp_path / "ros" / "share" / "arm"
    share.mkdir(parents=True)
    (share / "package.xml").write_text("<package><name>arm</name></package>")
    program = tmp_path / "ros" / "lib" / "arm" / "move"
    program.parent.mkdir(parents=True)
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    finder = PackageFinder(start=tmp_path, environment={"AMENT_PREFIX_PATH": str(tmp_path / "ros")})
    with use_finder(finder):
        assert perform_text(FindPackageShare("arm"), context) == str(share)
        assert perform_text(FindPackageShare(LaunchConfiguration("model")) / "urdf", context) == str(share / "urdf")
        assert perform_text(FindPackagePrefix("arm"), context) == str(tmp_path / "ros")
        assert perform_text(ExecutableInPackage("move", "arm"), context) == str(program)
        with pytest.raises(LinkwrightError, match="package 'armm' not found") as caught:
            perform_text(FindPackageShare("armm"), context)
        assert caught.value.diagnostics[0].span is not None
        with pytest.raises(LinkwrightError, match="package 'arm' has no executable 'moev'") as caught:
            perform_text(ExecutableInPackage("moev", "arm"), context)
        assert caught.value.diagnostics[0].hint == "did you mean 'move'?"


@pytest.mark.parametrize(
    ("substitution", "description"),
    [
        (TextSubstitution(text="a"), "'a'"),
        (LaunchConfiguration("x"), "LaunchConfig('x')"),
        (EnvironmentVariable("HOME"), "EnvVar('HOME')"),
        (PathJoinSubstitution(["a", "b"]), "PathJoin('a', 'b')"),
        (Command(["xacro ", LaunchConfiguration("m")]), "Command('xacro ' + LaunchConfig('m'))"),
        (FindPackageShare("arm"), "FindPackageShare(pkg='arm')"),
        (ThisLaunchFileDir(), "ThisLaunchFileDir()"),
    ],
)
def test_substitutions_describe_themselves(substitution: Substitution, description: str) -> None:
    assert substitution.describe() == description


def test_custom_substitution_is_performed_and_can_fail(context: LaunchContext) -> None:
    class Upper(Substitution):
        def __init__(self, inner_substitution: str) -> None:
            self.inner = inner_substitution  # many classes do not call the base class's constructor

        def perform(self, context: LaunchContext) -> str:
            if not self.inner:
                raise SubstitutionFailure("nothing to raise")
            return self.inner.upper()

    assert perform_text(Upper("a"), context) == "A"
    with pytest.raises(LinkwrightError, match="nothing to raise") as caught:
        perform_text(Upper(""), context)
    assert caught.value.diagnostics[0].span is not None


class TestCommand:
    def python(self, program: str) -> list[str]:
        return [sys.executable, ' -c "', program, '"']

    def test_command_returns_stdout(self, context: LaunchContext) -> None:
        assert perform_text(Command(["echo ", LaunchConfiguration("model")]), context) == "arm\n"

    def test_failing_command_is_reported_with_stderr(self, context: LaunchContext) -> None:
        with pytest.raises(LinkwrightError, match="failed with exit status 3:\nwhy") as caught:
            perform_text(Command(self.python("import sys; print('why', file=sys.stderr); sys.exit(3)")), context)
        assert caught.value.diagnostics[0].code == "LAUNCH129"

    def test_on_stderr_option_controls_stderr(self, context: LaunchContext, capsys: pytest.CaptureFixture[str]) -> None:
        words = self.python("import sys; print('out'); print('err', file=sys.stderr)")
        with pytest.raises(LinkwrightError, match="wrote to stderr:\nerr"):
            perform_text(Command(words), context)
        assert perform_text(Command(words, on_stderr="ignore"), context) == "out\n"
        assert perform_text(Command(words, on_stderr="capture"), context) == "out\nerr\n"
        capsys.readouterr()
        assert perform_text(Command(words, on_stderr="warn"), context) == "out\n"
        assert "wrote to stderr" in capsys.readouterr().err
        with pytest.raises(LinkwrightError, match="'on_stderr' is 'panic'"):
            perform_text(Command(words, on_stderr="panic"), context)

    @pytest.mark.parametrize(
        ("command", "message"),
        [
            ("no-such-program x", "program 'no-such-program' does not start: No such file or directory"),
            ("echo 'open", "cannot be split"),
            ("  ", "is empty"),
            ("xacro", "the xacro command has no model file"),
            ("xacro --deps a.xacro", "option '--deps' of xacro"),
            ("xacro a.xacro b.xacro", "expects exactly one model file, but was given 2"),
        ],
    )
    def test_invalid_commands_are_rejected(self, context: LaunchContext, command: str, message: str) -> None:
        with pytest.raises(LinkwrightError, match=message) as caught:
            perform_text(Command(command), context)
        assert caught.value.diagnostics[0].span is not None

    @pytest.mark.parametrize("program", ["xacro", "/opt/ros/bin/xacro", "ros2 run xacro xacro"])
    def test_xacro_command_runs_in_process(self, context: LaunchContext, tmp_path: Path, program: str) -> None:
        model = tmp_path / "a.xacro"
        model.write_text(
            '<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro">'
            '<xacro:arg name="link" default="x"/><link name="$(arg link)"/></robot>'
        )
        expanded = perform_text(Command([program, " --inorder ", str(model), " link:='two words'"]), context)
        assert '<link name="two words"/>' in expanded

    def test_unquoted_path_with_spaces_is_accepted_with_warning(
        self, context: LaunchContext, tmp_path: Path, capsys: pytest.CaptureFixture[str]
    ) -> None:
        model = tmp_path / "my robot" / "a.urdf"
        model.parent.mkdir()
        model.write_text('<robot name="a"><link name="x"/></robot>')
        assert '<link name="x"/>' in perform_text(Command(["xacro ", str(model)]), context)
        assert '<link name="x"/>' in perform_text(Command(["xacro ", str(model), " a:=b"]), context)
        assert "contains spaces but is not quoted" in capsys.readouterr().err
        assert '<link name="x"/>' in perform_text(Command(['xacro "', str(model), '"']), context)
        assert capsys.readouterr().err == ""


def test_anon_name_contains_host_pid_and_number(context: LaunchContext, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("socket.gethostname", lambda: "my-lab.local")
    name = AnonName("robot:1").perform(context)
    assert re.fullmatch(rf"robot_1_my_lab_local_{os.getpid()}_\d+", name)
    assert AnonName("robot:1").perform(context) == name
