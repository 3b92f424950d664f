"""Tests as processes of a launch (``launch_testing.legacy``)."""

from __future__ import annotations

import re
import sys
from typing import Any

import pytest
from launch.actions import ExecuteProcess, OpaqueFunction
from launch_testing.legacy import LaunchTestService, output

from launch import LaunchDescription, LaunchService


def execute_python(program: str) -> Any:
    return ExecuteProcess(cmd=[sys.executable, "-u", "-c", program])


LASTS = "import time; time.sleep(600)"


class LaunchWithTests:
    """A launch description with its tests."""

    def __init__(self) -> None:
        self.description, self.service = LaunchDescription(), LaunchTestService()

    def run(self) -> int:
        launch = LaunchService(noninteractive=True)
        launch.include_launch_description(self.description)
        return self.service.run(launch)


@pytest.fixture
def tests() -> LaunchWithTests:
    return LaunchWithTests()


def test_launch_returns_0_if_all_tests_pass(tests) -> None:
    tests.service.add_fixture_action(tests.description, execute_python(LASTS))
    tests.service.add_test_action(tests.description, execute_python("pass"))
    tests.service.add_test_action(tests.description, OpaqueFunction(function=lambda _: None))
    assert tests.run() == 0


def test_launch_returns_status_of_failed_test(tests) -> None:
    tests.service.add_test_action(tests.description, execute_python(LASTS))
    tests.service.add_test_action(tests.description, execute_python("raise SystemExit(7)"))
    assert tests.run() == 7


def test_ended_fixture_fails_launch(tests) -> None:
    tests.service.add_test_action(tests.description, execute_python(LASTS))
    tests.service.add_fixture_action(tests.description, execute_python("pass"), exit_allowed=[3])
    assert tests.run() == 1


@pytest.mark.parametrize(("expected", "status"), [(b"second", 0), (b"third", 1)])
def test_process_output_is_compared_with_expected_lines(tests, expected, status) -> None:
    talker = execute_python("print('pid 7'); print('the first'); print('the second')")
    tests.description.add_action(talker)
    expected_lines = output.create_output_lines_test([b"first", expected])
    tests.service.add_output_test(tests.description, talker, expected_lines)
    assert tests.run() == status


def test_output_filters_and_expected_files_are_read(tmp_path) -> None:
    assert output.create_output_lines_filter()(b"pid 7\nthe first\n") == b"the first\n"
    (tmp_path / "lines.txt").write_bytes(b"first\n")
    (tmp_path / "patterns.regex").write_bytes(b"f.rst\n")
    for name, expected_lines in ("lines", [b"first"]), ("patterns", [re.compile(b"f.rst")]):
        _, _, matches, patterns = output.create_output_test_from_file(str(tmp_path / name))
        assert list(patterns) == expected_lines
        assert matches(b"the first\n", patterns[0])
    with pytest.raises(RuntimeError, match="could not find"):
        output.create_output_test_from_file(str(tmp_path / "none"))
