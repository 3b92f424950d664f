"""Linkwright on a Python without the features that Windows or macOS lacks.

See `sitecustomize`.
"""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path, PurePosixPath, PureWindowsPath

import pytest

from linkwright.packages.uri import parse_absolute_path
from linkwright.process import interruption, standard_streams
from tests.domains import own_domain
from tests.places import PACKAGE
from tests.waiting import wait_until

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="other systems are simulated on Linux")

SYSTEMS = ("windows", "macos")
ROBOT = PACKAGE / "urdf" / "mbot_with_laser.urdf"
IMPORT_ALL = """
import importlib, pkgutil, linkwright
LEFT_OUT = (
    "linkwright.__main__",
    "linkwright.launch.engine.guardian_program",
    "linkwright.navigation.substitutes.servers",
    "linkwright.vision.training.learning",
)
for module in pkgutil.walk_packages(linkwright.__path__, "linkwright."):
    if not module.name.startswith(LEFT_OUT):
        importlib.import_module(module.name)
print("all")
"""
"""Imports all modules except programs, modules that need launch_ros, and modules that need PyTorch."""
PROGRAM = """
import sys
from launch import LaunchDescription
from launch.actions import ExecuteProcess, RegisterEventHandler, Shutdown
from launch.event_handlers import OnProcessIO

SLEEP = "import time; print('began', flush=True); time.sleep(600)"

def generate_launch_description():
    began = OnProcessIO(on_stdout=lambda event: Shutdown(reason="it began"))
    return LaunchDescription([ExecuteProcess(cmd=[sys.executable, "-c", SLEEP], EMULATED), RegisterEventHandler(began)])
"""


@pytest.fixture(params=SYSTEMS)
def start_on_other_system(request, tmp_path):
    """Return a function that starts ``linkwright`` on another system."""
    environment = {
        **os.environ,
        "LINKWRIGHT_TESTS_SYSTEM": request.param,
        "PYTHONPATH": str(Path(__file__).parent),
        "ROS_DOMAIN_ID": str(own_domain()),
        "ROS_LOG_DIR": str(tmp_path / "log"),
    }

    def start(*words: object, module: str = "linkwright") -> subprocess.Popen[str]:
        command = [sys.executable, "-m", module, *map(str, words)]
        return subprocess.Popen(
            command, cwd=tmp_path, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )

    return start


def output_of(process: subprocess.Popen[str]) -> str:
    """Return the output of a command, which must succeed."""
    out, error = process.communicate(timeout=120)
    assert process.returncode == 0, out + error
    return out


def test_all_modules_can_be_imported(start_on_other_system, tmp_path):
    (tmp_path / "import_all.py").write_text(IMPORT_ALL, encoding="utf-8")
    assert output_of(start_on_other_system(module="import_all")).splitlines()[-1] == "all"


def test_commands_run(start_on_other_system, tmp_path):
    assert "base_link" in output_of(start_on_other_system("check", ROBOT))
    assert (
        output_of(start_on_other_system("xacro", PACKAGE / "urdf" / "mbot_gazebo.xacro", "laser:=true"))
        .rstrip()
        .endswith("</robot>")
    )
    output_of(start_on_other_system("pkg", "create", "arm", "--build-type", "ament_python", "--license", "MIT"))
    assert (tmp_path / "arm" / "package.xml").is_file()
    assert "base_link" in output_of(start_on_other_system("inertia", ROBOT))


def test_viewer_serves_page_and_ctrl_c_ends_it(start_on_other_system):
    viewer = start_on_other_system("view", ROBOT, "--no-open")
    try:
        address = next(match[0] for line in viewer.stdout if (match := re.search(r"http://\S+", line)))
        with urllib.request.urlopen(address, timeout=60) as response:
            assert b"<script" in response.read()
    finally:
        viewer.send_signal(signal.SIGINT)
        out, error = viewer.communicate(timeout=60)
    assert viewer.returncode == 130, out + error
    assert "Traceback" not in error


