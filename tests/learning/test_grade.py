"""Grading a class: marks, limits, malicious students, odd folders, and the formats."""

import csv
import errno
import json
import os
import pickle
import shutil
import signal
import subprocess
import sys
from contextlib import nullcontext
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.learning.checks import check_process
from linkwright.learning.course import find_course
from linkwright.learning.grading import class_grading, workers
from linkwright.learning.grading import jobs as grading_jobs
from linkwright.sweep.ray_cluster import LostTask
from tests.learning.sandbox.conftest import class_folder, processes_with  # noqa: F401
from tests.waiting import TIMEOUT_S, wait_until

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="the sandbox needs Linux")

ENDLESS = "while True: pass"
FORK_BOMB = "import os, time\nwhile True:\n    try:\n        os.fork()\n    except OSError:\n        time.sleep(0.01)"
LARGE_FILE = "with open('big', 'wb') as file:\n    while True: file.write(bytes(1 << 20))"
KILLING_PROGRAM = "import os, signal\nos.kill(-1, signal.SIGKILL)"
SPYING_PROGRAM = """
import pathlib, sys
for path in pathlib.Path({folder!r}).glob('good*/program.py'):
    pathlib.Path('program.py').write_text(path.read_text())
    path.write_text('')
pathlib.Path('result').write_text('42')
"""
LIMITS = ["--seconds", "60", "--cpu-seconds", "3", "--memory", "256", "--disk", "8", "--processes", "40"]


@pytest.fixture
def folder(class_folder, monkeypatch):  # noqa: F811
    """Return a class with a course whose check runs the student's program."""
    lesson = class_folder / "course" / "01-program"
    lesson.mkdir(parents=True)
    (class_folder / "course/course.toml").write_text('lessons = ["01-program"]\ntitle.en = "A program"\n')
    (lesson / "lesson.toml").write_text('title.en = "A program"\n[points]\nrun = 3\n')
    (lesson / "lesson.en.md").write_text("# A program\n\n## Run {#run}\n\nWrite it.\n\n## Read {#read}\n\nWrite it.\n")
    (lesson / "checks.py").write_text(
        "import subprocess, sys\n"
        "from linkwright.learning.checks.declarations import check\n"
        "from linkwright.learning.checks.not_yet import NotYet\n"
        "@check('run', en='It writes 42.')\n"
        "def run(work):\n"
        "    source = (work.folder / 'program.py').read_text()\n"
        "    result = subprocess.run([sys.executable, 'program.py'], cwd=work.folder, capture_output=True)\n"
        "    if result.stdout != b'42\\n' or 'print' not in source:\n"
        "        raise NotYet(en='the program does not print 42')\n"
        "@check('read', en='There is a program.')\n"
        "def read(work):\n"
        "    (work.folder / 'program.py').read_text()\n"
    )
    students = class_folder / "students"
    students.mkdir()
    monkeypatch.chdir(class_folder)
    # Without coverage, whose settings are not readable in the sandbox.
    monkeypatch.setattr(check_process, "PYTHON", [sys.executable])
    return class_folder


def write_student(folder, name, program):
    place = folder / "students" / name
    place.mkdir()
    (place / "program.py").write_text(program)
    (place / "learn.yaml").write_text("course: course\nsteps:\n  01-program/run: {hints: 2, solution: true}\n")
    return place


def grade_folder(folder, *words):
    folders = sorted(map(str, (folder / "students").iterdir()))
    status = main(["learn", "grade", "--course", str(folder / "course"), "--json", "out.json", *words, *folders])
    data = json.loads((folder / "out.json").read_text())
    return status, {student["student"]: student for student in data["students"]}, data


