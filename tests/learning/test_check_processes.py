"""The processes of checks and their ends."""

import os
import subprocess
import sys
from pathlib import PurePosixPath
from types import SimpleNamespace

from linkwright.learning.checks import running
from linkwright.learning.checks.installed import files_of_setup


def test_on_windows_a_process_is_ended_with_its_children(monkeypatch):
    commands = []
    monkeypatch.setattr(running, "sys", SimpleNamespace(platform="win32"))
    monkeypatch.setattr(running.subprocess, "run", lambda command, **_: commands.append(command))
    with subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"]) as process:
        running._end_group(process)
        assert commands == [["taskkill", "/T", "/F", "/PID", str(process.pid)]]
        assert process.wait() != 0
        running._end_group(process)
    assert len(commands) == 1


def test_a_setup_file_may_print_what_the_encoding_of_the_system_lacks(tmp_path, monkeypatch):
    monkeypatch.setitem(os.environ, "PYTHONUTF8", "0")
    monkeypatch.setitem(os.environ, "PYTHONCOERCECLOCALE", "0")
    monkeypatch.setitem(os.environ, "LC_ALL", "C")
    program = "from setuptools import setup\nprint('机器人')\nsetup(data_files=[('share', ['world.sdf'])])\n"
    (tmp_path / "setup.py").write_text(program, encoding="utf-8")
    assert files_of_setup(tmp_path) == {PurePosixPath("share/world.sdf"): tmp_path / "world.sdf"}
