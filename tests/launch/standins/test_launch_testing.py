"""Test files for launch_testing, run with the stand-ins only.

They run by ``launch_test`` and by pytest.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from linkwright.launch.standins.launch_testing_api.asserts import SequentialTextChecker
from linkwright.launch.standins.launch_testing_api.text import build_line_match, build_text_match, expect_output
from linkwright.standins import process

HEAD = """\
import sys, unittest
import launch, launch.actions, launch_testing, launch_testing.actions, launch_testing.asserts
import launch_testing.markers, launch_testing.tools, launch_testing.util
import pytest

def python(program, *words, **given):
    return launch.actions.ExecuteProcess(cmd=[sys.executable, '-u', '-c', program, *words], **given)

TALK = "import time; print('first'); print('second'); time.sleep(60)"
END = "import sys; print('done', file=sys.stderr); sys.exit(int(sys.argv[1]))"
"""

TALKER = """
@pytest.mark.launch_test
def generate_test_description():
    talker = python(TALK, name='talker', sigterm_timeout='20')
    listener = launch_testing.actions.ReadyToTest()
    return launch.LaunchDescription([
        launch.actions.DeclareLaunchArgument('speed', default_value='1', description='how fast'),
        talker, launch.actions.TimerAction(period=0.0, actions=[listener])]), {'talker': talker}

class TestBeside(unittest.TestCase):
    @classmethod
    def setUpClass(cls, proc_output):
        cls.given = proc_output

    def test_output(self, proc_output, talker):
        assert self.given is proc_output
        proc_output.assertWaitFor('second', process=talker, stream='stdout', timeout=60)
        launch_testing.asserts.assertInStdout(proc_output, ['first', 'second'], 'talker')
        with launch_testing.asserts.assertSequentialStdout(proc_output, talker) as checker:
            checker.assertInStdout('first')
            checker.assertInStdout('second')
            with self.assertRaises(AssertionError):
                checker.assertInStdout('first')

    def test_states(self, proc_info, talker, test_args):
        proc_info.assertWaitForStartup(talker, timeout=60)
        assert talker.process_details['name'] in proc_info.process_names() and self.proc_info is proc_info
        assert test_args.get('speed', '1') in ('1', '2')

    def test_another_process(self, launch_service, proc_info, proc_output):
        other = python(END, '7', name='other')
        with launch_testing.tools.launch_process(launch_service, other, proc_info, proc_output) as found:
            assert found.wait_for_shutdown(timeout=60) and found.exit_code == 7
        assert found.terminated and found.stderr == 'done\\n' and found.stdout == ''
        with self.assertRaises(launch_testing.util.NoMatchingProcessException):
            launch_testing.asserts.assertInStderr(proc_output, 'done', 'nobody')

@launch_testing.post_shutdown_test()
class TestAfter(unittest.TestCase):
    def test_exit_codes(self, proc_info, talker):
        launch_testing.asserts.assertExitCodes(proc_info, [-2], process=talker)
        launch_testing.asserts.assertExitCodes(proc_info, [7], process='other')
        with self.assertRaises(AssertionError):
            launch_testing.asserts.assertExitCodes(proc_info)
"""

PARAMETRIZED = """
@pytest.mark.launch_test
@launch_testing.parametrize('code', [0, 3])
@launch_testing.markers.keep_alive
def generate_test_description(code):
    return launch.LaunchDescription([python(END, str(code), name='ends'), launch_testing.actions.ReadyToTest()])

class TestCodes(unittest.TestCase):
    def test_code(self, proc_info, code):
        proc_info.assertWaitForShutdown('ends', timeout=60)
        assert proc_info['ends'].returncode == code

    @launch_testing.markers.retry_on_failure(times=3)
    def test_of_one(self, code):
        self.__class__.tries = getattr(self, 'tries', 0) + 1
        assert self.tries == 3 and code == 0, 'only zero'
"""

DIES = """
@pytest.mark.launch_test
def generate_test_description():
    return launch.LaunchDescription([python(END, '5', name='ends'), launch_testing.actions.ReadyToTest()])

class TestTooSlow(unittest.TestCase):
    def test_it(self, proc_info):
        proc_info.assertWaitForStartup('nobody', timeout=600)
"""

SKIPPED = """
@pytest.mark.launch_test
@unittest.skip('not here')
def generate_test_description():
    raise AssertionError

class TestIt(unittest.TestCase):
    def test_it(self):
        raise AssertionError
