"""The hooks for pre-commit in an example repository: old findings pass, new ones fail."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.places import REPOSITORY
from tests.repositories import ARM, PACKAGE, Repository

HOOKS = {hook["id"]: hook for hook in yaml.safe_load((REPOSITORY / ".pre-commit-hooks.yaml").read_text("utf-8"))}
FAULTY_ARM = ARM.replace("</robot>", '<link name="loose"/></robot>')


@pytest.fixture
def repository(tmp_path: Path) -> Repository:
    repository = Repository(tmp_path / "repository")
    repository.commit({**PACKAGE, "arm_description/urdf/old.urdf.xacro": FAULTY_ARM.replace('"arm"', '"old"')})
    return repository


def run_hook(repository: Repository, name: str) -> subprocess.CompletedProcess[str]:
    """Run a hook that checks all files, as pre-commit does."""
    hook: dict[str, Any] = HOOKS[name]
    command, *words = hook["entry"].split()
    assert command == "linkwright"
    assert not hook["pass_filenames"]
    return subprocess.run(
        [sys.executable, "-I", "-m", "linkwright", *words, *hook["args"]],
        cwd=repository.root,
        capture_output=True,
        text=True,
        check=False,
    )


def test_hooks_have_fields_that_pre_commit_requires() -> None:
    for hook in HOOKS.values():
        assert {"id", "name", "entry", "language", "files"} <= hook.keys()
        assert hook["language"] == "python"
        assert re.search(hook["files"], "arm_description/urdf/arm.urdf.xacro")
        assert not re.search(hook["files"], "README.md")


def test_old_findings_fail_only_hook_that_checks_all(repository: Repository) -> None:
    assert run_hook(repository, "linkwright-check").returncode == 1
    result = run_hook(repository, "linkwright-check-changed")
    assert result.returncode == 0, result.stderr


def test_new_findings_stop_commit(repository: Repository) -> None:
    repository.write({"arm_description/urdf/arm.urdf.xacro": FAULTY_ARM})
    repository.git("add", "--all")
    result = run_hook(repository, "linkwright-check-changed")
    assert result.returncode == 1
    assert "loose" in result.stderr
    assert "old.urdf.xacro" not in result.stderr
