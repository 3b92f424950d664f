"""The template for GitLab in an example repository.

The tests cover its note, its code quality report, and code that is not run.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from linkwright.review.reports.markdown import MARKER
from tests.ci.conftest import HOSTILE_BRANCH, Example
from tests.ci.runner import TEMPLATES, Runner
from tests.ci.service import TOKEN, Service
from tests.places import REPOSITORY, needs_page
from tests.repositories import ARM, Repository

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="the scripts are for Linux and macOS")

TEMPLATE = yaml.safe_load((TEMPLATES / "gitlab" / "review.yml").read_text(encoding="utf-8"))
JOB = TEMPLATE["linkwright-review"]


class GitLab:
    """A runner of GitLab with the merge request of the example."""

    def __init__(self, example: Example, service: Service, runner: Runner) -> None:
        service.author_key, service.name_key, service.me = "author", "username", "project_1_bot"
        self.folder = example.repository.root / "linkwright-review"
        self._example, self._runner = example, runner
        self._variables = {
            **JOB["variables"],
            "LINKWRIGHT": str(REPOSITORY),
            "LINKWRIGHT_TOKEN": TOKEN,
            "CI_PROJECT_DIR": str(example.repository.root),
            "CI_API_V4_URL": f"{service.url}/api/v4",
            "CI_MERGE_REQUEST_PROJECT_ID": "3",
            "CI_MERGE_REQUEST_IID": "5",
            "CI_MERGE_REQUEST_SOURCE_BRANCH_NAME": HOSTILE_BRANCH,
            "CI_MERGE_REQUEST_DIFF_BASE_SHA": example.base,
            "CI_JOB_URL": "https://example.org/team/robots/-/jobs/9",
            "TMPDIR": str(runner.temporary),
        }

    def run(self, **variables: str) -> subprocess.CompletedProcess[str]:
        commit = self._example.repository.git("rev-parse", "HEAD")
        (script,) = JOB["script"]
        prepared = f"unset GITHUB_ACTIONS\n{script}"
        return self._runner.bash(prepared, {**self._variables, "CI_COMMIT_SHA": commit, **variables})


@pytest.fixture
def gitlab(example: Example, service: Service, runner: Runner) -> GitLab:
    return GitLab(example, service, runner)


def test_report_is_posted_on_merge_request(example: Example, service: Service, gitlab: GitLab) -> None:
    result = gitlab.run()
    assert result.returncode == 0, result.stdout
    assert result.stdout.endswith("the comment is posted\n")
    (body,) = service.bodies
    assert body.startswith(f"{MARKER}\n### Robot review: ")
    assert "link 'lower' removed" in body
    assert body.endswith(
        "\n[report.html](https://example.org/team/robots/-/jobs/9/artifacts/file/linkwright-review/report.html)\n"
    )
    assert service.writes == ["POST /api/v4/projects/3/merge_requests/5/notes"]
    assert set(service.tokens) == {TOKEN}
    example.assert_nothing_ran()


def test_second_run_edits_note(example: Example, service: Service, gitlab: GitLab) -> None:
    gitlab.run()
    example.repository.commit({"arm_description/urdf/more.urdf": '<robot name="more"><link name="a"/></robot>'})
    assert gitlab.run().stdout.endswith("the comment is updated\n")
    assert service.writes[1:] == ["PUT /api/v4/projects/3/merge_requests/5/notes/100"]
    assert len(service.comments) == 1


def test_report_files_are_written_without_token(service: Service, gitlab: GitLab) -> None:
    result = gitlab.run(LINKWRIGHT_TOKEN="")
    assert result.returncode == 0
    assert "there is no comment, because the variable LINKWRIGHT_TOKEN is not set" in result.stdout
    assert service.requests == []
    assert (gitlab.folder / "report.html").is_file()


def test_fail_on_condition_fails_job_after_note(service: Service, gitlab: GitLab) -> None:
    result = gitlab.run(LINKWRIGHT_FAIL_ON="breaking", LINKWRIGHT_PACKAGES="arm_description")
    assert result.returncode == 1
    assert len(service.comments) == 1


def test_merged_results_pipeline_compares_from_source_branch(example: Example, gitlab: GitLab) -> None:
    repository = example.repository
    repository.git("checkout", "--quiet", "main")
    repository.commit({"arm_description/urdf/target.urdf": '<robot name="t"><link name="a"/></robot>'})
    repository.git("merge", "--quiet", "--no-edit", example.head)
    gitlab.run(CI_MERGE_REQUEST_SOURCE_BRANCH_SHA=example.head)
    comment = (gitlab.folder / "comment.md").read_text(encoding="utf-8")
    assert "link 'lower' removed" in comment
    assert "target.urdf" not in comment


def test_linkwright_is_cloned_from_url(service: Service, runner: Runner, gitlab: GitLab, tmp_path: Path) -> None:
    linkwright = Repository(tmp_path / "linkwright")
    programs = list(TEMPLATES.rglob("*.py"))
    linkwright.commit({str(path.relative_to(REPOSITORY)): path.read_text(encoding="utf-8") for path in programs})
    linkwright.git("tag", "v1")
    linkwright.commit(dict.fromkeys((str(path.relative_to(REPOSITORY)) for path in programs), "raise SystemExit(9)"))
    result = gitlab.run(LINKWRIGHT=f"file://{linkwright.root}", LINKWRIGHT_REF="v1")
    assert result.returncode == 0, result.stdout
    assert len(service.comments) == 1
    *_, option, folder = runner.installed.read_text(encoding="utf-8").splitlines()
    assert (option, Path(folder).name) == ("--editable", "linkwright")
    assert Path(folder).is_relative_to(runner.temporary)


@needs_page
@pytest.mark.parametrize("scenes", ["false", "true"])
def test_scenes_are_in_the_page_if_the_variable_says_so(runner: Runner, gitlab: GitLab, scenes: str) -> None:
    assert gitlab.run(LINKWRIGHT_SCENES=scenes).returncode == 0
    page = (gitlab.folder / "report.html").read_text(encoding="utf-8")
    assert ("<details class='scene'>" in page) == (scenes == "true")
    assert (runner.without_page.read_text(encoding="utf-8") == "\n") == (scenes == "true")


def test_findings_are_reported_as_code_quality(example: Example, gitlab: GitLab) -> None:
    faulty = ARM.replace("</robot>", '<link name="loose link"/></robot>')
    example.repository.commit({"arm_description/urdf/arm #1.urdf.xacro": faulty})
    assert gitlab.run().returncode == 0
    report = json.loads((gitlab.folder / "code-quality.json").read_text(encoding="utf-8"))
    assert report
    for entry in report:
        assert entry.keys() == {"description", "check_name", "fingerprint", "severity", "location"}
        assert entry["severity"] in {"info", "minor", "major", "critical", "blocker"}
        assert entry["location"]["lines"]["begin"] >= 1
        assert (example.repository.root / entry["location"]["path"]).is_file()
    assert len({entry["fingerprint"] for entry in report}) == len(report)
    assert "arm_description/urdf/arm #1.urdf.xacro" in {entry["location"]["path"] for entry in report}


def test_target_branch_has_empty_code_quality_report(tmp_path: Path) -> None:
    job = TEMPLATE["linkwright-review-base"]
    subprocess.run(["bash", "-e", "-c", "\n".join(job["script"])], cwd=tmp_path, check=True)
    assert json.loads((tmp_path / job["artifacts"]["reports"]["codequality"]).read_text(encoding="utf-8")) == []


def test_artifacts_match_files_written_by_script(gitlab: GitLab) -> None:
    gitlab.run()
    root = gitlab.folder.parent
    artifacts = JOB["artifacts"]
    assert [root / path for path in artifacts["paths"]] == [gitlab.folder]
    assert (root / artifacts["reports"]["codequality"]).is_file()