"""


@pytest.fixture
def run(tmp_path: Path):
    """Run a test file with ``launch_test``, or with pytest if the arguments begin with it."""

    def run_file(text: str, *words: str) -> subprocess.CompletedProcess[str]:
        (tmp_path / "test_it.py").write_text(HEAD + text)
        program = ["-c", "from launch_testing.launch_test import main; main()", "test_it.py", *words]
        environment = {**os.environ, "LINKWRIGHT_DDS": "0", "ROS_LOG_DIR": str(tmp_path / "log")}
        if words[:1] == ("pytest",):
            program = ["-m", "pytest", "-q", "-p", "no:cacheprovider", *words[1:], "test_it.py"]
        if words[:2] != ("pytest", "--launch-args"):  # the plugin of pytest provides the stand-ins
            environment = process.create_environment(environment)
        return subprocess.run(
            [sys.executable, *program], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )

    return run_file


def test_active_and_post_shutdown_tests_run(run) -> None:
    result = run(TALKER, "speed:=2")
    assert result.returncode == 0, result.stderr
    assert re.findall(r"Ran (\d) tests?", result.stderr) == ["3", "1"]


def test_show_args_lists_arguments(run) -> None:
    result = run(TALKER, "--show-args")
    assert (result.returncode, "'speed':" in result.stdout) == (0, True), result.stderr


def test_parametrized_launches_are_in_one_report(run, tmp_path: Path) -> None:
    result = run(PARAMETRIZED, "--junit-xml", "report.xml", "--package-name", "mine")
    assert result.returncode == 1, result.stderr
    report = ET.parse(tmp_path / "report.xml").getroot()
    assert report.attrib | {"time": ""} == {
        "name": "mine.test_it",
        "tests": "4",
        "failures": "1",
        "errors": "0",
        "time": "",
    }
    assert [suite.get("name") for suite in report] == [f"mine.test_it.launch_tests[{code}]" for code in (0, 3)]
    assert [case.get("name") for case in report[1]] == ["test_code[3]", "test_of_one[3]"]
    (failure,) = report.iter("failure")
    assert "only zero" in failure.get("message", "")


def test_launch_that_ends_early_fails_its_tests(run) -> None:
    result = run(DIES)
    assert result.returncode == 1
    assert "Processes under test stopped before tests completed" in result.stdout
    assert re.search(r"Process 'ends-1' exited with 5\n#+ 'ends-1' output #+\ndone\n", result.stdout)


def test_skipped_launch_skips_its_tests(run) -> None:
    result = run(SKIPPED)
    assert (result.returncode, "is skipped: not here" in result.stdout) == (0, True), result.stderr


@pytest.mark.parametrize(
    ("text", "words", "outcome"),
    [
        (TALKER, ("--launch-args", "speed:=2", "--"), "1 passed"),
        (PARAMETRIZED, (), "1 failed"),
        ("\ndef test_plain():\n    pass\n\ndef generate_test_description():\n    pass\n", (), "1 passed"),
    ],
)
def test_marked_file_is_one_pytest_test(run, text: str, words: tuple[str, ...], outcome: str) -> None:
    result = run(text, "pytest", *words)
    assert outcome in result.stdout, result.stdout + result.stderr
    assert ("only zero" in result.stdout) is ("failed" in outcome)


@pytest.mark.parametrize(
    ("text", "words", "message"),
    [
        ("", (), "has no function generate_test_description"),
        (TALKER, ("fast",), "malformed launch argument 'fast'"),
        ("def generate_test_description(speed):\n    pass\n", (), "has unexpected extra argument 'speed'"),
    ],
)
def test_invalid_file_and_arguments_are_reported(run, text: str, words: tuple[str, ...], message: str) -> None:
    result = run(text, *words)
    assert (result.returncode, message in result.stderr) == (2, True), result.stderr
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize(
    ("expected", "is_strict", "found"),
    [
        ("b", False, (1, 2)),
        ("b", True, None),
        ("abc", True, (0, 3)),
        (re.compile("[bc]+"), False, (1, 3)),
        (["a", "c"], False, (0, 3)),
        (["a", "c"], True, None),
        (["a", "b"], True, (0, 2)),
        (["b", "a"], False, None),
    ],
)
def test_texts_are_matched_in_order(expected, is_strict, found) -> None:
    assert build_text_match(expected, strict=is_strict)("abc") == found


def test_lines_are_matched_in_order() -> None:
    lines = ["one", "two", "three"]
    assert build_line_match(["ne", re.compile("th")])(lines) == (0, 3)
    assert build_line_match(["one", "three"], strict=True)(lines) is None
    assert expect_output("\033[31mone\033[0m\r\ntwo", expected_text="one\ntwo", strict=True)
    with pytest.raises(ValueError, match="not both"):
        expect_output("a", lines=["a"], expected_text="a")


def test_missing_text_is_reported_with_nearby_lines() -> None:
    checker = SequentialTextChecker([f"line {number}\n" for number in range(9)])
    checker.assertInText("line 4")
    with pytest.raises(AssertionError) as caught:
        checker.assertInText("line 2")
    assert str(caught.value).endswith("line 2\nline 3\nline 4\nline 5\nline 6\nline 7")
