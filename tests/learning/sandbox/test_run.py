"""The inputs of a run in the sandbox, and the results for its grader."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import uuid
from pathlib import Path

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.learning.sandbox import (
    PROTECTIONS,
    Exceeded,
    Limits,
    Outcome,
    Protection,
    describe_exceeded,
    find_available_protections,
    run,
    run_in_sandbox,
)
from tests.learning.sandbox import attacks
from tests.learning.sandbox.conftest import processes_with
from tests.waiting import wait_until

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no sandbox")
on_linux = pytest.mark.skipif(sys.platform != "linux", reason="needs Linux")

LIMITS = Limits(seconds=60, cpu_seconds=20)


def run_python(folder: Path, program: str, *words: str, limits: Limits = LIMITS, **options: object) -> Outcome:
    return run_in_sandbox([sys.executable, "-c", program, *words], folder=folder, limits=limits, **options)  # type: ignore[arg-type]


def test_run_returns_status_and_output_of_program(student: Path) -> None:
    (student / "input").write_text("2")
    program = """
import os, sys
open("output", "w").write(open("input").read() * 2)
print("result", os.getcwd() == os.environ["HOME"])
print("problem", file=sys.stderr)
sys.exit(3)
"""
    outcome = run_python(student, program)
    assert (outcome.status, outcome.stdout, outcome.stderr) == (3, b"result True\n", b"problem\n")
    assert (student / "output").read_text() == "22"
    assert (student / "output").stat().st_uid == os.getuid()
    assert sorted(path.name for path in student.iterdir()) == ["input", "output"]


def test_status_is_negative_signal_number(student: Path) -> None:
    outcome = run_python(student, "import os, signal; os.kill(os.getpid(), signal.SIGSEGV)")
    assert (outcome.status, outcome.exceeded) == (-signal.SIGSEGV, None)


def test_run_does_not_inherit_environment_of_grader(student: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ACCESS_TOKEN", "secret")
    program = "import json, os; print(json.dumps(dict(os.environ)))"
    environment = json.loads(run_python(student, program, environment={"ROS_DOMAIN_ID": "7"}).stdout)
    assert "ACCESS_TOKEN" not in environment
    assert environment["ROS_DOMAIN_ID"] == "7"
    assert Path(environment["TMPDIR"]).parent == student


def test_temporary_files_are_removed_after_run(student: Path) -> None:
    outcome = run_python(student, "import tempfile; tempfile.mkstemp(); print(tempfile.mkdtemp())")
    assert Path(outcome.stdout.decode().strip()).parent.parent == student
    assert list(student.iterdir()) == []


def test_readable_files_can_be_read_and_not_changed(student: Path) -> None:
    course = student.parent / "course"
    course.mkdir()
    (course / "world").write_text("flat")
    program = """
import sys
print(open(sys.argv[1]).read())
try:
    open(sys.argv[1], "w")
except OSError:
    print("denied")
