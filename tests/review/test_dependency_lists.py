"""Lists of repositories and of Python packages in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

REPOS = """repositories:
  driver:
    type: git
    url: https://example.org/driver.git
    version: main
  maps:
    type: git
    url: https://example.org/maps.git
"""
ROSINSTALL = """- git: {local-name: driver, uri: https://example.org/driver.git, version: main}
- tar: {local-name: maps, uri: https://example.org/maps.tar}
"""
REQUIREMENTS = "numpy>=1.2  # arrays\npyserial\n-r other.txt\n"


@pytest.mark.parametrize(
    ("name", "text", "old", "new", "expected"),
    [
        ("deps.repos", REPOS, "main", "1.2.0", ["repository 'driver': version main -> 1.2.0"]),
        ("deps.repos", REPOS, "example.org/maps", "example.com/maps",
         ["repository 'maps': url https://example.org/maps.git -> https://example.com/maps.git"]),
        ("deps.repos", REPOS, "  maps:", "  images:",
         ["repository 'images' added: type git, url https://example.org/maps.git",
          "repository 'maps' removed: type git, url https://example.org/maps.git"]),
        ("deps.repos", REPOS, "    version: main\n", "", ["repository 'driver': version main -> -"]),
        ("ws.rosinstall", ROSINSTALL, "main", "devel", ["repository 'driver': version main -> devel"]),
        ("src/a.rosinstall", ROSINSTALL, ROSINSTALL.splitlines(keepends=True)[1], "",
         ["repository 'maps' removed: type tar, url https://example.org/maps.tar"]),
        ("requirements.txt", REQUIREMENTS, ">=1.2", "==2.0", ["Python package 'numpy': version >=1.2 -> ==2.0"]),
        ("requirements-dev.txt", REQUIREMENTS, "pyserial", "pyserial\npytest<9",
         ["Python package 'pytest' added: <9"]),
        ("requirements.txt", REQUIREMENTS, "-r other.txt\n", "", ["Python package '-r other.txt' removed"]),
    ],
)  # fmt: skip
def test_entries_of_lists_of_dependencies_are_compared(repository, compare, name, text, old, new, expected):
    assert old in text
    repository.commit({name: text})
    repository.write({name: text.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, name)) == expected
    assert breaking(result) == []


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("deps.repos", REPOS, "list of repositories added: driver, maps"),
        ("requirements.txt", REQUIREMENTS, "list of Python packages added: numpy, pyserial, -r other.txt"),
    ],
)
def test_added_list_of_dependencies_has_its_entries(repository, compare, name, text, expected):
    repository.commit({"README.md": ""})
    repository.write({name: text})
    assert sentences(subject(compare(repository), name)) == [expected]


def test_comment_in_a_list_of_dependencies_is_listed_with_the_other_files(repository, compare):
    repository.commit({"deps.repos": REPOS})
    repository.write({"deps.repos": f"# ours\n{REPOS}"})
    assert compare(repository).other_files == ["deps.repos"]


def test_huge_list_is_not_read(repository, compare):
    repository.commit({"deps.repos": REPOS})
    repository.write({"deps.repos": REPOS + "# comment\n" * 500_000})
    (found,) = compare(repository).subjects
    (problem,) = found.problems
    assert str(problem.text) == "the new version cannot be read: it is larger than 4 MB"
