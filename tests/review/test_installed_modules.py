"""Executables of ``setup.py`` whose module is not installed in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

MANIFEST = PACKAGE_XML.replace("arm_description", "arm")
SETUP = """from setuptools import find_packages, setup
setup(name='arm', packages={packages}, entry_points={{'console_scripts': ['go = {module}:main']}})
"""
PROGRAM = "def main():\n    print('go')\n"
FOUND = "find_packages(exclude=['test'])"


def move_module(repository, compare, packages: str, *others: str):
    old = SETUP.format(packages=packages, module="arm.go")
    new = SETUP.format(packages=packages, module="arm.tools.go")
    files = {"arm/package.xml": MANIFEST, "arm/setup.py": old, "arm/arm/__init__.py": "", "arm/arm/go.py": PROGRAM}
    repository.commit(files)
    moved = {"arm/setup.py": new, "arm/arm/go.py": None, "arm/arm/tools/go.py": PROGRAM}
    repository.commit({**moved, **dict.fromkeys(others, "")})
    return breaking(compare(repository, "HEAD~1..HEAD"))


@pytest.mark.parametrize(
    ("packages", "fault"),
    [
        (FOUND, "find_packages() does not install 'arm.tools', which has no __init__.py"),
        ("['arm']", "setup.py does not install the Python package 'arm.tools' of its module"),
    ],
)
def test_executable_in_a_folder_that_is_not_installed_is_breaking(repository, compare, packages, fault):
    assert f"executable 'go': {fault}" in move_module(repository, compare, packages)


@pytest.mark.parametrize("packages", [FOUND, "['arm', 'arm.tools']", "find_namespace_packages()"])
def test_executable_in_an_installed_folder_starts(repository, compare, packages):
    found = move_module(repository, compare, packages, "arm/arm/tools/__init__.py")
    assert not [text for text in found if text.startswith("executable")]


def test_executable_that_was_not_installed_before_is_not_told_again(repository, compare):
    setup = SETUP.format(packages=FOUND, module="arm.tools.go")
    files = {"arm/package.xml": MANIFEST, "arm/setup.py": setup, "arm/arm/__init__.py": ""}
    repository.commit({**files, "arm/arm/tools/go.py": PROGRAM})
    repository.commit({"arm/setup.py": setup.replace("name='arm'", "name='arm', zip_safe=True")})
    assert breaking(compare(repository, "HEAD~1..HEAD")) == []