def test_malicious_students_affect_only_themselves(folder):
    for number in range(8):
        write_student(folder, f"good{number}", "print(42)")
    attacks = [ENDLESS, FORK_BOMB, LARGE_FILE, KILLING_PROGRAM, SPYING_PROGRAM.format(folder=str(folder / "students"))]
    for number, attack in enumerate(attacks):
        write_student(folder, f"malicious{number}", attack)
    status, students, data = grade_folder(folder, *LIMITS)
    assert status == 0
    assert [students[f"good{number}"]["points"] for number in range(8)] == [4] * 8
    assert [students[f"malicious{number}"]["points"] for number in range(5)] == [1] * 5
    reasons = [students[f"malicious{number}"]["steps"][0]["reason"] for number in range(3)]
    assert reasons[0]["en"] == "the program used more than 3 s of processor time"
    assert "limits" in data["protections"]
    assert all((folder / f"students/good{number}/program.py").read_text() == "print(42)" for number in range(8))
    wait_until(lambda: not processes_with("linkwright_grade_"), TIMEOUT_S)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL, signal.SIGHUP])
def test_runs_end_with_grader(folder, number):
    write_student(folder, "endless", ENDLESS)
    words = ["learn", "grade", "--course", "course", "--cpu-seconds", "300", "students/endless"]
    grader = subprocess.Popen([sys.executable, "-m", "linkwright", *words], cwd=folder, start_new_session=True)
    wait_until(lambda: processes_with("program.py"), TIMEOUT_S)
    grader.send_signal(number)
    assert grader.wait(TIMEOUT_S) != 0
    wait_until(lambda: not processes_with("program.py") and not processes_with("linkwright_grade_"), TIMEOUT_S)


def test_grade_report_has_points_claims_and_all_formats(folder):
    write_student(folder, "=odd, name", "print(41)")
    words = ["--csv", "out.csv", "--nbgrader", "nb.csv", "--html", "out.html"]
    status, students, _ = grade_folder(folder, *words)
    assert status == 0
    step = students["=odd, name"]["steps"][0]
    assert (step["points"], step["max_points"], step["claims"]["hints"], step["claims"]["solution"]) == (0, 3, 2, True)
    tests = students["=odd, name"]["autograding"]["tests"]
    assert [(test["status"], test["score"]) for test in tests] == [("fail", 0), ("pass", 1)]
    (line,) = csv.DictReader(Path("out.csv").read_text(encoding="utf-8").splitlines())
    assert (line["username"], line["points"], line["max_points"]) == ("'=odd, name", "1", "4")
    assert line["feedback"] == "01-program/run: the program does not print 42"
    (line,) = csv.DictReader(Path("nb.csv").read_text(encoding="utf-8").splitlines())
    assert (line["assignment"], line["score"], line["max_score"]) == ("01-program", "1", "4")
    page = Path("out.html").read_text(encoding="utf-8")
    assert "=odd, name" in page
    assert 'lang="zh"' in page
    assert '</summary><div id="student-0">' in page  # a link to an element in `details` opens it
    assert '<span lang="en">2 hints</span>' in page
    assert not list(folder.glob("*.unfinished"))


class FakeCluster:
    """A cluster whose processes are this one, and that loses the first task."""

    def __init__(self):
        self.calls = 0

    def share(self, value):
        return pickle.loads(pickle.dumps(value))

    def run_tasks(self, function, tasks):
        for index, arguments in enumerate(tasks):
            self.calls += 1
            yield index, LostTask("lost") if self.calls == 1 else function(*self.share(arguments))


def test_cluster_receives_folders_and_lost_check_is_repeated(folder, monkeypatch):
    write_student(folder, "good", "print(42)")
    tool = write_student(folder, "bad", "print(41)") / "empty/tool.sh"
    tool.parent.mkdir()
    tool.touch(mode=0o755)
    cluster = FakeCluster()
    monkeypatch.setattr(workers, "connect_to_ray", lambda address: nullcontext(cluster))
    status, students, _ = grade_folder(folder, "--ray", "auto")
    assert status == 0
    assert {name: student["points"] for name, student in students.items()} == {"good": 4, "bad": 1}
    assert cluster.calls > 4
    assert students["bad"]["steps"][0]["repeated"]
    content = workers.read_folder(tool.parent.parent)
    workers.write_folder(folder / "received", content)
    assert workers.read_folder(folder / "received") == content
    assert os.access(folder / "received/empty/tool.sh", os.X_OK)