@pytest.mark.parametrize("emulated", ["", "emulate_tty=True"])
def test_launched_processes_end_cleanly(start_on_other_system, tmp_path, emulated):
    (tmp_path / "it.launch.py").write_text(PROGRAM.replace("EMULATED", emulated), encoding="utf-8")
    process = start_on_other_system("launch", "./it.launch.py")
    out, error = process.communicate(timeout=120)
    assert process.returncode == 0, out + error
    assert "process has finished cleanly" in out + error
    assert "has died" not in out + error


def test_world_is_simulated(start_on_other_system):
    pytest.importorskip("mujoco")
    output_of(start_on_other_system("sim", "empty", ROBOT, "--headless", "--seconds", "0.5"))


@pytest.mark.parametrize(
    ("address", "path"),
    [
        ("///C:/robots/arm.stl", "C:/robots/arm.stl"),  # as written by Path.as_uri on Windows
        ("//localhost/C:/robots/arm.stl", "C:/robots/arm.stl"),
        ("//C:/robots/arm.stl", "C:/robots/arm.stl"),
        ("//C:\\robots\\arm.stl", "C:\\robots\\arm.stl"),  # as in file://$(find PACKAGE)\\...
        ("/d:/my%20robots/arm.stl", "d:/my robots/arm.stl"),
    ],
)
def test_file_urls_with_drive_letter_are_absolute_on_windows(address, path):
    path_with_drive = parse_absolute_path(address, with_drives=True)
    assert path_with_drive == path
    assert PureWindowsPath(path_with_drive).is_absolute()


def test_drive_letter_is_a_folder_on_other_systems():
    assert parse_absolute_path("///C:/robots", with_drives=False) == "/C:/robots"
    assert PurePosixPath(parse_absolute_path("///C:/robots", with_drives=False)).is_absolute()
    assert parse_absolute_path("//C:/robots", with_drives=False) is None


def test_signal_again_does_not_end_process_on_windows(monkeypatch):
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.setattr(os, "kill", lambda *_: pytest.fail("this ends a process on Windows"))
    received = []
    before = signal.signal(signal.SIGINT, lambda number, _: received.append(number))
    try:
        interruption.resend_signal(signal.SIGINT)
        wait_until(lambda: received)
    finally:
        signal.signal(signal.SIGINT, before)
    assert received == [signal.SIGINT]


class Recorded:
    def __init__(self):
        self.asked = []

    def send_signal(self, number):
        self.asked.append(number)

    def terminate(self):
        self.asked.append("terminate")


@pytest.mark.parametrize(
    ("platform", "expected_signal"), [("linux", signal.SIGINT), ("darwin", signal.SIGINT), ("win32", "terminate")]
)
def test_interrupt_uses_sigint_or_terminate_by_platform(monkeypatch, platform, expected_signal):
    monkeypatch.setattr(sys, "platform", platform)
    process = Recorded()
    interruption.interrupt(process)
    assert process.asked == [expected_signal]


NAMES = "ä漢字"


@pytest.mark.parametrize("encoding", ["cp1252", "cp936", "cp437", "latin-1"])
@pytest.mark.parametrize("verb", ["check", "xacro", "inertia"])
def test_unicode_output_survives_code_pages(tmp_path, encoding, verb):
    robot = tmp_path / "robot.urdf"
    robot.write_text(f'<robot name="r"><link name="{NAMES}"/></robot>', encoding="utf-8")
    program = f"""
import sys
for stream in (sys.stdout, sys.stderr):
    stream.reconfigure(encoding="{encoding}")
from linkwright.cli import main
sys.exit(main())
"""
    command = [sys.executable, "-c", program, verb, str(robot)]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONIOENCODING"}
    result = subprocess.run(command, env={**environment, "LINKWRIGHT_LANG": "zh"}, capture_output=True, check=False)
    assert result.returncode == 0, result.stderr
    assert NAMES in result.stdout.decode("utf-8")


def test_requested_output_encoding_is_kept(monkeypatch, tmp_path):
    monkeypatch.setenv("PYTHONIOENCODING", "cp1252")
    with (tmp_path / "out").open("w", encoding="cp1252") as stream:
        monkeypatch.setattr(sys, "stdout", stream)
        standard_streams.accept_any_text()
        stream.write(NAMES)
    assert (tmp_path / "out").read_bytes() == b"\xe4\\u6f22\\u5b57"