"""
    if Protection.WRITE not in find_available_protections():
        pytest.skip("this system does not offer that protection")
    outcome = run_python(student, program, str(course / "world"), readable=[course])
    assert outcome.stdout.split() == [b"flat", b"denied"]
    assert (course / "world").read_text() == "flat"


@pytest.mark.parametrize("umask", [0o022, 0o077])
def test_private_umask_and_program_folder_are_supported(student: Path, umask: int) -> None:
    before = os.umask(umask)
    try:
        private = student.parent / "private"
        private.mkdir(mode=0o700)
        (private / "program.py").write_text("open('written', 'w'); print('fine')")
        (private / "program.py").chmod(0o600)
        arguments = [sys.executable, str(private / "program.py")]
        outcome = run_in_sandbox(arguments, folder=student, limits=LIMITS, readable=[private])
    finally:
        os.umask(before)
    assert (outcome.stdout, outcome.stderr) == (b"fine\n", b"")
    assert (student / "written").stat().st_mode & 0o777 == 0o644


def test_readable_symlink_is_followed(student: Path) -> None:
    course, link = student.parent / "course", student.parent / "link"
    course.mkdir()
    (course / "world").write_text("flat")
    link.symlink_to("course")
    outcome = run_python(student, "import sys; print(open(sys.argv[1]).read())", str(link / "world"), readable=[link])
    assert outcome.stdout == b"flat\n"


def test_supervisor_does_not_import_modules_of_student(student: Path) -> None:
    for name in ("json", "ctypes", "linkwright", "resource"):
        (student / f"{name}.py").write_text("raise SystemExit('imported the wrong module')")
    outcome = run_python(student, "print('fine')")
    assert outcome.stdout == b"fine\n"


def test_missing_program_is_an_error(student: Path) -> None:
    with pytest.raises(LinkwrightError, match="no-such-program: No such file"):
        run_in_sandbox(["no-such-program"], folder=student, limits=LIMITS)


def test_run_uses_only_given_processors(student: Path) -> None:
    if sys.platform != "linux":
        pytest.skip("only Linux has this feature")
    processor = min(os.sched_getaffinity(0))
    outcome = run_python(student, "import os; print(os.sched_getaffinity(0))", processors=[processor])
    assert outcome.stdout.decode().strip() == str({processor})


@on_linux
@pytest.mark.parametrize("ending", [signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
def test_killed_grader_leaves_no_process(student: Path, ending: signal.Signals) -> None:
    mark = uuid.uuid4().hex
    arguments = [sys.executable, "-c", attacks.DAEMONS + attacks.SLEEP, mark]
    program = f"""
from pathlib import Path
from linkwright.learning.sandbox import Limits, run_in_sandbox
run_in_sandbox({arguments!r}, folder=Path.cwd(), limits=Limits())
"""
    with subprocess.Popen([sys.executable, "-c", program], cwd=student, stderr=subprocess.DEVNULL) as grader:
        wait_until(lambda: len(processes_with(mark)) == 7)  # grader, program, and five daemons
        grader.send_signal(ending)
    wait_until(lambda: processes_with(mark) == [])


@on_linux
def test_nodes_of_run_discover_only_each_other(student: Path) -> None:
    pytest.importorskip("cyclonedds")
    program = """
import subprocess, sys
command = [sys.executable, "-m", "linkwright", "topic"]
words = ["/chatter", "std_msgs/msg/String"]
with subprocess.Popen([*command, "pub", *words, "data: hello", "--rate", "20"], stdout=subprocess.DEVNULL) as talker:
    print(subprocess.check_output([*command, "echo", *words, "--once"], text=True, timeout=50))
    talker.kill()
"""
    if Protection.NETWORK not in find_available_protections():
        pytest.skip("this system does not offer that protection")
    assert b"data: hello" in run_python(student, program).stdout


def test_system_v_shared_memory_is_refused(student: Path) -> None:
    if sys.platform != "linux" or os.uname().machine not in {"x86_64", "aarch64"}:
        pytest.skip("this system has no filter of system calls")
    program = "import ctypes; print(ctypes.CDLL(None).shmget(0, 4096, 0o1600))"
    assert run_python(student, program).stdout == b"-1\n"


@pytest.mark.skipif(not Path("/bin/ps").exists(), reason="needs ps")
def test_limits_hold_on_systems_other_than_linux(student: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    start = "from {module} import main"
    monkeypatch.setattr(
        run, "_SUPERVISOR_CODE", run._SUPERVISOR_CODE.replace(start, f"sys.platform = 'darwin'; {start}")
    )
    outcome = run_python(student, attacks.ENDLESS_LOOP, limits=Limits(seconds=60, cpu_seconds=0.5))
    assert outcome.exceeded is Exceeded.CPU_SECONDS
    assert outcome.protections == {Protection.LIMITS}
    assert run_python(student, "print('fine')").stdout == b"fine\n"


def test_all_limits_and_protections_have_texts() -> None:
    assert set(PROTECTIONS) == set(Protection)
    sentences = [str(describe_exceeded(exceeded, LIMITS)) for exceeded in Exceeded]
    assert len(set(sentences)) == len(Exceeded)
    assert sentences[0] == "the program did not end within 60 s"
