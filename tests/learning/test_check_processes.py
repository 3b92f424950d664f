"""The processes of checks and their ends."""

import os
import subprocess
import sys
import threading
import time
from pathlib import PurePosixPath
from types import SimpleNamespace

import pytest

from linkwright.learning.checks import check_process, launch_check
from linkwright.learning.checks.installed_files import list_setup_files
from linkwright.learning.checks.preparation import prepare
from linkwright.learning.course import load_course
from linkwright.learning.new_course import create_course
from linkwright.process import forked
from tests.waiting import wait_until


def test_windows_process_is_ended_with_children(monkeypatch):
    commands = []
    monkeypatch.setattr(check_process, "sys", SimpleNamespace(platform="win32"))
    monkeypatch.setattr(check_process.subprocess, "run", lambda command, **_: commands.append(command))
    with subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"]) as process:
        check_process._kill_session(process)
        assert commands == [["taskkill", "/T", "/F", "/PID", str(process.pid)]]
        assert process.wait() != 0
        check_process._kill_session(process)
    assert len(commands) == 1


def test_preparation_of_server_leaves_no_thread_that_a_fork_would_lose():
    before = set(threading.enumerate())
    prepare()
    assert set(threading.enumerate()) <= before


BUSY = "import os\nos.sched_setaffinity(0, [{processor}])\nwhile True: pass"


@pytest.fixture
def busy_processor(check_server):
    """Yield the number of a processor that four other programs occupy.

    They start after the server of the checks, whose imports they would slow down.
    """
    if forked.IS_POSSIBLE:
        check_server.prepare()
        wait_until(lambda: check_server.is_ready, what="the server of the checks")
    processor = min(os.sched_getaffinity(0))
    program = [sys.executable, "-c", BUSY.format(processor=processor)]
    processes = [subprocess.Popen(program, start_new_session=True) for _ in range(4)]
    yield processor
    for process in processes:
        process.kill()
        process.wait()


def run_statement(server, folder, statement, processor, time_limit):
    """Run a check that executes one statement on a processor, and return its message."""
    course = folder / "course"
    create_course(course)
    (course / "01-one-link" / "checks.py").write_text(
        f"import os, time\nfrom linkwright.learning import check\n\nos.sched_setaffinity(0, [{processor}])\n"
        '@check("mass", en="It ends.", zh="它会结束。")\n'
        f"def run(work):\n    {statement}\n",
        encoding="utf-8",
    )
    step = load_course(course).find_step("mass")
    (result,) = check_process.check_in_process(step, folder, time_limit=time_limit, server=server).checks
    return str(result.message)


ON_LINUX = pytest.mark.skipif(sys.platform != "linux", reason="only Linux reports how long a process waits")


@ON_LINUX
def test_load_of_machine_does_not_end_check(check_server, tmp_path, busy_processor):
    compute = "while time.process_time() < 0.6: pass"
    statement = f"begin = time.monotonic()\n    {compute}\n    assert time.monotonic() > begin + 1.5"
    assert run_statement(check_server, tmp_path, statement, busy_processor, 1.5) == "None"


@ON_LINUX
@pytest.mark.parametrize("statement", ["while True: pass", "time.sleep(1000)"])
def test_endless_loop_and_sleep_end_on_busy_machine(check_server, tmp_path, busy_processor, statement):
    message = run_statement(check_server, tmp_path, statement, busy_processor, 0.5)
    assert message == "the check took longer than 0.5 s and was ended"


@ON_LINUX
def test_processes_that_hinder_one_another_are_ended(check_server, tmp_path):
    processor = min(os.sched_getaffinity(0))
    statement = "[os.fork() for _ in range(4)]\n    while True: pass"
    message = run_statement(check_server, tmp_path, statement, processor, 0.5)
    assert message == "the check took longer than 0.5 s and was ended"


def test_call_of_launch_waits_without_load_only(monkeypatch):
    """The launch's event loop is blocked for longer than the wait.

    The clock stops during this time.
    """
    check = launch_check.LaunchCheck("package", "file", {}, None)
    loop = check._loop
    thread = threading.Thread(target=loop.run_forever)
    thread.start()
    monkeypatch.setattr(launch_check, "_WAIT_S", 0.05)
    loop.call_soon_threadsafe(time.sleep, 0.3)
    with pytest.raises(TimeoutError):
        check._call(lambda: 1)
    monkeypatch.setattr(launch_check, "PatientClock", lambda: SimpleNamespace(read=lambda: 0.0))
    loop.call_soon_threadsafe(time.sleep, 0.3)
    assert check._call(lambda: 1) == 1
    loop.call_soon_threadsafe(loop.stop)
    thread.join()
    loop.close()


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
    assert check_process.CheckProcess(step, tmp_path, niceness=5).run().passed
    assert int((tmp_path / "niceness").read_text()) == min(os.nice(0) + 5, 19)


def test_setup_file_may_print_non_ascii_text_in_c_locale(tmp_path, monkeypatch):
    monkeypatch.setitem(os.environ, "PYTHONUTF8", "0")
    monkeypatch.setitem(os.environ, "PYTHONCOERCECLOCALE", "0")
    monkeypatch.setitem(os.environ, "LC_ALL", "C")
    program = "from setuptools import setup\nprint('机器人')\nsetup(data_files=[('share', ['world.sdf'])])\n"
    (tmp_path / "setup.py").write_text(program, encoding="utf-8")
    assert list_setup_files(tmp_path) == {PurePosixPath("share/world.sdf"): tmp_path / "world.sdf"}


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
    result = check_process.check_in_process(step, tmp_path, stop_at_failure=stop_at_failure)
    assert [check.passed for check in result.checks] == ([False] if stop_at_failure else [False, True])
    assert (tmp_path / "second").exists() is not stop_at_failure
