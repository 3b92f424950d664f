"""The lines of a review about programs that become executable or are no longer."""

from __future__ import annotations

import pytest

from linkwright.review.reports.text import as_text
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

LAUNCH = '<launch><node pkg="arm" exec="drive.py" name="drive"/></launch>\n'


@pytest.mark.parametrize(
    ("launch", "is_executable", "found"),
    [
        (LAUNCH, False, ["no longer executable"]),
        (LAUNCH.replace("drive.py", "overdrive.py"), False, []),
        (LAUNCH, True, []),
    ],
)
def test_a_started_program_that_is_no_longer_executable_is_breaking(repository, compare, launch, is_executable, found):
    path = "arm/scripts/drive.py"
    repository.commit({path: "print(1)\n", "arm/launch/arm.launch.xml": launch})
    for change in ("-x", "+x") if is_executable else ("+x", "-x"):
        repository.git("update-index", f"--chmod={change}", path)
        repository.git("commit", "-q", "--allow-empty", "-m", "The mode")
    result = compare(repository, "HEAD~1..HEAD")
    assert breaking(result) == found
    assert ("executable now" if is_executable else "no longer executable") in as_text(result)


@pytest.mark.parametrize(
    ("content", "found"), [("rate: 1\n", []), ("#!/usr/bin/env drive\nrate: 1\n", ["no longer executable"])]
)
def test_a_data_file_is_not_a_program(repository, compare, content, found):
    path = "arm/config/drive.yaml"
    launch = LAUNCH.replace("drive.py", path)
    repository.commit({path: content, "arm/launch/arm.launch.xml": launch})
    for mode in ("+x", "-x"):
        repository.git("update-index", f"--chmod={mode}", path)
        repository.git("commit", "-q", "--allow-empty", "-m", "The mode")
    assert breaking(compare(repository, "HEAD~1..HEAD")) == found


@pytest.mark.parametrize(
    ("command", "is_made"),
    [
        ("catkin_install_python(PROGRAMS scripts/drive.py DESTINATION bin)", True),
        ("install(PROGRAMS scripts/drive.py DESTINATION lib/arm)", True),
        ("install(DIRECTORY scripts DESTINATION lib/arm USE_SOURCE_PERMISSIONS)", False),
        ("# install(PROGRAMS scripts/drive.py DESTINATION lib/arm)", False),
    ],
)
def test_a_script_that_the_build_makes_executable_starts_once_it_is_installed(repository, compare, command, is_made):
    path = "arm/scripts/drive.py"
    files = {"arm/package.xml": PACKAGE_XML, "arm/CMakeLists.txt": f"project(arm)\n{command}\n"}
    repository.commit({**files, path: "print(1)\n", "arm/launch/arm.launch.xml": LAUNCH})
    for change in ("+x", "-x"):
        repository.git("update-index", f"--chmod={change}", path)
        repository.git("commit", "-q", "--allow-empty", "-m", "The mode")
    ((_, change),) = compare(repository, "HEAD~1..HEAD").breaking_changes
    assert ("once it is installed" in str(change.reason)) is is_made
