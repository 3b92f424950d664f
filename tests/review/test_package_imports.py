"""The lines of a review about the ``__init__.py`` of installed Python packages."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

SETUP = "from setuptools import setup\nsetup(name='arm', version='1.0.0', packages=['arm'])\n"
FILES = {
    "package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "setup.py": SETUP,
    "arm/driver.py": "class Driver: ...\nclass Gripper: ...\n",
}
INIT = "import os\nfrom .driver import Driver\n"


@pytest.fixture
def review_lines(repository, compare):
    """Review a replacement of ``arm/__init__.py``.

    Return the sentences except those about all imports.
    """

    def run(old, new, files=FILES):
        repository.commit({**files, "arm/__init__.py": old})
        repository.write({"arm/__init__.py": new})
        result = compare(repository)
        found = [sentence for subject in result.subjects for sentence in sentences(subject)]
        return [sentence for sentence in found if not sentence.startswith("imports ")], breaking(result)

    return run


@pytest.mark.parametrize(
    ("new", "expected", "is_breaking"),
    [
        (INIT.replace("Driver", "Driver, Gripper"), "names of the package added: 'Gripper'", False),
        ("import os\n", "names of the package removed: 'Driver'", True),
        (INIT.replace("Driver", "DriverNode"), "name of the package 'Driver' renamed to 'DriverNode'", True),
        (INIT + "__all__ = ['Driver', 'park']\n", "names of the package added: 'park'", False),
        (INIT + "from driver import Gripper\n", "absolute import of 'driver', a module of the same package", True),
    ],
)
def test_names_and_failing_imports_of_an_installed_package_are_told(review_lines, new, expected, is_breaking):
    assert review_lines(INIT, new) == ([expected], [expected] if is_breaking else [])


@pytest.mark.parametrize(
    "new",
    [
        "from .driver import Driver\n",  # a name of another package
        "import os\nfrom arm.driver import Driver\n",
        "import os\nfrom .driver import *\n",
        INIT + "import logging\n",
    ],
)
def test_names_of_other_packages_and_names_that_are_still_there_are_not_told(review_lines, new):
    assert review_lines(INIT, new, {**FILES, "arm/logging.py": ""}) == ([], [])


def test_a_package_that_is_not_installed_has_no_names_for_others(review_lines):
    files = {**FILES, "setup.py": SETUP.replace("['arm']", "[]")}
    assert review_lines(INIT, "import os\nfrom driver import Gripper\n", files) == ([], [])


def test_python_2_finds_a_module_beside_the_file(review_lines):
    manifest = PACKAGE_XML.replace("arm_description", "arm").replace(
        "</package>", "  <buildtool_depend>catkin</buildtool_depend>\n</package>"
    )
    assert review_lines(INIT, INIT + "from driver import park\n", {**FILES, "package.xml": manifest}) == ([], [])


@pytest.mark.parametrize(
    ("old", "lost"),
    [
        ("from . import driver\n", []),
        ("from arm import driver\n", []),
        ("from .driver import Driver as driver\n", ["names of the package removed: 'driver'"]),
        ("from . import other\n", ["names of the package removed: 'other'"]),
    ],
)
def test_a_module_of_the_package_can_be_imported_although_the_package_no_longer_does(review_lines, old, lost):
    assert review_lines(old, "import os\n") == (lost, lost)