def test_error_of_cluster_process_is_error_of_command(folder, monkeypatch, capsys):
    write_student(folder, "good", "print(42)")

    def refuse(*_, **__):
        raise LinkwrightError(Diagnostic("LEARN901", "no sandbox here"))

    monkeypatch.setattr(grading_jobs, "run_in_sandbox", refuse)
    monkeypatch.setattr(workers, "connect_to_ray", lambda address: nullcontext(FakeCluster()))
    assert main(["learn", "grade", "--course", "course", "--ray", "auto", "students/good"]) == 1
    assert "LEARN901" in capsys.readouterr().err


def test_error_of_one_run_leaves_other_students_graded(folder, monkeypatch):
    write_student(folder, "good", "print(42)")
    write_student(folder, "unlucky", "print(42)  # unlucky")
    run_in_sandbox = grading_jobs.run_in_sandbox

    def fail_for_one(words, **more):
        if "unlucky" in (more["folder"] / "workspace/program.py").read_text() and "run" in words:
            raise OSError(errno.ENOSPC, "No space left on device")
        return run_in_sandbox(words, **more)

    monkeypatch.setattr(grading_jobs, "run_in_sandbox", fail_for_one)
    monkeypatch.setattr(workers, "connect_to_ray", lambda address: nullcontext(FakeCluster()))
    status, students, _ = grade_folder(folder, "--ray", "auto", "--csv", "out.csv", "--nbgrader", "nb.csv")
    assert status == 1
    assert {name: (student["points"], student["graded"]) for name, student in students.items()} == {
        "good": (4, True),
        "unlucky": (1, False),
    }
    assert students["unlucky"]["steps"][0]["graded"] is False
    assert students["unlucky"]["autograding"]["tests"][0]["status"] == "error"
    lines = {line["username"]: line for line in csv.DictReader(Path("out.csv").read_text().splitlines())}
    assert (lines["good"]["points"], lines["unlucky"]["points"], lines["unlucky"]["01-program/read"]) == ("4", "", "1")
    assert lines["unlucky"]["feedback"].startswith("01-program/run: not graded")
    assert "No space left on device" in lines["unlucky"]["feedback"]
    scores = {line["student_id"]: line["score"] for line in csv.DictReader(Path("nb.csv").read_text().splitlines())}
    assert scores == {"good": "4", "unlucky": ""}
    assert Path("out.csv.unfinished").exists()
    monkeypatch.setattr(grading_jobs, "run_in_sandbox", run_in_sandbox)
    status, students, _ = grade_folder(folder, "--ray", "auto", "--csv", "out.csv")
    assert status == 0
    assert students["unlucky"]["points"] == 4
    assert not Path("out.csv.unfinished").exists()


MISSING_MODULE_TEXTS = {
    "raise ImportError('a mistake of the teacher')": "the file cannot be run",
    "import os; os._exit(3)": "the process of the checks ended with status 3",
}


@pytest.mark.parametrize("mistake", MISSING_MODULE_TEXTS)
def test_unloadable_checks_leave_students_ungraded(folder, mistake):
    write_student(folder, "good", "print(42)")
    (folder / "course/01-program/checks.py").write_text(mistake)
    status, students, _ = grade_folder(folder, "--html", "out.html")
    assert (status, students["good"]["graded"]) == (1, False)
    for step in students["good"]["steps"]:
        assert (step["graded"], step["repeated"]) == (False, True)
        message = step["reason"] or step["checks"][0]["message"]
        assert MISSING_MODULE_TEXTS[mistake] in message["en"]
    assert "not complete" in Path("out.html").read_text(encoding="utf-8")


def test_check_without_memory_or_library_is_not_graded(folder):
    write_student(folder, "good", "print(42)")
    checks = folder / "course/01-program/checks.py"
    missing = "raise ModuleNotFoundError('No module named mujoco', name='mujoco')"
    source = checks.read_text().replace("def run(work):\n", "def run(work):\n    raise MemoryError\n")
    source = source.replace("def read(work):\n", f"def read(work):\n    {missing}\n")
    checks.write_text(source)
    status, students, _ = grade_folder(folder)
    assert status == 1
    assert [step["graded"] for step in students["good"]["steps"]] == [False, False]


