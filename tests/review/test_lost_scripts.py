"""Commands that start a removed program, and removed programs of ROS 1 that no build file installs."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

SCRIPT = "#!/usr/bin/env python3\nprint('arm')\n"
MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PATH = "arm/scripts/check.py"


def find_breaking(repository, compare, files: dict[str, str], new: dict[str, str | None]) -> list[str]:
    repository.commit({**MANIFEST, PATH: SCRIPT, **files})
    repository.commit(new)
    return breaking(compare(repository, "HEAD~..HEAD"))


@pytest.mark.parametrize(
    ("caller", "line", "name"),
    [
        ("Makefile", "\tpython3 arm/scripts/check.py --fast", "arm/scripts/check.py"),
        (".github/workflows/ci.yml", "      - run: ./arm/scripts/check.py", "./arm/scripts/check.py"),
        (".gitlab-ci.yml", "    - python3 arm/scripts/check.py -v", "arm/scripts/check.py"),
        ("Dockerfile", "COPY arm/scripts/check.py /usr/bin/", "arm/scripts/check.py"),
        ("arm/run.sh", "scripts/check.py &", "scripts/check.py"),
    ],
)
@pytest.mark.parametrize("new", [{PATH: None}, {PATH: None, "arm/scripts/test.py": SCRIPT}])
def test_command_that_names_a_removed_script_is_breaking(repository, compare, caller, line, name, new):
    expected = f"names '{name}', which no longer exists"
    assert find_breaking(repository, compare, {caller: f"a: b\n{line}\n"}, new) == [expected]


@pytest.mark.parametrize(
    ("caller", "line"),
    [
        ("Makefile", "\t# python3 arm/scripts/check.py"),
        ("Makefile", "\techo arm/scripts/check.py"),
        ("Makefile", "\trm -f arm/scripts/check.py"),
        (".github/workflows/ci.yml", "      - arm/scripts/check.py"),
        ("run.sh", "[ -x arm/scripts/check.py ] && arm/scripts/check.py"),
        ("run.sh", "other/arm/scripts/check.py"),
        ("run.sh", "$HOME/arm/scripts/check.py"),
        ("notes.md", "arm/scripts/check.py"),
    ],
)
def test_line_that_starts_no_removed_script_is_not_breaking(repository, compare, caller, line):
    assert find_breaking(repository, compare, {caller: f"a: b\n{line}\n"}, {PATH: None}) == []


@pytest.mark.parametrize("command", ["rosrun arm check.py", "ros2 run arm check.py"])
def test_command_that_runs_a_removed_executable_is_breaking(repository, compare, command):
    build = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\n"
    install = "install(PROGRAMS scripts/check.py DESTINATION lib/${PROJECT_NAME})\n"
    files = {"run.sh": f"{command} --fast\n", "arm/CMakeLists.txt": build + install}
    found = find_breaking(repository, compare, files, {PATH: None, "arm/CMakeLists.txt": build})
    assert "starts 'arm/check.py', which no longer exists" in found


@pytest.mark.parametrize(
    ("caller", "line", "expected"),
    [
        ("arm.service", "ExecStart=/usr/sbin/check", ["names '/usr/sbin/check', which is no longer installed"]),
        ("Dockerfile", "CMD /opt/ws/install/arm/lib/arm/check", [
            "names '/opt/ws/install/arm/lib/arm/check', which is no longer installed"]),
        ("arm.service", "ExecStart=/usr/sbin/checker", []),
        ("arm.service", "ExecStart=$HOME/bin/check", []),
        ("arm.service", "#ExecStart=/usr/sbin/check", []),
    ],
)  # fmt: skip
def test_command_that_starts_a_program_which_is_no_longer_installed_is_breaking(
    repository, compare, caller, line, expected
):
    build = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\n"
    install = "install(PROGRAMS scripts/check DESTINATION /usr/sbin)\n"
    files = {caller: f"a=b\n{line}\n", "arm/CMakeLists.txt": build + install, "arm/scripts/check": SCRIPT}
    found = find_breaking(repository, compare, files, {"arm/CMakeLists.txt": build})
    assert sorted(found) == sorted(["installed executables removed: 'check'", *expected])


@pytest.mark.parametrize("caller", ["docker/docker-compose.yml", "compose.dev.yaml", "start.sh"])
@pytest.mark.parametrize(
    ("command", "new", "is_lost"),
    [
        ("ros2 launch arm move.launch.py", {"arm/launch/move.launch.py": None}, True),
        ("ros2 launch other move.launch.py", {"arm/launch/move.launch.py": None}, False),
        ("ros2 launch arm move.launch.py", {
            "arm/launch/move.launch.py": None, "arm/launch/b/move.launch.py": "x = 1\n"}, False),
    ],
)  # fmt: skip
def test_command_that_starts_a_removed_launch_file_is_breaking(repository, compare, caller, command, new, is_lost):
    files = {caller: f"a:\n  command: bash -c '{command}'\n", "arm/launch/move.launch.py": "x = 1\n"}
    found = find_breaking(repository, compare, files, new)
    assert ("starts 'arm/move.launch.py', which no longer exists" in found) is is_lost


@pytest.mark.parametrize(
    ("is_executable", "new", "expected"),
    [
        (True, {PATH: None, "arm/scripts/test.py": SCRIPT}, ["program 'check.py' renamed to 'test.py'"]),
        (True, {PATH: None}, ["program 'check.py' removed"]),
        (True, {PATH: None, "arm/nodes/check.py": SCRIPT}, []),
        (False, {PATH: None}, []),
    ],
)
def test_lost_program_of_ros1_is_breaking(repository, compare, is_executable, new, expected):
    depend = "<buildtool_depend>catkin</buildtool_depend><exec_depend>"
    manifest = MANIFEST["arm/package.xml"].replace("<exec_depend>", depend)
    build = {"arm/CMakeLists.txt": "project(arm)\nfind_package(catkin REQUIRED)\ncatkin_package()\n"}
    repository.commit({PATH: SCRIPT})
    repository.root.joinpath(PATH).chmod(0o755 if is_executable else 0o644)
    assert find_breaking(repository, compare, {"arm/package.xml": manifest, **build}, new) == expected


@pytest.mark.parametrize(
    ("command", "name"),
    [
        ("ros2 launch arm other.launch.py &", "other.launch.py"),
        ("roslaunch arm other.launch", "other.launch"),
        ("ros2 run arm drive.py", "drive.py"),
        ("ros2 run arm driver", "driver"),
        ("ros2 launch arm arm.launch.py", None),
        ("ros2 run arm check.py", None),
        ("ros2 launch nav2_bringup other.launch.py", None),
        ("ros2 launch arm $FILE", None),
        ("echo 'ros2 launch arm other.launch.py'", None),
        ("# ros2 launch arm other.launch.py", None),
    ],
)
@pytest.mark.parametrize("old", [None, "ros2 launch arm first.launch.py\n"])
def test_a_new_command_that_starts_what_its_package_never_had_is_breaking(repository, compare, command, name, old):
    build = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\n"
    install = "install(PROGRAMS scripts/check.py DESTINATION lib/${PROJECT_NAME})\n"
    files = {"arm/CMakeLists.txt": build + install, "arm/launch/arm.launch.py": "", "start.sh": old or ""}
    found = find_breaking(repository, compare, files, {"start.sh": f"{old or ''}{command}\n"})
    assert found == ([] if name is None else [f"starts 'arm/{name}', which does not exist"])


GUARDED = """if {test}; then
  python3 arm/scripts/check.py
elif true; then
  {second}
else
  {third}
fi
{last}
"""
COMMAND = "python3 arm/scripts/check.py"


@pytest.mark.parametrize(
    ("test", "second", "third", "last", "count"),
    [
        ('[ -e "$FOLDER/check.py" ]', ":", ":", ":", 0),
        ("test -f arm/scripts/check.py", ":", ":", ":", 0),
        ("command -v check.py", ":", ":", ":", 0),
        ("[ -e arm/scripts/other.py ]", ":", ":", ":", 1),
        ("[ ! -e arm/scripts/check.py ]", ":", ":", ":", 1),
        ("[ -e arm/scripts/check.py ]", COMMAND, COMMAND, COMMAND, 3),
    ],
)
def test_command_that_a_script_only_runs_if_the_file_exists_is_not_breaking(
    repository, compare, test, second, third, last, count
):
    text = GUARDED.format(test=test, second=second, third=third, last=last)
    found = find_breaking(repository, compare, {"run.sh": text}, {PATH: None})
    assert found == ["names 'arm/scripts/check.py', which no longer exists"] * count
