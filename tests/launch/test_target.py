"""The launch file that the words of a command line name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration

from launch import LaunchDescription
from linkwright.diagnostics import LinkwrightError, Severity
from linkwright.launch import LaunchTarget, parse_launch_words, show_arguments
from linkwright.launch.arguments import check_arguments, format_arguments, parse_arguments
from linkwright.packages import PackageFinder

Write = Callable[[str, str], Path]


@pytest.fixture
def package(write: Write, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    write("src/arm/package.xml", "<package><name>arm</name></package>")
    write("src/arm/launch/display.launch.py", "")
    write("src/arm/launch/sub/deep.launch.py", "")
    write("src/arm/other_launch.py", "")
    write("src/arm/launch/twice.launch.py", "")
    write("src/arm/old/twice.launch.py", "")
    monkeypatch.chdir(tmp_path)
    return tmp_path / "src" / "arm"


@pytest.mark.parametrize(
    ("name", "path"),
    [
        ("display.launch.py", "launch/display.launch.py"),
        ("launch/display.launch.py", "launch/display.launch.py"),
        ("deep.launch.py", "launch/sub/deep.launch.py"),
        ("other_launch.py", "other_launch.py"),
    ],
)
def test_launch_file_of_package_is_found(package: Path, name: str, path: str) -> None:
    assert LaunchTarget(name, "arm").resolve(PackageFinder()) == package / path


def test_missing_launch_file_of_package_has_hint(package: Path) -> None:
    with pytest.raises(LinkwrightError, match=r"package 'arm' has no launch file 'dsplay\.launch\.py'") as caught:
        LaunchTarget("dsplay.launch.py", "arm").resolve(PackageFinder())
    assert "did you mean 'display.launch.py'" in (caught.value.diagnostics[0].hint or "")
    with pytest.raises(LinkwrightError) as caught:
        LaunchTarget("zzz", "arm").resolve(PackageFinder())
    assert "the package has display.launch.py" in (caught.value.diagnostics[0].hint or "")


def test_ambiguous_launch_file_name_is_rejected(package: Path) -> None:
    package.joinpath("launch", "twice.launch.py").rename(package / "launch" / "sub" / "twice.launch.py")
    with pytest.raises(LinkwrightError, match=r"has several launch files 'twice\.launch\.py'") as caught:
        LaunchTarget("twice.launch.py", "arm").resolve(PackageFinder())
    assert "launch/sub/twice.launch.py, old/twice.launch.py" in (caught.value.diagnostics[0].hint or "")


def test_path_determines_package(package: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    other_folder = tmp_path / "elsewhere"
    other_folder.mkdir()
    monkeypatch.chdir(other_folder)
    target = LaunchTarget(str(package / "launch" / "display.launch.py"))
    assert target.create_finder().share("arm") == package


class TestWords:
    def test_package_and_file_are_parsed(self) -> None:
        target, arguments = parse_launch_words(["arm", "display.launch.py", "a:=1", "b:=x:=y", "a:="])
        assert target == LaunchTarget("display.launch.py", "arm")
        assert arguments == {"a": "", "b": "x:=y"}

    def test_path_is_parsed(self, package: Path) -> None:
        path = str(package / "launch" / "display.launch.py")
        assert parse_launch_words([path, "a:=1"]) == (LaunchTarget(path), {"a": "1"})

    def test_malformed_argument_after_path_has_hint(self, package: Path) -> None:
        path = str(package / "launch" / "display.launch.py")
        with pytest.raises(LinkwrightError, match="launch argument 'gui=true' is malformed") as caught:
            parse_launch_words([path, "gui=true"])
        assert caught.value.diagnostics[0].hint == "write gui:=true"

    def test_missing_launch_file_is_reported(self) -> None:
        with pytest.raises(LinkwrightError, match="no launch file is given"):
            parse_launch_words([])

    def test_package_without_launch_file_has_hint(self, package: Path) -> None:
        with pytest.raises(LinkwrightError, match="'arm' is a package: add the name of a launch file in it") as caught:
            parse_launch_words(["arm"])
        assert "display.launch.py" in (caught.value.diagnostics[0].hint or "")

    def test_malformed_arguments_are_all_reported(self) -> None:
        with pytest.raises(LinkwrightError) as caught:
            parse_arguments(["a=1", "good:=1", "--gui", "b: 2", ":=x"])
        messages = [diagnostic.message for diagnostic in caught.value.diagnostics]
        assert messages == [f"launch argument '{word}' is malformed" for word in ("a=1", "--gui", "b: 2", ":=x")]
        assert {diagnostic.code for diagnostic in caught.value.diagnostics} == {"LAUNCH111"}


class TestChecks:
    def description(self) -> LaunchDescription:
        return LaunchDescription(
            [
                DeclareLaunchArgument("gui", default_value="true", choices=["true", "false"]),
                DeclareLaunchArgument("model"),
                DeclareLaunchArgument("speed", default_value=LaunchConfiguration("model")),
                GroupAction([DeclareLaunchArgument("behind")], condition=IfCondition("false")),
            ]
        )

    def test_argument_errors_are_all_reported(self) -> None:
        with pytest.raises(LinkwrightError) as caught:
            check_arguments(self.description(), {"gui": "yes"})
        codes = [diagnostic.code for diagnostic in caught.value.diagnostics]
        assert codes == ["LAUNCH112", "LAUNCH114"]
        assert all(diagnostic.span and diagnostic.span.file == __file__ for diagnostic in caught.value.diagnostics)

    def test_undeclared_arguments_are_reported(self) -> None:
        warnings = check_arguments(self.description(), {"model": "m", "modl": "n", "launch-prefix": "gdb"})
        (warning,) = warnings
        assert warning.severity is Severity.WARNING
        assert warning.message == "argument 'modl' is not declared by the launch file"
        assert warning.hint == "did you mean 'model'?"

    def test_misspelled_required_argument_has_hint(self) -> None:
        with pytest.raises(LinkwrightError) as caught:
            check_arguments(self.description(), {"modl": "m", "launch-prefix": "gdb"})
        (error,) = caught.value.diagnostics
        assert error.code == "LAUNCH114"
        assert error.hint == "did you mean 'model' instead of 'modl'?"
        with pytest.raises(LinkwrightError) as caught:
            check_arguments(self.description(), {"unlike": "m"})
        assert caught.value.diagnostics[0].hint == "add model:=VALUE"

    def test_arguments_are_listed(self) -> None:
        assert format_arguments(self.description()) == (
            "Arguments (pass arguments as '<name>:=<value>'):\n"
            "\n"
            "    'gui':\n"
            "        One of: ['true', 'false']\n"
            "        (default: 'true')\n"
            "\n"
            "    'model':\n"
            "        no description given\n"
            "\n"
            "    'speed':\n"
            "        no description given\n"
            "        (default: LaunchConfig('model'))\n"
            "\n"
            "    'behind':*\n"
            "        no description given\n"
            "\n"
            "* argument(s) which are only used if specific conditions occur"
        )

    def test_description_without_arguments_is_listed(self) -> None:
        assert format_arguments(LaunchDescription()).endswith("\n\n  No arguments.")


def test_show_arguments_lists_shipped_launch_file() -> None:
    listing = show_arguments(LaunchTarget("display.launch.py", "my_robot_description"))
    assert "    'gui':\n        " in listing
    assert "'rvizconfig'" in listing
