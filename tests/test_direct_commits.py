"""Commits written without git are those that git writes."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.direct_commits import DirectCommits
from tests.repositories import Repository

FILES = {"a.txt": "a\n", "a/b.txt": "b\n", "a-b/c.txt": b"\xff\0", "läuft/x y": "", "z": "z" * 5000}


@pytest.fixture
def repository(tmp_path: Path) -> Repository:
    return Repository(tmp_path / "repository")


def make_links(root: Path) -> None:
    (root / "run").write_text("#!/bin/sh\n")
    (root / "run").chmod(0o755)
    (root / "link").symlink_to("a/b.txt")
    (root / "empty").mkdir()


def test_trees_and_indexes_are_those_of_git(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written, plain = Repository(tmp_path / "direct"), Repository(tmp_path / "plain")
    trees = []
    for repository in (written, plain):
        repository.write(FILES)
        make_links(repository.root)
        if repository is plain:
            monkeypatch.setattr(DirectCommits, "commit", lambda *_: None)
        first = repository.commit({}, "First")
        second = repository.commit({"a.txt": None, "a/b.txt": "other\n"}, "Second \n\n")
        assert repository.git("status", "--porcelain") == ""
        assert repository.git("fsck", "--strict") == ""
        assert repository.git("rev-list", "HEAD").split() == [second, first]
        assert repository.git("diff", "--name-status", first, second).split() == ["D", "a.txt", "M", "a/b.txt"]
        assert repository.git("log", "-1", "--format=%an %ae %B", first) == "Ann ann@example.org First"
        assert repository.git("cat-file", "commit", second).splitlines()[-1] == "Second"
        trees.append((repository.git("ls-tree", "-r", "-t", first), repository.git("ls-files", "--stage")))
    assert trees[0] == trees[1]


def test_changes_after_a_commit_are_found(repository: Repository) -> None:
    repository.commit(FILES)
    repository.write({"a.txt": "b\n", "z": None, "new": ""})
    assert repository.git("status", "--porcelain").split() == ["M", "a.txt", "D", "z", "??", "new"]
    repository.git("commit", "--quiet", "--all", "--message", "Of git")
    assert repository.commit({"a.txt": "c\n"}) == repository.git("rev-parse", "HEAD")
    assert repository.git("rev-list", "--count", "HEAD") == "3"


@pytest.mark.parametrize("name", [".gitignore", "a/.gitattributes", ".gitmodules"])
def test_files_of_git_are_left_to_git(repository: Repository, name: str) -> None:
    repository.write({**FILES, name: ""})
    assert repository._direct_commits.commit("A change") is None


@pytest.mark.parametrize(
    "command",
    [
        ("config", "core.autocrlf", "true"),
        ("add", "a.txt"),
        ("checkout", "--quiet", "--detach"),
        ("pack-refs", "--all"),
    ],
)
def test_repository_that_git_has_changed_is_left_to_git(repository: Repository, command: tuple[str, ...]) -> None:
    repository.commit(FILES)
    repository.write({"a.txt": "b\n"})
    repository.git(*command)
    assert repository._direct_commits.commit("A change") is None
