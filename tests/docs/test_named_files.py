"""Files, folders and modules that developers' pages name must exist."""

from __future__ import annotations

import functools
import re
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.docs.pages import DOCS
from tests.places import REPOSITORY

PAGES = [
    REPOSITORY / "CONTRIBUTING.md",
    DOCS / "architecture.md",
    DOCS / "zh" / "architecture.md",
    REPOSITORY / "frontend" / "README.md",
    REPOSITORY / "fuzz" / "README.md",
    REPOSITORY / "tests" / "corpus" / "README.md",
]
FOLDERS = (
    ".github", "benchmarks", "courses", "docs", "editors", "frontend/src", "frontend/test", "fuzz", "packaging",
    "robots", "src", "tests", "tools",
)  # fmt: skip
IGNORED = [line.strip("/") for line in (REPOSITORY / ".gitignore").read_text(encoding="utf-8").split()]
"""Outputs of make, which a new clone does not have."""

_FENCE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
_WORDS = re.compile(r"`([^`\n]+)`")
_PATH = re.compile(r"[\w.@*-]+(?:/[\w.@*-]+)+/?|[\w-]+/|[\w-]+\.(?:py|ts|toml|md|sh|yml)")
_PLACEHOLDER = re.compile(r"(?<![A-Za-z])[A-Z]{3,}(?![A-Za-z])")
_MODULE = re.compile(r"linkwright(?:\.\w+)+")


def named_paths(page: Path) -> Iterator[str]:
    """Return the paths and modules in a page's inline code.

    Placeholders like NAME.py and results of make are left out.
    """
    for words in _WORDS.findall(_FENCE.sub("", page.read_text(encoding="utf-8"))):
        for word in words.split():
            is_ignored = word.split("/")[0] in IGNORED or any(
                f"/{path}".endswith(f"/{word.strip('/')}") for path in IGNORED
            )
            path = _PATH.fullmatch(word) and not (is_ignored or _PLACEHOLDER.search(word) or "/msg/" in word)
            if path or _MODULE.fullmatch(word):
                yield word


@functools.cache
def tracked_paths() -> list[Path]:
    """Return all tracked files and folders of the repository."""
    paths = [
        path
        for folder in FOLDERS
        for path in (REPOSITORY / folder).rglob("*")
        if not {"__pycache__", "node_modules"} & {*path.parts}
    ]
    return [*paths, *(REPOSITORY / folder for folder in FOLDERS), *REPOSITORY.glob("*.*"), *REPOSITORY.glob(".ci/*")]


@functools.cache
def tracked_paths_by_name() -> dict[str, list[Path]]:
    """Return all tracked paths by their last parts."""
    paths_by_name = defaultdict(list)
    for path in tracked_paths():
        paths_by_name[path.name].append(path)
    return paths_by_name


@functools.cache
def other_names() -> str:
    """Return names that look like files or modules but are declared elsewhere.

    These are entry point groups and npm packages.
    """
    names = ("pyproject.toml", "core/pyproject.toml", "frontend/package.json")
    return "".join((REPOSITORY / name).read_text(encoding="utf-8") for name in names)


def path_or_module_exists(word: str) -> bool:
    """Return whether a module exists, or a path that ends with this text.

    The text before it may give the folder.
    """
    if f'"{word}"' in other_names() or f'"{word.split("/")[0]}":' in other_names():
        return True
    if _MODULE.fullmatch(word):
        folder = REPOSITORY / "src" / Path(*word.split("."))
        return any(path.exists() for path in (folder, folder.with_suffix(".py"), folder.parent.with_suffix(".py")))
    name = word.rstrip("/").rpartition("/")[2]
    paths = tracked_paths() if "*" in name else tracked_paths_by_name().get(name, [])
    return any(path.match(word.rstrip("/")) for path in paths)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(REPOSITORY)))
def test_named_files_and_modules_exist(page: Path) -> None:
    words = list(named_paths(page))
    assert words
    assert [word for word in words if not path_or_module_exists(word)] == []


@pytest.mark.parametrize("page", [DOCS / "architecture.md"], ids=lambda page: page.name)
def test_top_level_packages_are_described(page: Path) -> None:
    rooms = {path.parent.name for path in (REPOSITORY / "src" / "linkwright").glob("*/__init__.py")}
    assert rooms - set(re.findall(r"^\| `(\w+)` \|", page.read_text(encoding="utf-8"), re.MULTILINE)) == set()
