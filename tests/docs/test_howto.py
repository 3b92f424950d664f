"""How-to pages, followed line by line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

from tests.docs.pages import DOCS, read_blocks
from tests.docs.reader import Outcome

CHECK = "linkwright check --strict src"
PUBLISH = 'linkwright topic pub -r 10 /cmd_vel geometry_msgs/msg/Twist "{linear: {x: 0.3}, angular: {z: 0.5}}"'


@pytest.mark.parametrize("page", sorted(DOCS.glob("howto-*.md")), ids=lambda page: page.stem)
def test_both_languages_show_same_files(page: Path) -> None:
    english, chinese = (
        [(block.title, block.text) for block in read_blocks(language_page) if block.title]
        for language_page in (page, DOCS / "zh" / page.name)
    )
    assert english == chinese


@pytest.mark.slow
def test_drive_and_world_guides_complete_urdf_without_masses(follow: Callable[..., Path]) -> None:
    page = DOCS / "howto-drive.md"
    first_line = next(block.text.splitlines()[0] for block in read_blocks(page) if block.language == "text")
    follow(
        page,
        {"linkwright drive cart.urdf": Outcome(output_text=first_line), PUBLISH: Outcome(output_text="publishing #1")},
    )
    home = follow(DOCS / "howto-world.md", {})
    cart = (home / "cart.urdf").read_text(encoding="utf-8")
    assert cart.count("<mass ") == 4
    assert "libgazebo_ros_diff_drive.so" in cart
    assert (home / "yard.world").is_file()


@pytest.mark.slow
def test_ci_guide_fails_on_finding_and_fixes_it(follow: Callable[..., Path]) -> None:
    home = follow(
        DOCS / "howto-ci.md",
        {
            CHECK: Outcome(error="LW201", may_fail=True, runs_on=False),
            "linkwright check --diff --unsafe-fixes src": Outcome(
                output_text='+    <limit lower="-1.57"', may_fail=True, runs_on=False
            ),
        },
    )
    assert '<limit lower="-1.57" upper="1.57"' in (home / "src" / "arm.urdf").read_text(encoding="utf-8")
    assert (home / "linkwright.sarif").is_file()


@pytest.mark.slow
def test_review_guide_shows_changes_before_merge(follow: Callable[..., Path]) -> None:
    home = follow(
        DOCS / "howto-review.md",
        {
            "linkwright review": Outcome(output_text="link 'camera' renamed to 'camera_link'", runs_on=False),
            "linkwright check --strict --changed main src": Outcome(
                output_text="URDF190", may_fail=True, runs_on=False
            ),
        },
    )
    assert (home / "review.html").is_file()
    assert (home / "robots" / "build" / "review.html").is_file()
    assert "URDF190" in (home / "robots" / "known-findings.json").read_text(encoding="utf-8")


def test_ci_workflow_and_hook_run_shown_commands() -> None:
    files = {
        block.title: yaml.safe_load(block.text)
        for block in read_blocks(DOCS / "howto-ci.md")
        if "yaml" in block.title or "yml" in block.title
    }
    documented = [
        line
        for block in read_blocks(DOCS / "howto-ci.md")
        if block.language == "bash"
        for line in block.text.splitlines()
    ]
    steps = files[".github/workflows/check.yml"]["jobs"]["descriptions"]["steps"]
    assert [step["run"] for step in steps if "linkwright check" in step.get("run", "")] == [
        "linkwright check --strict --format github src"
    ]
    (hook,) = files[".pre-commit-config.yaml"]["repos"][0]["hooks"]
    assert hook["entry"] == CHECK
    assert {hook["entry"], steps[-1]["run"]} <= set(documented)
