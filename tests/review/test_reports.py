"""Reports.

Nothing of a repository becomes markup, and a change of a shared file is listed once.
"""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from linkwright.cli import main
from linkwright.diagnostics import Diagnostic, SourceText, phrase
from linkwright.review import Change, Effect, Review, Subject, SubjectKind
from linkwright.review.reports import as_data, as_diagnostics, as_html, as_markdown, as_text
from tests.repositories import ARM, MACRO

OTHER = (
    ARM.replace('name="arm"', 'name="other"')
    .replace('name="upper"', 'name="shoulder"')
    .replace('"upper"', '"shoulder"')
)
HOSTILE = "<img src=x onerror=alert(1)> @octocat #12 [link](http://x) `code` | *bold* &commat;octocat &lt;"


@pytest.fixture
def changed(package):
    """Return a repository whose last commit changes a macro of two robots.

    It also renames a link of one.
    """
    package.commit({"arm_description/urdf/other.urdf.xacro": OTHER})
    package.commit(
        {
            "arm_description/urdf/segment.xacro": MACRO.replace("length:=0.5", "length:=0.6"),
            "arm_description/urdf/arm.urdf.xacro": ARM.replace('name="lower"', 'name="forearm"'),
            "README.md": "An arm.",
        }
    )
    return package


def test_changes_of_a_shared_file_are_listed_once(changed, compare):
    result = compare(changed, "HEAD~1..HEAD")
    text = as_text(result)
    assert "joint 'upper_joint': origin xyz 0 0 0.5 -> 0 0 0.6 m (moved by 0.1 m); also 'middle_joint'" in text
    assert "shoulder_joint" not in text
    assert re.search(r"the same \d+ changes in shared files as in arm_description/urdf/arm.urdf.xacro", text)
    assert text.count("arm_description/urdf/segment.xacro:14:") == 1


LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package="arm", executable="drive", name="drive", remappings=[("cmd", "cmd_vel")]),
        Node(package="arm", executable="drive", name="drive", remappings=[("cmd", "cmd_vel")]),
    ])
