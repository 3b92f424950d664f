"""Test files for launch_pytest, run by pytest with the stand-ins only."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import textwrap

import pytest

from linkwright.standins import process

HEAD = """\
import asyncio
import sys
import launch
import launch_pytest
import pytest
from launch_pytest import tools
from launch_pytest.tools import process as process_tools

def python(program):
    return launch.actions.ExecuteProcess(cmd=[sys.executable, '-c', program], cached_output=True)

HELLO = "import sys; print('hello_world', flush=True); print('oh', file=sys.stderr)"
WAIT = "import time; print('up', flush=True); time.sleep(60)"
"""

FUNCTION_SCOPE = """
@pytest.fixture
def hello():
    return python(HELLO)

@launch_pytest.fixture(auto_shutdown=False)
def description(hello):
    return launch.LaunchDescription([hello, launch_pytest.actions.ReadyToTest()])

@pytest.mark.launch(fixture=description)
def test_generator(hello, launch_context):
    def validate_output(output):
        assert output.splitlines() == ['hello_world']
    process_tools.assert_output_sync(launch_context, hello, validate_output, timeout=60)
    assert not process_tools.wait_for_output_sync(launch_context, hello, lambda text: text == 'never', timeout=0.1)
    with pytest.raises(AssertionError):
        process_tools.assert_stderr_sync(launch_context, hello, validate_output, timeout=0.1)
    yield
    assert hello.return_code == 0

@pytest.mark.launch(fixture=description)
async def test_async_generator(hello, launch_context):
    assert await tools.wait_for_output(launch_context, hello, lambda text: 'hello' in text, timeout=60)
    assert await tools.wait_for_stderr(launch_context, hello, lambda text: 'oh' in text, timeout=60)
    yield
    assert hello.return_code == 0

class TestInAClass:
    def setup_method(self):
        self.prepared = True

    @pytest.mark.launch(fixture=description)
    @pytest.mark.parametrize('number', [1, 2])
    async def test_coroutine(self, hello, launch_context, event_loop, number):
        assert self.prepared and number in (1, 2)
        assert asyncio.get_running_loop() is event_loop is launch_context.asyncio_loop
        assert await tools.wait_for_exit(launch_context, hello, timeout=60)

    @pytest.mark.launch(fixture=description, shutdown=True)
    def test_after_the_end(self, hello):
        assert self.prepared and hello.return_code == 0
"""

MODULE_SCOPE = """
seen = []

@pytest.fixture(scope='module')
def started():
    return []

@launch_pytest.fixture(scope='module', params=['a', 'b'])
def description(started, request):
    started.append(python(WAIT))
    yield launch.LaunchDescription([started[-1]]), request.param

@pytest.fixture(scope='module')
def wide(launch_context, launch_service):
    assert launch_service.context is launch_context

@pytest.mark.launch(fixture=description, shutdown=True)
def test_end(started, description):
    seen.append(f'end {description[1]}')
    assert started[-1].return_code != 0

@pytest.mark.launch(fixture=description)
def test_parts(started, launch_context, description, wide):
    seen.append(f'first {description[1]}')
    assert tools.wait_for_output_sync(launch_context, started[-1], lambda text: 'up' in text, timeout=60)
    assert started[-1].return_code is None
    yield
    seen.append(f'second {description[1]}')
    assert started[-1].return_code is not None

@pytest.mark.launch(fixture=description)
async def test_beside(started, description):
    seen.append(f'beside {description[1]}')

def test_order(started):
    assert len(started) == 2
    assert [what for what in seen if what.endswith('a')] == seen[:4]
    assert {*seen[:2]} == {'first a', 'beside a'} and {*seen[2:4]} == {'end a', 'second a'}
"""

NODE = """
from launch_ros.actions import Node

@pytest.fixture
def talker():
    return Node(package='demo_nodes_cpp', executable='talker', cached_output=True)

@launch_pytest.fixture
def description(talker):
    return launch.LaunchDescription([talker])

@pytest.mark.launch(fixture=description)
def test_talking(talker, launch_context):
    assert process_tools.wait_for_stderr_sync(launch_context, talker, lambda text: 'Hello World' in text, timeout=60)
    yield
    assert talker.return_code is not None
"""

MISTAKES = """
@launch_pytest.fixture
def empty():
    return launch.LaunchDescription([])

@launch_pytest.fixture(scope='module')
def nothing():
    return object()

@launch_pytest.fixture
def two():
    return launch.LaunchDescription([launch_pytest.actions.ReadyToTest(), launch_pytest.actions.ReadyToTest()])

