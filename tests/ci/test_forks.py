"""The comment on a pull request of a fork.

It comes from an artifact that the fork could have made.
"""

from __future__ import annotations

import io
import sys
import zipfile
from pathlib import Path
from typing import Any

import pytest

from linkwright.review.reports.markdown import MARKER
from tests.ci.conftest import Example
from tests.ci.runner import Run, Runner
from tests.ci.service import Service

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the scripts are for Linux and macOS")

VALID_COMMENT = (
    f"{MARKER}\n### Robot review: a to b\n\n1 breaking change\n\n- **link &#60;a&#62; removed** (<code>a.urdf</code>)\n"
)
REPORT = '{"subjects": [{}], "new_findings": [], "fixed_findings": [], "notes": []}'
LINE = "> This report comes from [a run of the fork](https://example.org/runs/6), whose author can change it.\n"
HEAD = "c" * 40


def pack_artifact(
    comment: str | bytes = VALID_COMMENT, report: str = REPORT, number: str = "5\n", **extra_entries: str
) -> bytes:
    """Return an artifact as a zip file."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in (("comment.md", comment), ("report.json", report), ("pull-request.txt", number)):
            archive.writestr(name, content)
        for name, content in extra_entries.items():
            archive.writestr(name, content)
    return data.getvalue()


def run_event(head: str = HEAD, **changes: Any) -> dict[str, Any]:
    """Return the event of a run of the fork."""
    run = {"id": 6, "event": "pull_request", "head_sha": head, "html_url": "https://example.org/runs/6"}
    run |= {"head_repository": {"id": 2}, "head_branch": "$(touch pwned)"}
    return {"workflow_run": {**run, **changes}, "repository": {"id": 1}}


@pytest.fixture
def runner(service: Service, tmp_path: Path) -> Runner:
    """A runner without a checkout."""
    (tmp_path / "empty").mkdir()
    return make_runner(tmp_path / "empty", service)


def make_runner(checkout: Path, service: Service) -> Runner:
    variables = {"GITHUB_API_URL": service.url, "GITHUB_REPOSITORY": "team/robots"}
    return Runner(checkout, checkout.parent / "runner", variables)


@pytest.fixture
def fork(service: Service) -> Service:
    """A service with the pull request of a fork."""
    service.pulls[5] = {"state": "open", "head": {"sha": HEAD, "repo": {"id": 2}}}
    service.artifact = pack_artifact()
    return service


def comment_on_pull_request(runner: Runner, head: str = HEAD, **changes: Any) -> Run:
    return runner.run("comment", run_event(head, **changes))


def test_review_report_is_posted(example: Example, fork: Service) -> None:
    runner = make_runner(example.repository.root, fork)
    fork.can_write = False
    folder = runner.run("review", example.event(is_fork=True)).uploaded["linkwright-review"]
    files = {path.name: path.read_bytes() for path in folder.iterdir()}
    fork.can_write = True
    fork.pulls[5]["head"]["sha"] = example.head
    fork.artifact = pack_artifact(
        files["comment.md"], files["report.json"].decode(), files["pull-request.txt"].decode()
    )
    fork.requests.clear()
    fork.tokens.clear()
    run = comment_on_pull_request(runner, example.head)
    assert run.output == "::notice::the comment is posted\n"
    assert fork.bodies == [files["comment.md"].decode().replace("\n", f"\n{LINE}\n", 1)]
    assert run.used == []
    assert dict(zip(fork.requests, fork.tokens, strict=True))["GET /storage"] == ""
    assert "the comment is up to date" in comment_on_pull_request(runner, example.head).output
    example.assert_nothing_ran()


def test_comment_is_edited(fork: Service, runner: Runner) -> None:
    comment_on_pull_request(runner)
    fork.artifact = pack_artifact(VALID_COMMENT.replace("1 breaking", "2 breaking"))
    assert comment_on_pull_request(runner).output == "::notice::the comment is updated\n"
    assert len(fork.comments) == 1
    assert "2 breaking changes" not in fork.bodies[0]
    assert "2 breaking change" in fork.bodies[0]


def test_comments_of_others_are_not_edited(fork: Service, runner: Runner) -> None:
    fork.add(f"{MARKER}\nmine", "stranger", "User")
    assert comment_on_pull_request(runner).output == "::notice::the comment is posted\n"
    assert fork.bodies[0] == f"{MARKER}\nmine"


def test_owner_of_other_token_edits_own_comment(fork: Service, runner: Runner) -> None:
    fork.me = "robot-team"
    fork.add(f"{MARKER}\nold", "github-actions[bot]", "Bot")
    comment_on_pull_request(runner)
    assert fork.comments[1]["user"]["login"] == "robot-team"
    assert comment_on_pull_request(runner).output == "::notice::the comment is up to date\n"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("Approved by the maintainers.", "no marker"),
        (f"{MARKER}\n@octocat look", "a mention"),
        (f"{MARKER}\n&commat;octocat look", "a mention as an entity"),
        (f"{MARKER}\n&#64;octocat look", "a mention as a number"),
        (f"{MARKER}\nsee #12", "a reference"),
        (f"{MARKER}\n[click](https://example.org)", "a link"),
        (f"{MARKER}\n![x](https://example.org/x.png)", "an image"),
        (f"{MARKER}\n<img src=x>", "markup"),
        (f"{MARKER}\n<details open>x</details>", "attributes"),
        (f"{MARKER}\n<!-- hidden", "a comment"),
        (f"{MARKER}\n```\nx", "code"),
        (f"{MARKER}\n{'x' * 65_000}", "too long"),
        (f"{MARKER}\n{'x' * 65_000_000}", "a bomb"),
        (f"{MARKER}\n".encode() + b"\xff", "no text"),
    ],
    ids=lambda value: value if isinstance(value, str) and len(value) < 30 and "\n" not in value else "",
)
def test_text_that_is_not_a_report_is_not_posted(fork: Service, runner: Runner, text: str | bytes, reason: str) -> None:
    fork.artifact = pack_artifact(text)
    run = comment_on_pull_request(runner)
    assert run.failed == "Comment on the pull request", reason
    assert run.output.startswith("::error::")
    assert len(run.output.splitlines()) == 1
    assert len(run.output) < 300
    assert fork.writes == []


def test_urls_in_names_are_not_links(fork: Service, runner: Runner) -> None:
    fork.artifact = pack_artifact(f"{MARKER}\n- mesh https://example.org/a.stl and www.example.org\n")
    comment_on_pull_request(runner)
    assert fork.bodies[0].endswith("- mesh https://\u200bexample.org/a.stl and www.\u200bexample.org\n")


@pytest.mark.parametrize("number", ["", "5; touch pwned", "$(touch pwned)", "-5", "5\n6", "5" * 20, "../5", "0"])
def test_malformed_pull_request_number_is_rejected(fork: Service, runner: Runner, number: str, tmp_path: Path) -> None:
    fork.artifact = pack_artifact(number=number)
    assert comment_on_pull_request(runner).output.startswith("::error::")
    assert fork.writes == []
    assert not list(tmp_path.rglob("pwned"))


def test_pull_request_of_another_repository_is_rejected(fork: Service, runner: Runner) -> None:
    fork.pulls[6] = {"state": "open", "head": {"sha": HEAD, "repo": {"id": 3}}}
    fork.pulls[7] = {"state": "open", "head": {"sha": HEAD, "repo": None}}
    for number in ("6", "7"):
        fork.artifact = pack_artifact(number=number)
        assert "is not one of the fork" in comment_on_pull_request(runner).output
    fork.artifact = pack_artifact(number="8")
    assert "/pulls/8 answers 404" in comment_on_pull_request(runner).output
    assert fork.writes == []


@pytest.mark.parametrize("changes", [{"state": "closed"}, {"head": {"sha": "d" * 40, "repo": {"id": 2}}}])
def test_outdated_run_posts_nothing(fork: Service, runner: Runner, changes: dict[str, Any]) -> None:
    fork.pulls[5] |= changes
    run = comment_on_pull_request(runner)
    assert (run.failed, fork.writes) == ("", [])
    assert "is closed or has newer commits" in run.output


@pytest.mark.parametrize("changes", [{"event": "push"}, {"head_repository": {"id": 1}}, {"head_repository": None}])
def test_runs_without_fork_post_nothing(fork: Service, runner: Runner, changes: dict[str, Any]) -> None:
    run = comment_on_pull_request(runner, **changes)
    assert (run.failed, fork.requests) == ("", [])
    assert "is not one of a fork's pull request" in run.output


def test_missing_or_malformed_artifact_is_reported(fork: Service, runner: Runner) -> None:
    fork.artifact = None
    assert comment_on_pull_request(runner).output == "::notice::the run has no artifact 'linkwright-review'\n"
    for artifact in (
        b"no archive",
        pack_artifact(report="[" * 100_000),
        pack_artifact(report="[]"),
        zip_without_report(),
    ):
        fork.artifact = artifact
        run = comment_on_pull_request(runner)
        assert run.output.startswith("::error::the comment is not posted, because a file is not one of a review")
        assert "Traceback" not in run.output
    assert fork.writes == []


def test_artifact_files_are_not_written_to_disk(fork: Service, runner: Runner, tmp_path: Path) -> None:
    before = set(tmp_path.rglob("*"))
    fork.artifact = pack_artifact(**{"../../pwned": "x", "pwned": "x"})
    comment_on_pull_request(runner)
    after = {path.name for path in tmp_path.rglob("*") if path not in before}
    assert after <= {"event.json", "step.sh"}
    assert len(fork.comments) == 1


def test_temporary_service_failures_are_retried(fork: Service, runner: Runner) -> None:
    fork.failures = [502, 429]
    assert comment_on_pull_request(runner).output == "::notice::the comment is posted\n"
    fork.failures = [500] * 3
    run = comment_on_pull_request(runner)
    assert run.failed
    assert run.output.startswith(
        "::error::the comment is not posted: /repos/team/robots/actions/runs/6/artifacts answers"
    )


def test_missing_token_and_unreachable_service_are_reported(runner: Runner, tmp_path: Path) -> None:
    run = runner.run("comment", run_event(), token="")
    assert run.output == "::notice::there is no comment, because the variable LINKWRIGHT_TOKEN is not set\n"
    variables = {"GITHUB_API_URL": "http://127.0.0.1:1", "GITHUB_REPOSITORY": "team/robots"}
    run = comment_on_pull_request(Runner(tmp_path, tmp_path / "offline", variables))
    assert run.failed
    assert run.output.startswith("::error::the comment is not posted: ")
    assert len(run.output.splitlines()) == 1


def zip_without_report() -> bytes:
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        archive.writestr("comment.md", VALID_COMMENT)
    return data.getvalue()