@pytest.mark.parametrize(
    ("words", "addresses"),
    [
        (["--lesson", "01-program"], ["01-program/run", "01-program/read"]),
        (["--step", "02-other/run", "--step", "read"], ["01-program/read", "02-other/run"]),
        (["--lesson", "02-other", "--step", "run"], ["02-other/run"]),
        (["--lesson", "02-other", "--lesson", "01-program", "--step", "read"], ["01-program/read"]),
    ],
)
def test_lessons_and_steps_are_selected(folder, words, addresses):
    add_lesson(folder)
    write_student(folder, "good", "print(42)")
    _, students, _ = grade_folder(folder, *words)
    assert [step["step"] for step in students["good"]["steps"]] == addresses


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--lesson", "02-other", "--step", "read"], "there is no step 'read' in '02-other'"),
        (["--lesson", "02-other", "--step", "01-program/run"], "there is no step '01-program/run' in '02-other'"),
        (["--step", "run"], "several lessons have a step 'run'"),
        (["--step", "reed"], "the course 'course' has no step 'reed'"),
    ],
)
def test_step_that_lesson_lacks_is_refused(folder, capsys, words, message):
    add_lesson(folder)
    student = write_student(folder, "good", "print(42)")
    assert main(["learn", "grade", "--course", str(folder / "course"), *words, str(student)]) == 1
    assert message in capsys.readouterr().err


def add_lesson(folder):
    """Add the lesson 02-other with the step run."""
    lesson = folder / "course" / "02-other"
    shutil.copytree(folder / "course" / "01-program", lesson)
    (lesson / "lesson.en.md").write_text("# Another\n\n## Run {#run}\n\nWrite it.\n")
    (folder / "course/course.toml").write_text('lessons = ["01-program", "02-other"]\ntitle.en = "Programs"\n')


def test_extras_of_lessons_are_required(folder, monkeypatch, capsys):
    write_student(folder, "good", "print(42)")
    lesson = folder / "course/01-program/lesson.toml"
    lesson.write_text('needs = ["sim"]\n' + lesson.read_text())
    monkeypatch.setattr(class_grading, "find_spec", lambda name: None)
    assert main(["learn", "grade", "--course", "course", "students/good"]) == 1
    assert "LEARN116" in capsys.readouterr().err


def test_marks_do_not_depend_on_the_umask(folder):
    write_student(folder, "good", "print(42)")
    (folder / "course/01-program/checks.py").chmod(0o600)
    before = os.umask(0o077)
    try:
        status, students, _ = grade_folder(folder)
    finally:
        os.umask(before)
    assert (status, students["good"]["points"]) == (0, 4)
    assert (folder / "out.json").stat().st_mode & 0o777 == 0o600


