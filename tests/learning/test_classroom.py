"""A learner's progress through a course.

The tests cover files, checks, hints, solutions, and the stored progress.
"""

import importlib.util
import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.diagnostics import Diagnostic, LinkwrightError, Span, phrase
from linkwright.graph.parameters.files import read_parameter_file
from linkwright.learning.checks import check_process
from linkwright.learning.checks.check_process import check_in_process
from linkwright.learning.checks.findings import describe_finding
from linkwright.learning.classroom import open_classroom
from linkwright.learning.course import find_course, load_course
from linkwright.learning.lesson_tests import test_lesson as run_lesson_tests
from linkwright.process.forked import IS_POSSIBLE
from tests.waiting import TIMEOUT_S, wait_until

SOLUTION = "01-one-link/solution/one-link/robot.urdf"


@pytest.fixture
def workspace(tmp_path, monkeypatch):
    (tmp_path / "ws").mkdir()
    monkeypatch.chdir(tmp_path / "ws")
    return tmp_path / "ws"


def run_learn(capsys, *words):
    status = main(["learn", *words])
    output = capsys.readouterr()
    return status, output.out, output.err


def test_step_passes_when_work_is_done(workspace, capsys):
    status, out, _ = run_learn(capsys, "check", "--course", "example")
    assert status == 1
    assert "✗ The robot has the link box.\n      'ws' has no file 'robot.urdf'\n  ✗ It looks like" in out
    (workspace / "robot.urdf").write_text((find_course("example") / SOLUTION).read_text())
    status, out, _ = run_learn(capsys, "check", "--course", "example")
    assert (status, out.splitlines()[-1]) == (0, "passed; the next step is 01-one-link/mass")
    status, out, _ = run_learn(capsys, "answer", "mass", "25")
    assert status == 1
    assert "the area of a side" in out
    assert run_learn(capsys, "answer", "mass", "12.5")[0] == 0
    _, out, _ = run_learn(capsys, "list")
    assert out.count("✓") == 2


def test_hints_are_shown_in_order_and_solution_keeps_replaced_file(workspace, capsys):
    (workspace / "robot.urdf").write_text("mine")
    run_learn(capsys, "show", "--course", "example")
    assert "### How" not in run_learn(capsys, "hint")[1]
    assert "### How" in run_learn(capsys, "hint")[1]
    status, out, _ = run_learn(capsys, "solution")
    assert (status, out) == (0, "robot.urdf\n")
    (backup,) = (workspace / "replaced").rglob("robot.urdf")
    assert backup.read_text() == "mine"
    assert (workspace / "replaced" / "COLCON_IGNORE").is_file()  # colcon must ignore the copy of a package
    text = (workspace / "learn.yaml").read_text()
    assert "hints: 2" in text
    assert "solution: true" in text


def test_solution_of_number_step_is_the_number(workspace, capsys, tmp_path):
    status, out, _ = run_learn(capsys, "solution", "mass", "--course", "example")
    assert (status, out) == (0, "the answer is 12.5 kg\n")
    assert "solution: true" in (workspace / "learn.yaml").read_text()
    run_learn(capsys, "new", str(tmp_path / "mine"))
    (tmp_path / "mine/01-one-link/solution/mass.answer").unlink()
    status, _, err = run_learn(
        capsys, "solution", "mass", "--course", str(tmp_path / "mine"), "-C", str(tmp_path / "other")
    )
    assert (status, "LEARN113" in err) == (1, True)


@pytest.fixture
def grown_course(tmp_path, long_course):
    """Return the same course, in which each step writes a file.

    Lesson b writes another one at its start.
    """
    for step in ("a/one", "a/two", "b/one"):
        lesson, name = step.split("/")
        folder = tmp_path / "long" / lesson / "solution" / name
        folder.mkdir(parents=True)
        (folder / f"{lesson}-{name}.txt").write_text(step)
        (folder / "all.txt").write_text(step)
    return long_course


