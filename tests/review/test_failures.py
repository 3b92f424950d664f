"""An exception in a comparison costs one file, and the rest of the report stands."""

from __future__ import annotations

import json
import re

import pytest

from linkwright.cli import main
from linkwright.review.files import interfaces
from linkwright.review.parts import comparing as parts
from linkwright.review.reports import as_data, as_diagnostics, as_text
from linkwright.review.robots import descriptions
from linkwright.review.sources import changed_sources
from tests.repositories import ARM, MACRO
from tests.review.conftest import breaking, sentences, subject

PLACE = r"KeyError: 'broken' in "


@pytest.fixture
def two_messages(package):
    package.commit({f"arm_description/msg/{name}.msg": "int32 speed\n" for name in ("Broken", "Good")})
    package.write({f"arm_description/msg/{name}.msg": "int64 speed\n" for name in ("Broken", "Good")})
    return package


def fail_for(function, name):
    """Return a function that raises an exception for files with a name."""

    def run(*arguments):
        if any(name in str(argument) for argument in arguments):
            raise KeyError("broken")
        return function(*arguments)

    return run


@pytest.fixture
def broken_reader(monkeypatch):
    monkeypatch.setattr(interfaces, "read_structures", fail_for(interfaces.read_structures, "Broken.msg"))


@pytest.mark.usefixtures("broken_reader")
def test_a_bug_in_a_reader_costs_one_file(two_messages, compare):
    result = compare(two_messages)
    assert breaking(result) == ["field 'speed': int32 -> int64"]
    (problem,) = subject(result, "arm_description/msg/Broken.msg").problems
    text = str(problem.text)
    assert "bug in Linkwright; please report this line" in text
    assert "KeyError: 'broken' in" in text
    assert str(two_messages.root) not in text


@pytest.mark.usefixtures("broken_reader")
def test_a_bug_is_in_every_form_of_the_report(two_messages, compare):
    result = compare(two_messages)
    assert as_text(result).count("  ? not compared because of a bug in Linkwright") == 1
    complete = {item["path"].rpartition("/")[2]: item["is_complete"] for item in as_data(result)["subjects"]}
    assert complete == {"Broken.msg": False, "Good.msg": True}
    (failed,) = [finding for finding in as_diagnostics(result) if finding.code == "REV202"]
    assert failed.span.file == "arm_description/msg/Broken.msg"


@pytest.mark.usefixtures("broken_reader")
def test_a_bug_does_not_change_the_exit_status(two_messages, capsys, tmp_path):
    sarif = tmp_path / "report.sarif"
    words = ["review", "HEAD", "--repository", str(two_messages.root), "--workers", "1", "--sarif", str(sarif)]
    assert main(words) == 0
    output = capsys.readouterr()
    assert "Traceback" not in output.out + output.err
    assert {run["ruleId"] for run in json.loads(sarif.read_text())["runs"][0]["results"]} == {"REV201", "REV202"}
    assert main([*words, "--fail-on", "problems"]) == 1


def test_a_bug_in_an_added_file_costs_one_file(package, compare, monkeypatch):
    monkeypatch.setattr(interfaces, "read_structures", fail_for(interfaces.read_structures, "Broken.msg"))
    package.write({f"arm_description/msg/{name}.msg": "int64 speed\n" for name in ("Broken", "Good")})
    result = compare(package)
    assert sentences(subject(result, "arm_description/msg/Broken.msg")) == ["interface added"]
    assert subject(result, "arm_description/msg/Broken.msg").problems
    assert sentences(subject(result, "arm_description/msg/Good.msg")) == ["interface added: int64 speed"]


def test_a_bug_in_the_reader_of_sources_costs_one_file(package, compare, monkeypatch):
    source = 'import rclpy\nnode = rclpy.create_node("talker")\nnode.create_publisher(String, "{}", 10)\n'
    files = [f"arm_description/src/{name}.py" for name in ("broken", "good")]
    package.commit({path: source.format("chatter") for path in files})
    package.write({files[0]: source.format("talk"), files[1]: source.format("speech")})
    broken = fail_for(changed_sources.read_source_names, "broken.py")
    monkeypatch.setattr(changed_sources, "read_source_names", broken)
    result = compare(package)
    assert [str(problem.text)[:12] for problem in subject(result, files[0]).problems] == ["not compared"]
    assert any("'speech'" in sentence for sentence in sentences(subject(result, files[1])))


