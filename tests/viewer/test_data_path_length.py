"""The number of files through which the data passes: a reader must open each of them."""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from tests.places import REPOSITORY

MAX_FILES = {"opening": 160, "slider": 21}
"""The maximum numbers of files whose functions run from `view` to an open page, and from a slider to the frames."""


@cache
def _find_files() -> dict[str, list[str]]:
    result = subprocess.run(
        [sys.executable, "-m", "tests.viewer.ways"], capture_output=True, text=True, cwd=REPOSITORY, check=True
    )
    files: dict[str, list[str]] = json.loads(result.stdout)
    return files


@pytest.mark.parametrize("way", MAX_FILES)
def test_data_path_uses_few_files(way: str):
    files = _find_files()[way]
    rooms = Counter(Path(file).parts[0] for file in files)
    listed = "\n".join(files)
    assert len(files) <= MAX_FILES[way], f"{len(files)} files in {dict(rooms.most_common())}:\n{listed}"
