"""The page about reviews: the program's output, and files that match the templates."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from linkwright.cli import main
from tests.ci.runner import TEMPLATES
from tests.ci.test_pre_commit import HOOKS
from tests.docs.pages import DOCS, Block, read_blocks
from tests.docs.reader import write_block
from tests.repositories import Repository

PAGES = {"en": DOCS / "howto-review.md", "zh": DOCS / "zh" / "howto-review.md"}


def yaml_files(page: Path = PAGES["en"]) -> dict[str, Any]:
    """Return the YAML files of the page by name."""
    return {block.title: yaml.safe_load(block.text) for block in read_blocks(page) if block.language == "yaml"}


def job_steps(name: str) -> list[dict[str, Any]]:
    (job,) = yaml_files()[name]["jobs"].values()
    found: list[dict[str, Any]] = job["steps"]
    return found


@pytest.mark.parametrize("language", PAGES)
def test_outputs_on_page_are_current(
    language: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shown = read_blocks(PAGES[language])
    robot: list[Block] = [block for block in shown if block.title.endswith(".urdf")]
    review, check, _ = (block.text for block in shown if block.language == "text")
    repository = Repository(tmp_path / "robots")
    write_block(next(block for block in shown if block.title.endswith("package.xml")), repository.root)
    write_block(robot[0], repository.root)
    repository.commit({})
    write_block(robot[1], repository.root)
    monkeypatch.chdir(repository.root)
    assert main(["review", "--lang", language]) == 0
    assert capsys.readouterr().out == review
    assert main(["check", "--strict", "--changed", "main", "src", "--lang", language]) == 1
    assert capsys.readouterr().err == check


@pytest.mark.parametrize("language", PAGES)
def test_output_of_a_scenario_is_current(
    language: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shown = read_blocks(PAGES[language])
    (scenario,) = (block for block in shown if block.language == "python")
    *_, output = (block.text for block in shown if block.language == "text")
    repository = Repository(tmp_path / "robots")
    write_block(scenario, repository.root)
    repository.commit({})
    repository.write({scenario.title: scenario.text.replace("TURN = 0.3", "TURN = 0.4")})
    monkeypatch.chdir(repository.root)
    assert main(["review", "HEAD", "--scenario", scenario.title, "--lang", language]) == 0
    assert capsys.readouterr().out.partition("\n\n")[0] == output.strip()


@pytest.mark.parametrize("name", [".github/workflows/review.yml", ".gitea/workflows/review.yml"])
def test_workflow_uses_review_action(name: str) -> None:
    checkout, review, *_ = job_steps(name)
    assert checkout["with"] == {"fetch-depth": 0}
    _, _, path = review["uses"].partition("/linkwright/")
    assert path == "packaging/ci/review@REF"
    declared = yaml.safe_load((TEMPLATES / "review" / "action.yml").read_text(encoding="utf-8"))["inputs"]
    assert review.get("with", {}).keys() <= declared.keys()


def test_workflow_for_forks_checks_out_nothing() -> None:
    workflow = yaml_files()[".github/workflows/review-comment.yml"]
    (step,) = job_steps(".github/workflows/review-comment.yml")
    assert step == {"uses": "OWNER/linkwright/packaging/ci/comment@REF"}
    assert workflow[True]["workflow_run"]["workflows"] == [yaml_files()[".github/workflows/review.yml"]["name"]]
    assert workflow["permissions"] == {"actions": "read", "pull-requests": "write"}


def test_workflows_do_not_give_token_to_pull_request_code() -> None:
    for name, content in yaml_files().items():
        assert "pull_request_target" not in str(content), name
    for name in (".github/workflows/review.yml", ".gitea/workflows/review.yml"):
        assert yaml_files()[name][True] == "pull_request"


def test_gitlab_file_includes_template() -> None:
    settings = yaml_files()[".gitlab-ci.yml"]
    template = yaml.safe_load((TEMPLATES / "gitlab" / "review.yml").read_text(encoding="utf-8"))
    assert (TEMPLATES.parent.parent / settings["include"][0]["file"]).is_file()
    for name, job in settings.items():
        if name != "include":
            assert job["variables"].keys() <= template[name]["variables"].keys()


def test_local_hook_matches_published_hook() -> None:
    (local,) = yaml_files()[".pre-commit-config.yaml"]["repos"][0]["hooks"]
    hook = HOOKS[local["id"]]
    assert local["entry"] == " ".join([hook["entry"], *hook["args"]])
    assert (local["name"], local["files"]) == (hook["name"], hook["files"])


def test_action_inputs_are_documented() -> None:
    declared = yaml.safe_load((TEMPLATES / "review" / "action.yml").read_text(encoding="utf-8"))["inputs"]
    for page in PAGES.values():
        text = page.read_text(encoding="utf-8")
        assert [name for name in declared if f"`{name}`" not in text] == []