def test_catch_up_takes_over_earlier_steps(workspace, capsys, grown_course):
    (workspace / "all.txt").write_text("mine")
    run_learn(capsys, "check", "a/one", "--course", grown_course)
    before = (workspace / "learn.yaml").read_text()
    status, out, err = run_learn(capsys, "catch-up", "b/two")
    assert (status, out) == (1, "new: a-one.txt\nnew: a-two.txt\nnew: b-one.txt\nreplaced: all.txt\n")
    assert "nothing was written" in err
    assert [path.name for path in sorted(workspace.iterdir())] == ["all.txt", "learn.yaml"]
    assert (workspace / "learn.yaml").read_text() == before

    assert run_learn(capsys, "catch-up", "b/two", "--yes")[0] == 0
    assert (workspace / "all.txt").read_text() == "b/one"
    (backup,) = (workspace / "replaced").rglob("all.txt")
    assert backup.read_text() == "mine"
    _, out, _ = run_learn(capsys, "list")
    assert "  ✓ one: One\n  → two: Two\n\nb: L\n  → one: One\n    two: Two\n" in out
    assert "solution copied from the course" in out
    status, out, err = run_learn(capsys, "catch-up", "b/two")
    assert (status, out, "nothing to write" in err) == (1, "", True)


def test_files_replaced_twice_in_one_second_are_both_kept(workspace, capsys, grown_course):
    for text in ("first", "second"):
        (workspace / "all.txt").write_text(text)
        assert run_learn(capsys, "catch-up", "b/two", "--course", grown_course, "--yes")[0] == 0
    backups = {path.read_text() for path in (workspace / "replaced").rglob("all.txt")}
    assert backups == {"first", "second"}


def test_failed_check_names_unfinished_earlier_steps(workspace, capsys, grown_course, tmp_path):
    checks = tmp_path / "long" / "b" / "checks.py"
    checks.write_text(checks.read_text().replace("pass", "work.package('x')"))
    status, out, _ = run_learn(capsys, "check", "b/one", "--course", grown_course)
    assert (status, out.splitlines()[-1]) == (
        1,
        "unfinished steps before this one: 2; `linkwright learn catch-up b/one` copies their solutions from the course",
    )
    run_learn(capsys, "catch-up", "b/one", "--yes")
    assert "catch-up" not in run_learn(capsys, "check", "b/one")[1]


def test_json_result_has_all_languages(workspace, capsys):
    _, out, _ = run_learn(capsys, "check", "one-link", "--course", "example", "--json")
    result = json.loads(out)
    assert result["passed"] is False
    assert result["checks"][0]["title"]["zh"] == "机器人有名为 box 的连杆。"
    assert "没有文件" in result["checks"][0]["message"]["zh"]


def test_malformed_progress_file_is_rejected_and_kept(workspace, capsys):
    for text in ("a: [", "course: example\nsteps: {a: {nonsense: 1}}", "3", "course: example\nsteps: {a: {passed: 3}}"):
        (workspace / "learn.yaml").write_text(text)
        status, _, err = run_learn(capsys, "check", "one-link")
        assert status == 1
        assert "LEARN110" in err
        assert (workspace / "learn.yaml").read_text() == text


@pytest.fixture
def long_course(tmp_path):
    """Return a course with the steps a/one, a/two, b/one and b/two, whose checks all pass."""
    folder = tmp_path / "long"
    for lesson in ("a", "b"):
        (folder / lesson).mkdir(parents=True)
        (folder / lesson / "lesson.toml").write_text('title.en = "L"')
        (folder / lesson / "lesson.en.md").write_text("# L\n\n## One {#one}\n\n1\n\n## Two {#two}\n\n2\n")
        checks = [f'@check("{step}", en="It is so.")\ndef {step}(work):\n    pass\n' for step in ("one", "two")]
        (folder / lesson / "checks.py").write_text("from linkwright.learning import check\n\n" + "\n".join(checks))
    (folder / "course.toml").write_text('lessons = ["a", "b"]\ntitle.en = "C"')
    return str(folder)


def test_course_continues_after_last_started_or_passed_step(workspace, capsys, long_course):
    run_learn(capsys, "show", "b/one", "--course", long_course)
    status, out, _ = run_learn(capsys, "check")
    assert (status, out.splitlines()[0], out.splitlines()[-1]) == (0, "b/one: One", "passed; the next step is b/two")
    _, out, _ = run_learn(capsys, "check")
    assert (out.splitlines()[0], out.splitlines()[-1]) == ("b/two: Two", "passed; the next step is a/one")


def test_course_continues_in_earlier_lesson_that_was_opened_last(workspace, capsys, long_course):
    (workspace / "learn.yaml").write_text(
        f"course: {long_course}\nsteps:\n"
        "  b/one: {started: 2026-11-01 10:00:00+00:00, passed: 2026-11-01 10:10:00+00:00}\n"
        "  a/one: {started: 2026-11-02 10:00:00+00:00, passed: 2026-11-02 10:10:00+00:00}\n"
    )
    assert run_learn(capsys, "show")[1].startswith("## Two")
    assert "a/two" in (workspace / "learn.yaml").read_text()