@pytest.mark.slow
@pytest.mark.extra("ray")
def test_malicious_students_on_cluster_affect_only_themselves(folder):
    for number in range(2):
        write_student(folder, f"good{number}", "print(42)")
    for number, attack in enumerate([KILLING_PROGRAM, SPYING_PROGRAM.format(folder=str(folder / "students"))]):
        write_student(folder, f"malicious{number}", attack)
    folders = sorted(map(str, (folder / "students").iterdir()))
    words = ["learn", "grade", "--course", "course", "--ray", "local", "--json", "out.json", *LIMITS, *folders]
    # Less than the time limit of a test, so that Ray reports a raylet that died.
    environment = {**os.environ, "RAY_raylet_start_wait_time_s": "240"}
    result = subprocess.run(
        [sys.executable, "-m", "linkwright", *words], env=environment, capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr
    data = json.loads((folder / "out.json").read_text())
    assert [student["points"] for student in data["students"]] == [4, 4, 1, 1]
    assert "limits" in data["protections"]


def test_unusual_folders_have_notes(folder, capsys):
    students = folder / "students"
    nested = write_student(folder, "nested", "print(42)")
    (nested / "inner").mkdir()
    for name in ("program.py", "learn.yaml"):
        (nested / name).rename(nested / "inner" / name)
    links = write_student(folder, "links", "print(42)")
    (links / "program.py").unlink()
    (links / "program.py").symlink_to(nested / "inner/program.py")
    os.mkfifo(links / "pipe")
    (write_student(folder, "other", "print(42)") / "learn.yaml").write_text("course: robot\n")
    bomb = "a: &a [x, x]\nb: &b [*a, *a]\ncourse: course\nsteps: {01-program/run: {answer: *b}}\n"
    (write_student(folder, "yaml", "print(42)") / "learn.yaml").write_text(bomb)
    (write_student(folder, "without", "print(42)") / "learn.yaml").unlink()
    (students / "file.txt").write_text("")
    (students / "file.zip").write_text("")
    (students / "packed").mkdir()
    (students / "packed/workspace.tar.gz").write_text("")
    status, report, _ = grade_folder(folder, "--html", "out.html")
    assert status == 1
    assert Path("out.html").read_text(encoding="utf-8").count("not graded") == 6
    notes = {name: " / ".join(note["en"] for note in student["notes"]) for name, student in report.items()}
    assert notes["nested"] == "the workspace is the folder 'inner' in it"
    assert notes["links"] == "1 link was left out / 1 pipe, socket or device was left out"
    assert notes["other"] == "learn.yaml belongs to the course 'robot' and was not used"
    assert "does not contain the progress" in notes["yaml"]
    assert notes["without"] == "there is no learn.yaml, so there are no answers"
    assert notes["file.txt"] == "it is a file, not a student's folder"
    assert notes["file.zip"] == "it is an archive; unpack it first"
    assert notes["packed"] == "the folder contains only the archive 'workspace.tar.gz'; unpack it first"
    points = {name: student["points"] for name, student in report.items()}
    not_graded = {"file.txt": 0, "file.zip": 0, "packed": 0}
    assert points == {"nested": 4, "links": 0, "other": 4, "yaml": 4, "without": 4, **not_graded}
    assert "unpack it first" in capsys.readouterr().out


def test_interrupted_grading_continues(folder, monkeypatch):
    for number in range(3):
        write_student(folder, f"good{number}", f"print(42)  # {number}")
    run_all = class_grading._run_all

    def interrupt(jobs, run_jobs):
        for count, item in enumerate(run_all(jobs, run_jobs)):
            if count == 4:
                raise KeyboardInterrupt
            yield item

    monkeypatch.setattr(class_grading, "_run_all", interrupt)
    assert main(["learn", "grade", "--course", "course", "--json", "out.json", "students/good0", "students/good1",
                 "students/good2"]) == 130  # fmt: skip
    counted = []
    monkeypatch.setattr(
        class_grading, "_run_all", lambda jobs, run_jobs: run_all(counted.extend(jobs) or jobs, run_jobs)
    )
    status, students, _ = grade_folder(folder)
    assert status == 0
    assert len(counted) == 2
    assert [student["points"] for student in students.values()] == [4] * 3
    assert not (folder / "out.json.unfinished").exists()


def test_output_files_are_checked_before_first_run(folder, capsys):
    write_student(folder, "good", "print(42)")
    assert main(["learn", "grade", "--course", "course", "--csv", "none/a.csv", "students/good"]) == 1
    assert "LEARN121" in capsys.readouterr().err
    assert main(["learn", "grade", "--course", "course", "--csv", "a", "--json", "a", "students/good"]) == 1
    assert "LEARN120" in capsys.readouterr().err


def test_answers_are_read_from_progress_of_student(folder):
    place = folder / "students" / "anna"
    place.mkdir()
    (place / "robot.urdf").write_text((find_course("example") / "01-one-link/solution/one-link/robot.urdf").read_text())
    (place / "learn.yaml").write_text("course: example\nsteps:\n  01-one-link/mass: {answer: 12.5}\n")
    assert main(["learn", "grade", "--course", "example", "--json", "out.json", str(place)]) == 0
    assert json.loads(Path("out.json").read_text())["students"][0]["points"] == 2
