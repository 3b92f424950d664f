"""The action for GitHub and Gitea in an example repository.

The tests cover its files, its comment, and code that it does not run.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from linkwright.cli import main
from linkwright.review.reports.markdown import MARKER
from tests.ci.conftest import HOSTILE_BRANCH, Example
from tests.ci.runner import TEMPLATES, Runner
from tests.ci.service import TOKEN, Service
from tests.places import needs_page

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the scripts are for Linux and macOS")

FILES = ["comment.md", "pull-request.txt", "report.html", "report.json", "report.sarif"]
LINK = "\n[report.html](https://example.org/artifacts/8)\n"


@pytest.fixture
def expected(example: Example, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Return the comment that the command writes."""
    monkeypatch.chdir(example.repository.root)
    short = [example.repository.git("rev-parse", "--short", commit) for commit in (example.base, example.head)]
    assert main(["review", "...".join(short), "--markdown", str(tmp_path / "expected.md")]) == 0
    return (tmp_path / "expected.md").read_text(encoding="utf-8")


def test_report_is_posted_on_pull_request(example: Example, service: Service, runner: Runner, expected: str) -> None:
    run = runner.run("review", example.event())
    assert run.failed == ""
    assert service.bodies == [expected + LINK]
    assert "link 'lower' removed" in expected
    assert expected.startswith(MARKER)
    assert set(service.tokens) == {f"token {TOKEN}"}
    assert runner.summary.read_text(encoding="utf-8") == expected
    assert sorted(path.name for path in run.uploaded["linkwright-review"].iterdir()) == FILES
    assert "::warning title=REV201::link 'lower' removed" in run.output
    assert "::notice::the comment is posted" in run.output
    example.assert_nothing_ran()


def test_checkout_of_action_is_installed(example: Example, runner: Runner) -> None:
    run = runner.run("review", example.event())
    *options, folder = runner.installed.read_text(encoding="utf-8").splitlines()
    assert options == ["-I", "-m", "pip", "install", "--quiet", "--editable"]
    assert Path(folder).resolve() == TEMPLATES.parent.parent
    assert run.used[0] == ("actions/setup-python@v5", {"python-version": "3.13"})
    assert runner.without_page.read_text(encoding="utf-8") == "1\n"


@needs_page
@pytest.mark.parametrize("scenes", ["false", "true"])
def test_scenes_are_in_the_page_if_the_input_says_so(example: Example, runner: Runner, scenes: str) -> None:
    run = runner.run("review", example.event(), scenes=scenes)
    assert run.failed == ""
    page = (Path(run.outputs["folder"]) / "report.html").read_text(encoding="utf-8")
    assert ("<details class='scene'>" in page) == (scenes == "true")
    assert (runner.without_page.read_text(encoding="utf-8") == "\n") == (scenes == "true")


def test_second_run_edits_comment(example: Example, service: Service, runner: Runner) -> None:
    runner.run("review", example.event())
    head = example.repository.commit({"arm_description/urdf/more.urdf": '<robot name="more"><link name="a"/></robot>'})
    run = runner.run("review", Example(example.repository, example.base, head).event())
    assert "::notice::the comment is updated" in run.output
    assert len(service.comments) == 1
    assert "more.urdf" in service.bodies[0]
    assert service.writes == [
        "POST /repos/team/robots/issues/5/comments",
        "PATCH /repos/team/robots/issues/comments/100",
    ]


def test_unchanged_report_is_not_posted_again(example: Example, service: Service, runner: Runner) -> None:
    for _ in range(2):
        run = runner.run("review", example.event())
    assert "the comment is up to date" in run.output
    assert len(service.writes) == 1


def test_empty_report_posts_no_comment(example: Example, service: Service, runner: Runner) -> None:
    base = example.head
    head = example.repository.commit({"README.md": "An arm."})
    example_without_changes = Example(example.repository, base, head)
    run = runner.run("review", example_without_changes.event())
    assert "the review has nothing to say" in run.output
    assert service.comments == []
    service.add(f"{MARKER}\nan older report")
    runner.run("review", example_without_changes.event())
    assert "only 1 other file changed" in service.bodies[0]


def test_read_only_token_is_reported_in_one_notice(example: Example, service: Service, runner: Runner) -> None:
    service.can_write = False
    run = runner.run("review", example.event(is_fork=True))
    assert run.failed == ""
    (line,) = [line for line in run.output.splitlines() if line.startswith("::notice::")]
    assert "this job's token cannot comment, as in pull requests of forks" in line
    assert sorted(path.name for path in run.uploaded["linkwright-review"].iterdir()) == FILES
    assert (run.uploaded["linkwright-review"] / "pull-request.txt").read_text(encoding="utf-8") == "5\n"


def test_fail_on_condition_fails_job_after_comment(example: Example, service: Service, runner: Runner) -> None:
    run = runner.run("review", example.event(), fail_on="breaking")
    assert run.failed == "Result"
    assert "::error::the review ended with status 1 (fail-on: breaking)" in run.output
    assert len(service.comments) == 1
    assert run.outputs["status"] == "1"


def test_inputs_of_review_action_are_applied(example: Example, service: Service, runner: Runner) -> None:
    run = runner.run(
        "review",
        example.event(),
        packages="arm_description\n",
        language="zh",
        comment="false",
        artifact="",
        linkwright="linkwright[mesh]",
        python_version="",
        base="main",
        head=HOSTILE_BRANCH,
    )
    assert run.failed == ""
    assert (run.used, run.uploaded, service.requests) == ([], {}, [])
    assert runner.installed.read_text(encoding="utf-8").endswith("\n--quiet\nlinkwright[mesh]\n")
    assert "删除连杆“lower”" in (Path(run.outputs["folder"]) / "comment.md").read_text(encoding="utf-8")
    example.assert_nothing_ran()


def test_event_without_pull_request_requires_base_and_head(example: Example, runner: Runner) -> None:
    run = runner.run("review", {"ref": "refs/heads/main"})
    assert run.failed == "Review"
    assert "::error::run the review on the event pull_request, or pass the inputs base and head" in run.output
    run = runner.run("review", {}, base=example.base, head=example.head)
    assert run.failed == ""
    assert "comment" not in run.output.split("::notice::")[-1]


def test_commit_missing_from_clone_is_reported(example: Example, service: Service, runner: Runner) -> None:
    run = runner.run("review", example.event(), base="0123456789" * 4)
    assert run.failed == "Review"
    assert "error[CLI343]" in run.output
    assert service.requests == []


def test_gitea_updates_comment_without_pagination(example: Example, service: Service, runner: Runner) -> None:
    service.ignores_pages = True
    for number in range(120):
        service.add(f"comment {number}", "ann", "")
    runner.run("review", example.event(), artifact="")
    service.comments[-1]["user"]["login"] = "gitea-actions"
    service.comments[-1]["user"]["type"] = ""
    run = runner.run("review", example.event(), artifact="")
    assert "the comment is up to date" in run.output
    assert len(service.writes) == 1
    assert service.bodies[-1].startswith(MARKER)
    assert "report.html" not in service.bodies[-1]


def test_report_json_has_fields_that_decide_on_comment(example: Example, runner: Runner) -> None:
    run = runner.run("review", example.event())
    data = json.loads((Path(run.outputs["folder"]) / "report.json").read_text(encoding="utf-8"))
    assert {"subjects", "new_findings", "fixed_findings", "notes"} < data.keys()
