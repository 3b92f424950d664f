"""Paths in the repository, for tests."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
PACKAGE = REPOSITORY / "robots" / "my_robot_description"
GAZEBO_PACKAGE = REPOSITORY / "robots" / "my_robot_gazebo"
VOICE_PACKAGE = REPOSITORY / "robots" / "my_robot_voice"
CONTROL_PACKAGE = REPOSITORY / "robots" / "my_robot_control"
NAVIGATION_PACKAGE = REPOSITORY / "robots" / "my_robot_navigation"
VISION_PACKAGE = REPOSITORY / "robots" / "my_robot_vision"
ARM_PACKAGE = REPOSITORY / "robots" / "my_robot_arm"
PUBLISHED = (REPOSITORY.parent / "shared" / "tutorial" / "my_robot_description").resolve()
"""The folder of the tutorial's published package, which is not part of the repository and may not exist."""
TUTORIAL_PACKAGES = [PACKAGE, *([PUBLISHED] if PUBLISHED.is_dir() else [])]
"""The packages that a reader of the tutorial may have: Linkwright's, and the published one."""


def without_meshes(package: Path, folder: Path) -> Path:
    """Copy a package without its meshes, which readers of the tutorial download later."""
    return shutil.copytree(package, folder / package.name, ignore=shutil.ignore_patterns("meshes", "__pycache__"))


BUILT_PAGE = REPOSITORY / "src" / "linkwright" / "page" / "built"
needs_page = pytest.mark.skipif(not (BUILT_PAGE / "export").is_dir(), reason="the page is not built")
"""The mark of tests that use the page. `make test` builds it; a run without it skips them."""