def test_a_bug_in_the_comparison_of_a_part_costs_one_file(package, compare, monkeypatch):
    path = "arm_description/urdf/arm.urdf.xacro"
    package.write({path: ARM.replace('name="probe"', 'name="tip"'), "arm_description/msg/Good.msg": "int64 speed\n"})
    monkeypatch.setattr(parts, "read_outline", fail_for(parts.read_outline, "arm.urdf"))
    result = compare(package)
    assert sentences(subject(result, "arm_description/msg/Good.msg")) == ["interface added: int64 speed"]
    assert [problem.is_bug for problem in subject(result, path).problems] == [True]


def test_a_bug_in_a_rule_of_the_check_costs_the_findings_of_one_file(package, compare, monkeypatch):
    from linkwright.lint import engine

    good, bad = "arm_description/urdf/good.urdf", "arm_description/urdf/bad.urdf"
    robot = '<robot name="{}"><link name="base"/></robot>\n'
    joint = '<joint name="j" type="fixed"><parent link="base"/><child link="none"/></joint></robot>'
    package.commit({good: robot.format("good"), bad: robot.format("bad")})
    package.write({path: robot.format(path[21:-5]).replace("</robot>", joint) for path in (good, bad)})
    examine = engine.examine_description

    def fail(path, **options):
        if str(path).endswith("bad.urdf"):
            raise KeyError("broken")
        return examine(path, **options)

    monkeypatch.setattr(engine, "examine_description", fail)
    result = compare(package)
    assert {finding.span.file for finding in result.new_findings} == {good}
    assert any("new and fixed findings are missing" in str(problem.text) for problem in subject(result, bad).problems)


def test_a_bug_that_no_single_file_causes_is_a_note(two_messages, compare, monkeypatch):
    from linkwright.review import reviewing

    def fail(_versions, files):
        if len(files) > 1:
            raise KeyError("broken")
        yield from ()

    monkeypatch.setattr(reviewing, "SEARCHES", (fail,))
    result = compare(two_messages)
    assert len(breaking(result)) == 2
    assert any("a part of the review is missing" in str(note) for note in result.notes)


@pytest.mark.parametrize(
    ("path", "text", "reason"),
    [
        ("arm_description/urdf/broken.urdf", "<robot name='a'><link name='x'></robot>", "'</robot>' does not close"),
        ("arm_description/worlds/broken.sdf", "<sdf version='1.9'><world name='w'></sdf>", "'</sdf>' does not close"),
        ("arm_description/launch/broken.launch.py", "def generate_launch_description(:", "line 1 is not valid Python"),
        ("arm_description/launch/broken.launch.xml", "<launch><node pkg='a'></launch>", "'</launch>' does not close"),
        ("arm_description/launch/broken.launch.yaml", "launch: [a\n", "line 2 is not valid YAML: expected"),
        ("arm_description/config/broken.yaml", "a: 'b\n", "line 2 is not valid YAML: found unexpected end"),
    ],
)
def test_added_file_that_cannot_be_read_says_so(package, compare, path, text, reason):
    package.commit({path: text})
    (problem,) = subject(compare(package, "HEAD~1..HEAD"), path).problems
    assert str(problem.text).startswith(f"the file cannot be read: {reason}")


def test_a_bug_in_collisions_leaves_the_changes_of_the_robot(package, compare, monkeypatch):
    def fail(*_arguments):
        raise KeyError("broken")

    monkeypatch.setattr(descriptions, "compare_collisions", fail)
    package.write({"arm_description/urdf/segment.xacro": MACRO.replace("length:=0.5", "length:=0.6")})
    robot = subject(compare(package), "arm_description/urdf/arm.urdf.xacro")
    assert "joint 'upper_joint': origin xyz 0 0 0.5 -> 0 0 0.6 m (moved by 0.1 m)" in sentences(robot)
    (problem,) = robot.problems
    assert re.match(rf"a part of the comparison is missing: .*{PLACE}", str(problem.text))
