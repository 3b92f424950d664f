"""What tests of the documentation share."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from tests.docs.reader import Known, Reader, environment_of
from tests.installed import install


@pytest.fixture
def follow(tmp_path_factory: pytest.TempPathFactory, tmp_path: Path) -> Callable[..., Path]:
    """Follow a page as a reader does who knows some lines' outcome; returns their home folder."""
    of_all_workers = tmp_path_factory.getbasetemp().parent / "installed"
    environment = install(of_all_workers, "pytest", "flake8", "pydocstyle")

    def follow_page(page: Path, known: Mapping[str, Known]) -> Path:
        Reader(environment_of(environment, tmp_path), tmp_path, known).follow(page)
        return tmp_path

    return follow_page
