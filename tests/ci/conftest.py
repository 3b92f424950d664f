"""An example repository with a pull request that changes a robot.

It is on a service for the steps of templates.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from tests.ci.runner import Runner
from tests.ci.service import Service, serve
from tests.repositories import ARM, MACRO, PACKAGE, Repository

HOSTILE_BRANCH = "$(touch${IFS}pwned)`touch${IFS}pwned`;\"'&|<x>@octocat"
"""A branch name that git allows."""
IMPORTABLE = ("json.py", "pip/__main__.py", "pip/__init__.py", "venv/__main__.py", "linkwright/__init__.py")
"""Files that `python -m` and imports find if they search the working folder."""


@dataclass(frozen=True)
class Example:
    """A pull request.

    Attributes:
        repository: the repository, in which the branch of the pull request is checked out.
        base: the commit of the target branch.
        head: the commit of the pull request.
    """

    repository: Repository
    base: str
    head: str

    def event(self, *, is_fork: bool = False) -> dict[str, Any]:
        """Return the event that a service sends for the pull request."""
        home = {"id": 1, "full_name": "team/robots"}
        fork = {"id": 2, "full_name": "stranger/robots"}
        head = {"sha": self.head, "ref": HOSTILE_BRANCH, "repo": fork if is_fork else home}
        pull = {"number": 5, "state": "open", "base": {"sha": self.base, "repo": home}, "head": head}
        return {"pull_request": pull, "repository": home}

    def assert_nothing_ran(self) -> None:
        """Assert that nothing that the pull request names or contains was run."""
        assert not list(self.repository.root.parent.rglob("pwned"))


@pytest.fixture
def example(tmp_path: Path) -> Example:
    """Return a pull request that renames a link and lengthens a macro.

    It has hostile names and files.
    """
    repository = Repository(tmp_path / "repository")
    base = repository.commit(PACKAGE)
    repository.git("checkout", "--quiet", "-b", HOSTILE_BRANCH)
    attack = "import pathlib\npathlib.Path(__file__).with_name('pwned').touch()\n"
    head = repository.commit(
        {
            "arm_description/urdf/segment.xacro": MACRO.replace("length:=0.5", "length:=0.6"),
            "arm_description/urdf/arm.urdf.xacro": ARM.replace('name="lower"', 'name="forearm"'),
            "arm_description/urdf/$(touch pwned) @octocat.urdf": '<robot name="a"><link name="b"/></robot>',
            **dict.fromkeys(IMPORTABLE, attack),
        }
    )
    return Example(repository, base, head)


@pytest.fixture
def service() -> Iterator[Service]:
    with serve(Service()) as running:
        yield running


@pytest.fixture
def runner(example: Example, service: Service, tmp_path: Path) -> Runner:
    """Return a runner as GitHub's, with the pull request checked out."""
    variables = {"GITHUB_API_URL": service.url, "GITHUB_REPOSITORY": "team/robots"}
    return Runner(example.repository.root, tmp_path / "runner", variables)
