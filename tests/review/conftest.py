"""Repositories of git with a few commits."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from linkwright.review import Review, Subject, open_versions, review
from tests.repositories import PACKAGE, Repository


@pytest.fixture
def repository(tmp_path: Path) -> Repository:
    return Repository(tmp_path / "repository")


@pytest.fixture
def package(repository: Repository) -> Repository:
    """Return a repository with a commit of a package of an arm."""
    repository.commit(PACKAGE)
    return repository


Compare = Callable[..., Review]


@pytest.fixture
def compare() -> Compare:
    """Review a range of commits, by default the working tree against the last commit."""

    def run(repository: Repository, range_text: str = "HEAD", packages: tuple[str, ...] = ()) -> Review:
        versions = open_versions(repository.root, range_text)
        try:
            return review(versions, packages)
        finally:
            versions.close()

    return run


def subject(result: Review, path: str) -> Subject:
    """Return the subject with a path."""
    (review_subject,) = [subject for subject in result.subjects if subject.path == path]
    return review_subject


def sentences(subject: Subject) -> list[str]:
    return [str(change.sentence) for change in subject.changes]


def breaking(result: Review) -> list[str]:
    return [str(change.sentence) for _, change in result.breaking_changes]


@pytest.fixture
def review_changes(repository, compare):
    """Review a replacement in a launch file.

    Return the sentences of all changes and of the breaking ones.
    """

    def run(name: str, text: str, old: str, new: str):
        assert old in text
        repository.commit({f"arm/launch/{name}": text})
        repository.write({f"arm/launch/{name}": text.replace(old, new)})
        result = compare(repository)
        return [sentence for subject in result.subjects for sentence in sentences(subject)], breaking(result)

    return run
