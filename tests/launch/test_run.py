"""`linkwright launch` from start to end: views, signals and errors."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
import urllib.request
from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.launch import LaunchOptions, LaunchTarget, run_launch
from tests.launch.launcher import Running, is_gone, launch_file
from tests.places import TUTORIAL_PACKAGES
from tests.waiting import TIMEOUT_S, wait_until

Write = Callable[[str, str], Path]

STUBBORN = (
    "import os, signal, time\n"
    "for number in (signal.SIGINT, signal.SIGTERM): signal.signal(number, signal.SIG_IGN)\n"
    "child = os.fork()\n"
    "os.write(1, f'pid {os.getpid()}\\n'.encode())\n"
    "time.sleep(60)\n"
)


@pytest.mark.parametrize("file", ["display.launch.py", "display_xacro.launch.py"])
@pytest.mark.parametrize("folder", [package.parent for package in TUTORIAL_PACKAGES], ids=lambda folder: folder.name)
def test_tutorial_launch_file_runs(start: Callable[..., Running], folder: Path, file: str) -> None:
    running = start("my_robot_description", file, cwd=folder)
    with urllib.request.urlopen(running.url) as response:
        assert response.status == 200
    running.until("Robot initialized")
    assert running.end()[0] == 130
    assert running.out.count("\n") == 1
    assert "Traceback" not in running.err
    assert "error" not in running.err
    assert "user interrupted with ctrl-c (SIGINT)" in running.err
    assert running.err.count("has finished cleanly") == 3


def test_source_package_is_launched_by_path(start: Callable[..., Running], write: Write) -> None:
    write("ws/src/arm/package.xml", "<package><name>arm</name></package>")
    write("ws/src/arm/urdf/arm.urdf", '<robot name="arm"><link name="base"/></robot>')
    path = write(
        "ws/src/arm/launch/show.launch.py",
        launch_file(
            "Node(package='robot_state_publisher', executable='robot_state_publisher', parameters=[{"
            "'robot_description': Command(['xacro ', FindPackageShare('arm'), '/urdf/arm.urdf'])}])",
            head="from launch_ros.substitutions import FindPackageShare",
        ),
    )
    running = start(path)
    running.until("Robot initialized")
    assert running.end()[0] == 130


def test_two_launches_use_different_ports(start: Callable[..., Running]) -> None:
    launchers = [start("my_robot_description", "display.launch.py") for _ in range(2)]
    urls = [running.url for running in launchers]
    assert urls[0].split("/?")[0] != urls[1].split("/?")[0]
    for running, url in zip(launchers, urls, strict=True):
        with urllib.request.urlopen(url) as response:
            assert response.status == 200
        assert running.end()[0] == 130


class TestSignals:
    def test_sigterm_ends_launch(self, start: Callable[..., Running]) -> None:
        running = start("my_robot_description", "display.launch.py")
        running.until("Robot initialized")
        assert running.end(signal.SIGTERM)[0] == 143
        assert "received signal SIGTERM" in running.err

    @pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
    def test_no_process_outlives_launch(self, start: Callable[..., Running], write: Write, number: int) -> None:
        options = "output='screen', name='bad', sigterm_timeout='0.3', sigkill_timeout='0.3'"
        action = f"ExecuteProcess(cmd=[sys.executable, '-c', {STUBBORN!r}], {options})"
        running = start(write("a.launch.py", launch_file(action, action)))
        running.until("[bad-1] pid")
        running.until("[bad-2] pid")
        wait_until(lambda: running.out.count("pid ") >= 4)
        pids = [int(pid) for pid in re.findall(r"pid (\d+)", running.out)]
        assert running.end(number)[0] == 128 + number
        for signal_name, following in (("SIGINT", "SIGTERM"), ("SIGTERM", "SIGKILL")):
            assert (
                f"failed to terminate '0.3' seconds after receiving '{signal_name}', escalating to '{following}'"
                in running.err
            )
        wait_until(lambda: all(map(is_gone, pids)))

    def test_second_sigint_kills_processes(self, start: Callable[..., Running], write: Write) -> None:
        action = f"ExecuteProcess(cmd=[sys.executable, '-c', {STUBBORN!r}], output='screen', name='bad')"
        running = start(write("a.launch.py", launch_file(action)))
        running.until("[bad-1] pid")
        running.process.send_signal(signal.SIGINT)
        running.until("waiting for bad-1 to end; press Ctrl-C again to end them now")
        status, seconds = running.end()
        assert status == 130
        assert seconds < 10.0, "the processes end without the usual delays"
        assert "escalating to 'SIGTERM'" in running.err
        assert "escalating to 'SIGKILL'" in running.err

    def test_second_sigint_lets_processes_handle_sigterm(self, start: Callable[..., Running], write: Write) -> None:
        program = (
            "import signal, sys, time\nsignal.signal(signal.SIGINT, signal.SIG_IGN)\n"
            "signal.signal(signal.SIGTERM, lambda *_: (print('saved', flush=True), sys.exit(0)))\n"
            "print('ready', flush=True)\ntime.sleep(60)"
        )
        action = f"ExecuteProcess(cmd=[sys.executable, '-c', {program!r}], output='screen', name='slow')"
        running = start(write("a.launch.py", launch_file(action)))
        running.until("[slow-1] ready")
        running.process.send_signal(signal.SIGINT)
        running.until("waiting for slow-1 to end")
        assert running.end()[0] == 130
        assert "[slow-1] saved" in running.out

    def test_sigint_ends_launch_while_event_loop_hangs(self, start: Callable[..., Running], write: Write) -> None:
        handler = "def wait(event, context):\n    print('hangs', flush=True)\n    time.sleep(60)"
        head = f"from launch.event_handlers import OnShutdown\n{handler}"
        actions = ["RegisterEventHandler(OnShutdown(on_shutdown=wait))", "TimerAction(period=60.0, actions=[])"]
        running = start(write("a.launch.py", launch_file(*actions, head=head)))
        running.until("Default logging verbosity")
        running.process.send_signal(signal.SIGINT)
        running.until("hangs")
        assert running.process.wait(TIMEOUT_S) == 130

    def test_process_receives_sigint_first(self, start: Callable[..., Running], write: Write) -> None:
        program = (
            "import time\ntry:\n    print('ready', flush=True); time.sleep(60)\n"
            "except KeyboardInterrupt: print('asked')"
        )
        action = f"ExecuteProcess(cmd=[sys.executable, '-c', {program!r}], output='screen', name='good')"
        running = start(write("a.launch.py", launch_file(action)))
        running.until("[good-1] ready")
        assert running.end()[0] == 130
        assert "[good-1] asked" in running.out
        assert "escalating" not in running.err
        assert "process has finished cleanly" in running.err

    @pytest.mark.parametrize(
        ("action", "head"),
        [
            (
                "OpaqueFunction(function=wait)",
                "def wait(context):\n    print('waiting', flush=True)\n    time.sleep(60)",
            ),
            ("LogInfo(msg=Command('sleep 60'))", "print('waiting', flush=True)"),
            ("", "print('waiting', flush=True)\ntime.sleep(60)"),
        ],
    )
    def test_sigint_ends_launch_while_launch_file_runs(
        self, start: Callable[..., Running], write: Write, action: str, head: str
    ) -> None:
        running = start(write("a.launch.py", launch_file(action, head=head)))
        running.until("waiting")
        assert running.end()[0] == 130, running.err
        assert "Traceback" not in running.err


class TestBadInput:
    def test_invalid_argument_is_raised_before_start(self, write: Write) -> None:
        path = write("a.launch.py", launch_file("DeclareLaunchArgument('gui', default_value='a', choices=['a'])"))
        with pytest.raises(LinkwrightError, match="'gui' has the value 'x'"):
            run_launch(LaunchTarget(str(path)), {"gui": "x"}, LaunchOptions(open_browser=False))

    def test_failing_action_returns_1(self, write: Write, capsys: pytest.CaptureFixture[str]) -> None:
        path = write("a.launch.py", launch_file("LogInfo(msg=LaunchConfiguration('none'))"))
        assert run_launch(LaunchTarget(str(path))) == 1
        err = capsys.readouterr().err
        assert "error[LAUNCH121]: launch configuration 'none' is not set" in err
        assert re.search(r"a\.launch\.py:\d+:\d+", err)

    def test_successful_launch_returns_0(self, write: Write, capsys: pytest.CaptureFixture[str]) -> None:
        path = write("a.launch.py", launch_file("LogInfo(msg=ThisLaunchFile())", "SetEnvironmentVariable('LW_X', '1')"))
        assert run_launch(LaunchTarget(str(path)), {"extra": "1"}) == 0
        err = capsys.readouterr().err
        assert f"[INFO] [launch.user]: {path}" in err
        assert "warning[LAUNCH113]: argument 'extra' is not declared" in err
        assert "LW_X" not in os.environ

    @pytest.mark.parametrize(
        "inner_file", ["DeclareLaunchArgument('model')", "IncludeLaunchDescription(LaunchConfiguration('x'))"]
    )
    def test_argument_of_included_file_is_not_reported_as_undeclared(
        self, write: Write, capsys: pytest.CaptureFixture[str], inner_file: str
    ) -> None:
        included = write("inner.launch.py", launch_file(inner_file))
        include_options = "launch_arguments={'model': 'm'}.items(), condition=UnlessCondition('true')"
        path = write(
            "a.launch.py",
            launch_file(
                f"IncludeLaunchDescription('{included}', {include_options})",
                head="from launch.conditions import UnlessCondition",
            ),
        )
        assert run_launch(LaunchTarget(str(path)), {"model": "mine"}) == 0
        assert "LAUNCH113" not in capsys.readouterr().err

    def test_include_condition_is_evaluated_before_its_arguments(
        self, write: Write, capsys: pytest.CaptureFixture[str]
    ) -> None:
        included = write("inner.launch.py", launch_file("DeclareLaunchArgument('needed', choices=['a'])"))
        include_options = "launch_arguments={'other': LaunchConfiguration('none')}.items()"
        path = write(
            "a.launch.xml",
            f'<launch><arg name="go" default="false"/><include file="{included}" if="$(var go)"/>'
            f'<include file="{included}.gone" if="$(var go)"><arg name="x" value="$(var none)"/></include></launch>',
        )
        assert run_launch(LaunchTarget(str(path)), {"needed": "b"}) == 0
        include = f"IncludeLaunchDescription('{included}', {include_options}, condition=UnlessCondition('true'))"
        path = write("a.launch.py", launch_file(include, head="from launch.conditions import UnlessCondition"))
        assert run_launch(LaunchTarget(str(path)), {"needed": "b"}) == 0
        assert "error" not in capsys.readouterr().err

    def test_non_action_is_rejected_at_its_line(self, write: Write) -> None:
        path = write(
            "a.launch.py",
            "from launch import LaunchDescription\nfrom launch.actions import LogInfo\n"
            "def generate_launch_description():\n    made = LaunchDescription()\n"
            "    made.add_action([LogInfo(msg='x')])\n    return made\n",
        )
        with pytest.raises(LinkwrightError, match="not a value of type list") as caught:
            run_launch(LaunchTarget(str(path)))
        (diagnostic,) = caught.value.diagnostics
        assert diagnostic.code == "LAUNCH147"
        assert diagnostic.span is not None
        assert diagnostic.span.line == 5

    @pytest.mark.parametrize("built", [True, False])
    def test_ament_prefix_path_is_set_while_launch_file_loads(
        self,
        write: Write,
        monkeypatch: pytest.MonkeyPatch,
        capsys: pytest.CaptureFixture[str],
        tmp_path: Path,
        built: bool,
    ) -> None:
        write("ws/src/arm/package.xml", "<package><name>arm</name></package>")
        if built:
            write("ws/install/.colcon_install_layout", "isolated")
            write("ws/install/arm/share/ament_index/resource_index/packages/arm", "")
            write("ws/install/arm/share/arm/package.xml", "<package><name>arm</name></package>")
        path = write(
            "ws/a.launch.py",
            launch_file("LogInfo(msg=PREFIX)", head="import os\nPREFIX = os.environ['AMENT_PREFIX_PATH']"),
        )
        monkeypatch.chdir(tmp_path / "ws")
        assert run_launch(LaunchTarget(str(path))) == 0
        expected = tmp_path / "ws" / "install" / ("arm" if built else "")
        assert f"[launch.user]: {expected}\n" in capsys.readouterr().err
        assert "AMENT_PREFIX_PATH" not in os.environ

    def test_launch_is_imported_from_standins(self) -> None:
        script = (
            "from linkwright.standins import activate\nactivate(); activate()\nimport launch\nprint(launch.__file__)"
        )
        out = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
        assert "standins/tables/launch" in out


class TestView:
    def test_urdf_model_is_shown(self, start: Callable[..., Running], write: Write) -> None:
        running = start("view", write("m.urdf", '<robot name="a"><link name="b"/></robot>'))
        with urllib.request.urlopen(running.url) as response:
            assert response.status == 200
        running.until("Robot initialized")
        assert running.end()[0] == 130

    def test_broken_model_is_reported_until_fixed(self, start: Callable[..., Running], write: Write) -> None:
        path = write("m.urdf", '<robot name="a">\n  <link name="b">\n</robot>')
        running = start("view", path)
        running.until("Viewer: ")
        running.until("error[XML")
        time.sleep(0.3)
        path.write_text('<robot name="a"><link name="b"/></robot>')
        running.until("Robot initialized")
        assert running.end()[0] == 130
        assert "Traceback" not in running.err


LACKS_A_PACKAGE = """\
from ament_index_python.packages import get_package_share_directory

def generate_launch_description():
    get_package_share_directory("no_such_package")
"""


@pytest.mark.parametrize("text", ["import no_such_module\n", LACKS_A_PACKAGE])
def test_missing_parts_of_launch_file_itself_cannot_be_skipped(write: Write, text: str) -> None:
    target = LaunchTarget(str(write("whole.launch.py", text)))
    for skip, notes in ((True, 1), (False, 0)):
        with pytest.raises(LinkwrightError) as caught:
            run_launch(target, options=LaunchOptions(skip_missing=skip, open_browser=False))
        (diagnostic,) = caught.value.diagnostics
        assert diagnostic.hint
        assert len([note for note in diagnostic.notes if note.message.startswith("the launch file itself")]) == notes