"""


def test_equal_changes_of_several_files_are_listed_once(package, compare):
    names = [f"arm_description/launch/{name}.launch.py" for name in ("a", "b", "c", "d", "e", "f", "g")]
    package.commit(dict.fromkeys(names, LAUNCH))
    package.commit(dict.fromkeys(names[:6], LAUNCH.replace('"cmd_vel"', '"cmd_vel_nav"')) | {names[6]: "# nothing\n"})
    result = compare(package, "HEAD~1..HEAD")
    lines = as_text(result).splitlines()
    (line,) = [line for line in lines if "cmd_vel_nav" in line]
    assert line.endswith("(2 times)")
    paths = ", ".join(names[1:6])
    assert f"  = the same in 5 more files: {paths}" in lines
    assert [line for line in lines if line in names] == [names[0], names[6]]
    breaking = [change for _, change in result.breaking_changes if "cmd_vel_nav" in str(change.sentence)]
    assert len(breaking) == 12
    page, comment = as_html(result), as_markdown(result)
    assert re.search(rf"the same in 5 more files: .*{names[5]}", page)
    assert re.search(r"cmd&#95;vel&#95;nav.* and 2 more</code>", comment)
    for report in (page, comment):
        assert report.split("arm_description/launch/g", 1)[0].count("cmd_vel_nav") <= 2


def test_text_report_lists_twenty_other_files():
    result = Review("main", "topic", [], [f"src/{number}.cpp" for number in range(25)])
    text = as_text(result)
    assert "src/19.cpp\n  5 more files\n" in text
    assert "src/20.cpp" not in text


def test_reports_are_deterministic(changed, compare):
    first, second = (compare(changed, "HEAD~1..HEAD") for _ in range(2))
    for report in (as_text, as_markdown, as_html, as_data):
        assert report(first) == report(second)


def test_repository_names_are_escaped():
    change = Change(phrase("link '{name}' removed", name=HOSTILE))
    subject = Subject(SubjectKind.DESCRIPTION, f"urdf/{HOSTILE}.urdf", "a", "b", [change], cases=[HOSTILE])
    result = Review("main", HOSTILE, [subject], [HOSTILE], notes=[phrase("{path}", path=HOSTILE)])
    markdown, page = as_markdown(result), as_html(result)
    for text in (markdown, page):
        assert "<img" not in text
    assert "@octocat" not in markdown
    assert not re.search("(?<!&)#12", markdown)
    assert "[link]" not in markdown
    assert "`" not in markdown.replace("```", "")
    assert "&commat;" not in markdown
    assert "&lt;" not in markdown
    tags = _read_tags(page)
    assert "img" not in tags
    assert tags.count("script") == 1


def test_control_characters_in_names_are_replaced():
    name = "arm\n::error::\x1b[31m\u202e.urdf"
    result = Review("main", "HEAD", [Subject(SubjectKind.DESCRIPTION, name, None, name, [Change(phrase("added"))])])
    assert "arm\N{SYMBOL FOR NEWLINE}::error::" in as_text(result).splitlines()[0]
    for text in (as_text(result), as_markdown(result)):
        assert not re.search("^::|\x1b|\u202e", text, re.MULTILINE)


def test_long_review_is_truncated_to_comment_size():
    subjects = []
    for robot in range(30):
        changes = [
            Change(phrase("link '{name}' moved by {distance} m", name=f"link_{robot}_{number}", distance=number))
            for number in range(300)
        ]
        subjects.append(Subject(SubjectKind.DESCRIPTION, f"urdf/{robot}.urdf", "a", "b", changes))
    text = as_markdown(Review("main", "", subjects))
    assert len(text) < 65_536
    assert "do not fit into a comment" in text.splitlines()[-1]
    assert text.count("<details>") == text.count("</details>")


def test_html_report_is_self_contained(changed, compare):
    page = as_html(compare(changed, "HEAD~1..HEAD"))
    assert not re.search(r"""(src|href)=['"](?!data:)""", page)


def test_json_and_diagnostics_have_breaking_changes(changed, compare):
    result = compare(changed, "HEAD~1..HEAD")
    data = json.loads(json.dumps(as_data(result)))
    subject = next(item for item in data["subjects"] if item["path"] == "arm_description/urdf/arm.urdf.xacro")
    removed = next(change for change in subject["changes"] if change["is_breaking"])
    assert removed["text"] == "link 'lower' removed"
    assert removed["reason"] == "programs that look up the frame 'lower' do not find it"
    assert data["other_files"] == ["README.md"]
    codes = [finding.code for finding in as_diagnostics(result)]
    assert codes[: len(result.breaking_changes)] == ["REV201"] * len(result.breaking_changes)


def test_removed_part_has_no_line_in_new_version(changed, compare):
    result = compare(changed, "HEAD~1..HEAD")
    for subject, change in result.breaking_changes:
        if change.location is not None and change.location.is_old:
            comparison = replace(result, subjects=[replace(subject, changes=[change])], new_findings=[])
            assert as_diagnostics(comparison)[0].span is None


# --- the command ----------------------------------------------------------------------------------------------------


@pytest.fixture
def run(changed, monkeypatch, capsys):
    monkeypatch.chdir(changed.root)

    def command(*words: str) -> tuple[int, str, str]:
        status = main(["review", *words])
        return status, *capsys.readouterr()

    return command


def test_review_command_writes_all_reports(run, tmp_path):
    names = ("comment.md", "report.html", "report.json", "report.sarif")
    options = [f"--{name.rpartition('.')[2].replace('md', 'markdown')}={tmp_path / name}" for name in names]
    status, output, _ = run("HEAD~1..HEAD", *options)
    assert status == 0
    assert output.splitlines()[-1].startswith("2 breaking changes, ")
    comment = (tmp_path / "comment.md").read_text()
    assert comment.startswith("<!-- linkwright review -->\n### Robot review: HEAD&#126;1 to HEAD")
    assert (tmp_path / "report.html").read_text().startswith("<!doctype html>")
    sarif = json.loads((tmp_path / "report.sarif").read_text())
    assert "REV201" in {result["ruleId"] for result in sarif["runs"][0]["results"]}
    assert json.loads((tmp_path / "report.json").read_text())["old"] == "HEAD~1"


@pytest.mark.parametrize(
    ("conditions", "status"), [("breaking", 1), ("changes", 1), ("problems", 0), ("problems,breaking", 1)]
)
def test_fail_on_conditions_set_exit_status(run, conditions, status):
    assert run("HEAD~1..HEAD", "--fail-on", conditions)[0] == status


def test_commit_that_fixes_description_has_no_problem(run, changed):
    text = ARM.replace("</robot>", "${missing}</robot>")
    changed.commit({"arm_description/urdf/arm.urdf.xacro": text})
    changed.commit({"arm_description/urdf/arm.urdf.xacro": ARM})
    assert run("HEAD~2..HEAD~1", "--fail-on", "problems")[0] == 1
    assert run("HEAD~1..HEAD", "--fail-on", "problems")[0] == 0


def test_unknown_fail_on_condition_is_a_usage_error(run):
    status, _, errors = run("--fail-on", "anything")
    assert status == 2
    assert "'anything' is not one of breaking, findings, problems, changes" in errors


def test_first_argument_is_commit_or_package(run):
    assert run("HEAD~1", "arm_description")[1] == run("HEAD~1..HEAD", "arm_description")[1]
    status, output, _ = run("arm_description")
    assert (status, output) == (0, "nothing that a review compares changed from main to the working tree\n")


def test_github_annotations_are_printed(run):
    _, output, _ = run("HEAD~1..HEAD", "--github")
    assert output.startswith("::warning ")
    assert "title=REV201::" in output


def test_report_is_in_chinese_with_lang_zh(run):
    _, output, _ = run("HEAD~1..HEAD", "--lang", "zh")
    assert "删除连杆“lower”" in output


def test_error_is_printed_without_traceback(run):
    status, _, errors = run("nowhere..HEAD")
    assert status == 1
    assert "error[CLI343]" in errors
    assert "Traceback" not in errors


def _read_tags(page: str) -> list[str]:
    class Reader(HTMLParser):
        def handle_starttag(self, tag, attrs):
            tags.append(tag)

    tags: list[str] = []
    Reader().feed(page)
    return tags


def test_only_the_arguments_that_differ_are_named():
    change = Change(phrase("a change"), cases=("dof:=7 tool:=probe pose:=0 0 1",))
    cases = ["dof:=7 tool:=none pose:=0 0 1", "dof:=7 tool:=probe pose:=0 0 1"]
    subject = Subject(SubjectKind.DESCRIPTION, "a.urdf", "a.urdf", "a.urdf", [change], cases=cases)
    assert "a change (with tool:=probe)" in as_text(Review("a", "b", [subject]))


@pytest.mark.parametrize(
    ("names", "expected"), [("ab", ["'a' is odd", "'b' is odd"]), ("abc", ["'a' is odd; also 'b', 'c'"])]
)
def test_alike_findings_of_a_file_are_one_line(names, expected):
    span = SourceText("a.urdf", "x").span(0, 1)
    findings = [Diagnostic("URDF999", phrase("'{name}' is odd", name=name), span=span) for name in names]
    lines = as_text(Review("a", "b", new_findings=findings)).splitlines()
    assert lines[1:-2] == [f"  a.urdf:1: error[URDF999] {text}" for text in expected]


def test_equal_findings_at_several_lines_are_one_line():
    spans = [SourceText("a.urdf", "x\n" * 5).span(offset, offset + 1) for offset in (0, 2, 4)]
    findings = [Diagnostic("URDF999", phrase("wrong"), span=span) for span in spans]
    report = as_text(Review("a", "b", new_findings=[*findings, Diagnostic("URDF999", phrase("odd"), span=spans[0])]))
    lines = report.splitlines()
    assert lines[1:3] == ["  a.urdf:1: error[URDF999] wrong (3 times)", "  a.urdf:1: error[URDF999] odd"]
    assert "4 new findings" in lines[-1]


def test_file_with_breaking_changes_only_has_no_heading_of_its_own():
    change = Change(phrase("field removed"), Effect.BREAKING, phrase("programs fail"))
    report = as_markdown(Review("a", "b", [Subject(SubjectKind.INTERFACE, "a.msg", "a.msg", "a.msg", [change])]))
    assert report.count("a.msg") == 1
    assert "field removed" in report


@pytest.mark.parametrize(("count", "heading"), [(1, "file removed: value 0"), (40, "file removed:")])
def test_only_the_start_of_a_long_breaking_change_is_bold(count, heading):
    values = ", ".join(f"value {number}" for number in range(count))
    change = Change(phrase("file removed: {items}", items=values), Effect.BREAKING, phrase("programs fail"))
    result = Review("a", "b", [Subject(SubjectKind.INTERFACE, "a.msg", "a.msg", "a.msg", [change])])
    page = as_html(result)
    assert f"- **{heading}**" in as_markdown(result)
    assert page.count(f"<strong class='breaking'>{heading}</strong>") == 2
    assert page.count(f"value {count - 1}") == (2 if count == 1 else 1)  # the list at the top is short


def test_added_files_with_the_same_summary_are_not_the_same(package, compare):
    launch = "<launch><arg name='robot' default='{}'/><node pkg='a' type='b' name='c'/></launch>"
    package.commit({f"arm_description/launch/{name}.launch": launch.format(name) for name in ("left", "right")})
    lines = as_text(compare(package, "HEAD~1..HEAD")).splitlines()
    assert [line for line in lines if line.endswith(".launch")] == [
        "arm_description/launch/left.launch",
        "arm_description/launch/right.launch",
    ]
    assert not any("the same in" in line for line in lines)


@pytest.mark.parametrize("is_added", [True, False])
def test_added_and_removed_sources_are_marked(repository, compare, is_added):
    empty, source = {"a/a.txt": "", "a/run.py": None}, {"a/run.py": "import rospy\nrospy.init_node('run')\n"}
    repository.commit({"a/a.txt": "", **({} if is_added else source)})
    repository.write(source if is_added else empty)
    result = compare(repository)
    state = "added" if is_added else "removed"
    assert f"a/run.py ({state})\n" in as_text(result)
    assert f"<h2><code>a/run.py</code> ({state})</h2>" in as_html(result)
    if is_added:
        assert "#### <code>a/run.py</code> (added)\n" in as_markdown(result)


@pytest.mark.parametrize("new_name", ["", "f" * 40])
def test_title_of_the_page_and_of_the_comment_has_short_hashes(new_name):
    review = Review("0123456789" * 4 + "^", new_name)
    title = f"Robot review: 0123456789^ to {new_name[:10] or 'working tree'}"
    assert f"<h1>{title}</h1>" in as_html(review)
    assert f"### {title}\n" in as_markdown(review).replace("&#94;", "^")