@launch_pytest.fixture
def never():
    return launch.LaunchDescription([launch_pytest.actions.ReadyToTest(condition=launch.conditions.IfCondition('0'))])

@pytest.mark.launch(fixture=nothing)
def test_nothing():
    pass

@pytest.mark.launch(fixture=nothing)
def test_nothing_again():
    pass

@pytest.mark.launch(fixture=two)
def test_two():
    pass

@pytest.mark.launch(fixture=never)
def test_never():
    pass

@pytest.mark.launch(fixture=empty)
def test_yields_twice():
    yield
    yield

@pytest.mark.launch(fixture=empty, shutdown=True)
async def test_shutdown_generator():
    yield

@pytest.mark.launch
def test_no_fixture():
    pass
"""

FIRST_PART_FAILS = """
@launch_pytest.fixture(scope='module')
def description():
    return launch.LaunchDescription([])

@pytest.mark.launch(fixture=description)
def test_parts():
    assert False
    yield
"""


STRICT = ["-W", "error", "-o", "asyncio_default_fixture_loop_scope=function"]


def run_pytest(folder, text, *options):
    (folder / "test_it.py").write_text(textwrap.dedent(text))
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-rA", "-p", "no:cacheprovider", "--strict-markers", *options],
        cwd=folder,
        env=process.create_environment({"PATH": os.environ["PATH"], "HOME": str(folder), "LINKWRIGHT_DDS": "0"}),
        check=False,
        capture_output=True,
        text=True,
        timeout=120,
    ).stdout


def outcomes(output):
    return {word: int(count) for count, word in re.findall(r"(\d+) (\w+)", output.splitlines()[-1]) if word != "in"}


@pytest.mark.parametrize("options", [STRICT, ["-p", "launch_pytest.plugin"], ["-o", "asyncio_mode=auto"]])
def test_function_scope_launches_once_per_test(tmp_path, options):
    output = run_pytest(tmp_path, HEAD + FUNCTION_SCOPE, *options)
    assert outcomes(output) == {"passed": 5}, output


def test_module_scope_launches_once(tmp_path):
    output = run_pytest(tmp_path, HEAD + MODULE_SCOPE)
    assert outcomes(output) == {"passed": 9}, output
    assert len(re.findall(r"^PASSED test_it.py::test_parts\S*\[shutdown_test\]", output, re.MULTILINE)) == 2


def test_own_nodes_run_as_processes(tmp_path):
    output = run_pytest(tmp_path, HEAD + NODE)
    assert outcomes(output) == {"passed": 1}, output


def test_fixture_errors_are_reported(tmp_path):
    output = run_pytest(tmp_path, HEAD + MISTAKES)
    assert outcomes(output) == {"failed": 2, "errors": 4, "skipped": 1, "warning": 1}, output
    for text in (
        "launch fixture 'nothing': its value must be either a launch description or",
        "launch fixture 'two': it may contain only one ReadyToTest action",
        "launch fixture 'never': the launch ended before it was ready to test",
        "must stop iteration after yielding once",
        "must not be marked with shutdown=True",
        '"fixture" keyword argument is required',
    ):
        assert text in output


def test_shutdown_part_is_skipped_if_first_part_fails(tmp_path):
    assert outcomes(run_pytest(tmp_path, HEAD + FIRST_PART_FAILS)) == {"failed": 1, "skipped": 1}


def test_pytest_plugin_imports_nothing_without_launch_tests(tmp_path):
    text = """
    import sys

    def test_modules():
        ours = {name for name in sys.modules if name.split(".")[0] in ("linkwright", "launch", "launch_pytest")}
        assert ours <= {"linkwright", "linkwright._version", "linkwright.pytest_plugin"}
    """
    output = run_pytest(tmp_path, text, *STRICT)
    assert outcomes(output) == {"passed": 1}, output
    assert "linkwright-pytest-1" in output


def test_real_launch_pytest_takes_precedence(tmp_path):
    """The stand-in does not replace a real launch_pytest module.

    The real module registers its own plugin.
    """
    real = tmp_path / "launch_pytest"
    real.mkdir()
    (real / "__init__.py").write_text("")
    (real / "plugin.py").write_text(
        "def pytest_configure(config):\n    config.addinivalue_line('markers', 'launch: real')\n"
    )
    text = "import launch_pytest, pytest\n@pytest.mark.launch(fixture=1)\ndef test_one(): pass\n"
    output = run_pytest(tmp_path, text)
    assert outcomes(output) == {"passed": 1}, output
