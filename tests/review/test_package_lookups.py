"""Files that look for the files of another package than before."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

PYTHON = """import os
from ament_index_python.packages import get_package_share_directory
def find():
    return os.path.join(get_package_share_directory('drivers'), 'config', 'a.yaml')
"""
LAUNCH = """from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    file = get_package_share_path('drivers') / 'a.yaml'
    return LaunchDescription([Node(package='arm', executable='run', parameters=[file])])
"""
XML = '<launch><node pkg="arm" exec="run"><param from="$(find-pkg-share drivers)/a.yaml"/></node></launch>\n'
CPP = 'int main() { load(ament_index_cpp::get_package_share_directory("drivers") + "/a.yaml"); }\n'
ROS1 = "import rospkg\nPATH = rospkg.RosPack().get_path('drivers')\n"
EXPECTED = "looks for files of 'motors' instead of 'drivers', but package.xml does not name 'motors'"


def run(repository, compare, path, text, *, dependencies=(), more=None, new="motors"):
    """Return the breaking changes of a file that names another package."""
    lines = "".join(f"<exec_depend>{name}</exec_depend>" for name in dependencies)
    manifest = PACKAGE_XML.replace("arm_description", "arm").replace("</license>", f"</license>{lines}")
    assert "drivers" in text
    repository.commit({"arm/package.xml": manifest, f"arm/{path}": text, **(more or {})})
    repository.write({f"arm/{path}": text.replace("drivers", new)})
    return [line for line in breaking(compare(repository)) if "looks for" in line]


@pytest.mark.parametrize(
    ("path", "text"),
    [
        ("arm/find.py", PYTHON),
        ("arm/find.py", ROS1),
        ("launch/arm.launch.py", LAUNCH),
        ("launch/arm.launch.xml", XML),
        ("src/run.cpp", CPP),
    ],
)
def test_package_on_which_the_own_one_does_not_depend_is_breaking(repository, compare, path, text):
    assert run(repository, compare, path, text) == [EXPECTED]
    repository.git("checkout", "--quiet", ".")


@pytest.mark.parametrize(
    ("dependencies", "more", "new"),
    [
        (("motors",), {}, "motors"),
        ((), {"motors/package.xml": PACKAGE_XML.replace("arm_description", "motors")}, "motors"),
        ((), {}, "arm"),
        ((), {}, "tf2_ros"),
    ],
)
def test_package_that_is_there_is_not_breaking(repository, compare, dependencies, more, new):
    lines = run(repository, compare, "arm/find.py", PYTHON, dependencies=dependencies, more=more, new=new)
    assert lines == []


def test_added_package_is_not_another_one(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/arm/find.py": PYTHON})
    repository.write({"arm/arm/find.py": PYTHON + "PATH = get_package_share_directory('motors')\n"})
    assert breaking(compare(repository)) == []


def test_renamed_package_is_the_same_one(repository, compare):
    manifest = PACKAGE_XML.replace("arm_description", "drivers")
    repository.commit({"drivers/package.xml": manifest, "arm/package.xml": PACKAGE_XML, "arm/arm/find.py": PYTHON})
    repository.write(
        {
            "drivers/package.xml": None,
            "motors/package.xml": manifest.replace("drivers", "motors"),
            "arm/arm/find.py": PYTHON.replace("drivers", "motors"),
        }
    )
    assert not [line for line in breaking(compare(repository)) if "looks for" in line]
