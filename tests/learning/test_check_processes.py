"""The processes of checks and their ends."""

import os
import subprocess
import sys
from pathlib import PurePosixPath
from types import SimpleNamespace

import pytest

from linkwright.learning.checks import running
from linkwright.learning.checks.installed import files_of_setup
from linkwright.learning.course import load_course
from linkwright.learning.new_course import create_course


def test_windows_process_is_ended_with_children(monkeypatch):
    commands = []
    monkeypatch.setattr(running, "sys", SimpleNamespace(platform="win32"))
    monkeypatch.setattr(running.subprocess, "run", lambda command, **_: commands.append(command))
    with subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"]) as process:
        running._end_group(process)
        assert commands == [["taskkill", "/T", "/F", "/PID", str(process.pid)]]
        assert process.wait() != 0
        running._end_group(process)
    assert len(commands) == 1


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no niceness")
def test_checks_of_page_run_at_low_priority(tmp_path):
    course = tmp_path / "course"
    create_course(course)
    (course / "01-one-link" / "checks.py").write_text(
        "import os\nfrom linkwright.learning import check\n\n"
        '@check("mass", en="It is said.", zh="说。")\n'
        "def tell(work):\n"
        "    (work.folder / 'niceness').write_text(str(os.nice(0)))\n",
        encoding="utf-8",
    )
    step = load_course(course).find_step("mass")
    assert running.CheckProcess(step, tmp_path, niceness=5).run().passed
    assert int((tmp_path / "niceness").read_text()) == min(os.nice(0) + 5, 19)


def test_setup_file_may_print_non_ascii_text_in_c_locale(tmp_path, monkeypatch):
    monkeypatch.setitem(os.environ, "PYTHONUTF8", "0")
    monkeypatch.setitem(os.environ, "PYTHONCOERCECLOCALE", "0")
    monkeypatch.setitem(os.environ, "LC_ALL", "C")
    program = "from setuptools import setup\nprint('机器人')\nsetup(data_files=[('share', ['world.sdf'])])\n"
    (tmp_path / "setup.py").write_text(program, encoding="utf-8")
    assert files_of_setup(tmp_path) == {PurePosixPath("share/world.sdf"): tmp_path / "world.sdf"}


@pytest.mark.parametrize("stop_at_failure", [False, True])
def test_checks_can_stop_at_first_failure(tmp_path, stop_at_failure):
    course = tmp_path / "course"
    create_course(course)
    (course / "01-one-link" / "checks.py").write_text(
        "from linkwright.learning import NotYet, check\n\n"
        '@check("mass", en="One.", zh="一。")\n'
        "def fail(work):\n"
        '    raise NotYet(en="No.", zh="没有。")\n\n'
        '@check("mass", en="Two.", zh="二。")\n'
        "def write(work):\n"
        "    (work.folder / 'second').touch()\n",
        encoding="utf-8",
    )
    step = load_course(course).find_step("mass")
    result = running.check_in_process(step, tmp_path, stop_at_failure=stop_at_failure)
    assert [check.passed for check in result.checks] == ([False] if stop_at_failure else [False, True])
    assert (tmp_path / "second").exists() is not stop_at_failure
