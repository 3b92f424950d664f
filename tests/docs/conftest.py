"""Fixtures for tests of the documentation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from tests.docs.reader import Outcome, Reader, environment_of
from tests.installed import install


@pytest.fixture
def follow(tmp_path_factory: pytest.TempPathFactory, tmp_path: Path) -> Callable[..., Path]:
    """Return a function that follows a page and returns the home folder.

    The outcomes of some lines are known.
    """
    shared_folder = tmp_path_factory.getbasetemp().parent / "installed"
    environment = install(shared_folder, "pytest", "flake8", "pydocstyle")

    def follow_page(page: Path, outcomes: Mapping[str, Outcome]) -> Path:
        Reader(environment_of(environment, tmp_path), tmp_path, outcomes).follow(page)
        return tmp_path

    return follow_page