def test_workspace_belongs_to_one_course(workspace, capsys):
    run_learn(capsys, "show", "--course", "example")
    status, _, err = run_learn(capsys, "list", "--course", "robot")
    assert status == 1
    assert "LEARN114" in err
    assert run_learn(capsys, "list", "--course", "example")[0] == 0


def test_new_course_passes_its_tests_and_never_overwrites_files(tmp_path, capsys):
    folder = tmp_path / "mine"
    assert run_learn(capsys, "new", str(folder))[0] == 0
    status, out, err = run_learn(capsys, "test", str(folder))
    assert (status, "FAIL" in out) == (0, False), out
    assert "0 failed" in err
    status, _, err = run_learn(capsys, "new", str(folder))
    assert status == 1
    assert "LEARN115" in err


def replace_in_file(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


@pytest.mark.parametrize(
    ("file", "old", "new", "problem"),
    [
        ("checks.py", "(0.5, 0.5, 0.5)", "(0.5, 0.5, 0.7)", "the checks reject a correct solution"),
        ("checks.py", "def has_box", "def has_box(work): pass\ndef unused", "without its solution"),
        ("checks.py", 'check("mass"', 'check("weight"', "no step 'weight'"),
        ("cases.py", "says=\"there is 'bax'\"", 'says="nothing"', "does not contain 'nothing'"),
        ("cases.py", "0.5 0.5 0.05", "0.5 0.5 0.50", "the checks accept a wrong solution"),
        ("lesson.zh.md", "# 一个连杆\n", "# 一个连杆\n\n![x](images/x.png)\n", "'images/x.png' is missing"),
    ],
)
def test_lesson_tests_report_mistakes(tmp_path, capsys, check_server, file, old, new, problem):
    folder = tmp_path / "mine"
    run_learn(capsys, "new", str(folder))
    replace_in_file(folder / "01-one-link" / file, old, new)
    if problem == "without its solution":
        replace_in_file(folder / "01-one-link" / "checks.py", "def is_cube(work):", "def is_cube(work):\n    return")
    course = load_course(folder)
    results = run_lesson_tests(course, course.lessons[0], check_server)
    problems = [str(result.problem) for result in results if result.problem]
    assert any(problem in text for text in problems), problems


@pytest.fixture(params=["forked", "fresh"])
def optional_server(request, check_server):
    if request.param == "forked" and not IS_POSSIBLE:
        pytest.skip("programs are forked on Linux only")
    return check_server if request.param == "forked" else None


def test_hanging_or_crashing_check_fails_and_leaves_no_process(tmp_path, capsys, optional_server):
    folder = tmp_path / "mine"
    run_learn(capsys, "new", str(folder))
    checks = folder / "01-one-link" / "checks.py"
    marker = tmp_path / "pid"
    start = (
        "import os, subprocess, sys, time\n"
        f"child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(60)'])\n"
        f"open({str(marker)!r}, 'w').write(str(child.pid))\n"
    )
    step = load_course(folder).steps[0]
    checks.write_text(start + "while True: time.sleep(1)\n")
    check_in_process(step, tmp_path, time_limit=3.0, server=optional_server)  # the server may take long to start
    result = check_in_process(step, tmp_path, time_limit=3.0, server=optional_server)
    assert "took longer than 3 s" in str(result.checks[0].message)
    if sys.platform != "win32":
        wait_until(lambda: not is_running(int(marker.read_text())), TIMEOUT_S)
    checks.write_text("import os\nos._exit(7)\n")
    result = check_in_process(step, tmp_path, server=optional_server)
    assert "ended early" in str(result.checks[0].message)
    checks.write_text("import os, sys\nprint('a' * 10**6, '\\nthe last line', file=sys.stderr)\nos._exit(7)\n")
    result = check_in_process(step, tmp_path, server=optional_server)
    assert "ended early: the last line" in str(result.checks[0].message)
    checks.write_text("1 / 0\n")
    result = check_in_process(step, tmp_path, server=optional_server)
    assert "ZeroDivisionError" in str(result.checks[0].message)


def test_checks_have_separate_domain_folder_environment_and_seed(tmp_path, capsys, optional_server, monkeypatch):
    folder = tmp_path / "mine"
    run_learn(capsys, "new", str(folder))
    (folder / "01-one-link" / "checks.py").write_text(
        "import json, os, time\nimport numpy\nfrom linkwright.learning import NotYet, check\n\n"
        '@check("mass", en="It is said.", zh="说。")\n'
        "def tell(work):\n"
        "    names = 'ROS_DOMAIN_ID', 'A_WORD'\n"
        "    facts = [*map(os.environ.get, names), os.getcwd(), os.getpid(), os.getsid(0), numpy.random.rand()]\n"
        "    (work.folder / str(os.getpid())).write_text(json.dumps(facts))\n"
        "    while len(list(work.folder.iterdir())) < 3:\n"
        "        time.sleep(0.01)\n"
    )
    step = load_course(folder).find_step("mass")
    workspace = tmp_path / "ws"
    workspace.mkdir()
    monkeypatch.setenv("A_WORD", "here")
    with ThreadPoolExecutor(3) as pool:
        results = [pool.submit(check_in_process, step, workspace, server=optional_server) for _ in range(3)]
    assert all(result.result().passed for result in results)
    facts = [json.loads(path.read_text()) for path in workspace.iterdir()]
    domains, words, folders, pids, sessions, numbers = zip(*facts, strict=True)
    assert len({*domains, os.environ["ROS_DOMAIN_ID"]}) == 4
    assert set(words) == {"here"}
    assert set(folders) == {str(workspace)}
    assert pids == sessions
    assert len(set(numbers)) == 3


@pytest.mark.parametrize(
    ("text", "expected_text"),
    [
        ("x: 1\n", "robot.yaml, line 1, column 4: "),
        ("a:\n\tx: 1\n", "robot.yaml, line 2, column 1: "),
    ],
)
def test_finding_in_file_has_location_code_and_hint(tmp_path, capsys, text, expected_text):
    folder = tmp_path / "mine"
    run_learn(capsys, "new", str(folder))
    (folder / "01-one-link" / "checks.py").write_text(
        "from linkwright.graph.parameters.files import read_parameter_file\nfrom linkwright.learning import check\n\n"
        '@check("mass", en="It can be read.", zh="可以读取。")\n'
        "def can_be_read(work):\n    read_parameter_file(work.folder / 'robot.yaml')\n"
    )
    (tmp_path / "robot.yaml").write_text(text)
    (result,) = check_in_process(load_course(folder).find_step("mass"), tmp_path).checks
    with pytest.raises(LinkwrightError) as raised:
        read_parameter_file(tmp_path / "robot.yaml")
    finding = raised.value.diagnostics[0]
    message = str(result.message)
    assert message.startswith(expected_text)
    assert f"{finding.message} [{finding.code}]" in message
    assert finding.hint is None or message.endswith(f"; {finding.hint}")
    assert re.match(r"robot\.yaml 第 \d+ 行第 \d+ 列：", result.message.get("zh"))


def test_finding_text_omits_missing_location():
    finding = Diagnostic("LEARN102", phrase("there is no '{name}'", name="x"))
    assert describe_finding(finding) == "there is no 'x' [LEARN102]"
    assert describe_finding(finding, "a.launch.py") == "a.launch.py: there is no 'x' [LEARN102]"
    line = finding.with_changes(span=Span("/ws/a.yaml", 3, 1, 3, 1), hint=phrase("list them"))
    assert describe_finding(line) == "a.yaml, line 3: there is no 'x' [LEARN102]; list them"


def is_running(pid: int) -> bool:
    state = subprocess.run(["ps", "-o", "stat=", "-p", str(pid)], capture_output=True, text=True, check=False).stdout
    return bool(state.strip()) and not state.startswith("Z")


def test_unwritable_workspace_is_one_error(tmp_path, monkeypatch):
    classroom = open_classroom(tmp_path / "file" / "ws", "example")
    (tmp_path / "file").write_text("")
    with pytest.raises(LinkwrightError) as raised:
        classroom.open_step(classroom.course.steps[0])
    assert raised.value.diagnostics[0].code == "LEARN111"


def test_modules_imported_by_check_server_exist():
    names = [name.removesuffix(".*").partition(":") for name in check_process._PRELOADED_MODULES]
    assert [name for name, _, _ in names if importlib.util.find_spec(name) is None] == []
    functions = [(name, function) for name, _, function in names if function]
    assert [name for name, function in functions if not hasattr(importlib.import_module(name), function)] == []
