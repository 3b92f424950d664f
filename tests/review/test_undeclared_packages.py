"""The lines of a review about packages that a package needs now and does not declare."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking

MANIFEST = "<package format='2'><name>lamp</name><version>1.0.0</version>{}</package>\n"
CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject(lamp)\nfind_package(catkin REQUIRED COMPONENTS roscpp{})\n"
BUILD_REASON = "package.xml does not name '{}', without which the build fails"
IMPORT_REASON = "package.xml does not name '{}', without which the import fails"
GUARDED = "try:\n    import serial\nexcept ImportError:\n    serial = None\n"


@pytest.mark.parametrize(
    ("path", "old", "new", "depend", "reason"),
    [
        ("CMakeLists.txt", CMAKE.format(""), CMAKE.format(" light_finder"), "", BUILD_REASON.format("light_finder")),
        ("CMakeLists.txt", CMAKE.format(""), CMAKE.format(" light_finder"), "light_finder", None),
        ("CMakeLists.txt", CMAKE.format(""), CMAKE.format(" tf"), "", BUILD_REASON.format("tf")),
        ("CMakeLists.txt", CMAKE.format(""), CMAKE.format(" tf"), "tf", None),
        ("CMakeLists.txt", CMAKE.format(""), CMAKE.format(" rospy"), "catkin", None),
        ("src/a.cpp", "", "#include <light_msgs/Level.h>\n", "", BUILD_REASON.format("light_msgs")),
        ("src/a.cpp", "", '#include "light_msgs/msg/level.hpp"\n', "", BUILD_REASON.format("light_msgs")),
        ("src/a.cpp", "", "#include <light_msgs/Level.h>\n", "light_msgs", None),
        ("src/a.cpp", "", "#include <light_msgs/helpers.hpp>\n", "", None),
        ("src/a.cpp", "", "#include <sensor_msgs/Image.h>\n", "", None),
        ("a.py", "", "from light_msgs.msg import Level\n", "", IMPORT_REASON.format("light_msgs")),
        ("a.py", "", "from light_msgs.msg import Level\n", "light_msgs", None),
        ("a.py", "", "import serial\n", "", IMPORT_REASON.format("serial")),
        ("a.py", "", "import serial\n", "python3-serial", None),
        ("a.py", "", "from multipledispatch import dispatch\n", "", IMPORT_REASON.format("multipledispatch")),
        ("a.py", "", "from multipledispatch import dispatch\n", "python3-multipledispatch-pip", None),
        ("a.py", "", "import busio\n", "python3-adafruit-blinka-pip", None),
        ("a.py", "", GUARDED, "", None),
        ("a.py", "", "import numpy\n", "", None),
        ("a.py", "", "import tf\n", "", IMPORT_REASON.format("tf")),
        ("a.py", "", "import tf\n", "light_navigation", None),
    ],
)
def test_an_undeclared_package_is_breaking(repository, compare, path, old, new, depend, reason):
    dependency = f"<depend>{depend}</depend>" if depend else ""
    repository.commit({"lamp/package.xml": MANIFEST.format(dependency), f"lamp/{path}": old})
    repository.write({f"lamp/{path}": new})
    result = compare(repository)
    assert [str(change.reason) for _, change in result.breaking_changes] == ([reason] if reason else [])
    assert result.new_findings == []


@pytest.mark.parametrize(
    ("dependencies", "own", "is_breaking"),
    [
        ([], "light_driver", True),
        (["rospy", "light_msgs", "python3-serial"], "light_driver", True),
        (["light_driver"], "light_driver", False),
        (["light_suite"], "light_driver", False),
        ([], "other_driver", False),
    ],
)
def test_an_imported_package_that_another_manifest_names(repository, compare, dependencies, own, is_breaking):
    depend = "".join(f"<depend>{name}</depend>" for name in ("catkin", *dependencies))
    other = MANIFEST.replace("lamp", "torch").format(f"<depend>{own}</depend>")
    repository.commit({"lamp/package.xml": MANIFEST.format(depend), "lamp/a.py": "", "torch/package.xml": other})
    repository.write({"lamp/a.py": "from light_driver.node import LightNode\n"})
    result = compare(repository)
    reasons = [str(change.reason) for _, change in result.breaking_changes]
    assert reasons == ([IMPORT_REASON.format("light_driver")] if is_breaking else [])


def test_an_undeclared_package_of_a_new_package_is_a_finding(repository, compare):
    repository.commit({"README.md": "lamps\n"})
    repository.write({"lamp/package.xml": MANIFEST.format(""), "lamp/a.py": "from light_msgs.msg import Level\n"})
    result = compare(repository)
    assert breaking(result) == []
    assert "LW813" in [finding.code for finding in result.new_findings]


@pytest.mark.parametrize(
    ("path", "text", "is_breaking"),
    [
        ("README.md", "Start dimmer.py by hand.\n", False),
        ("lamp/setup.py", "import setuptools\nsetuptools.setup(scripts=['dimmer.py'])\n", True),
        ("lamp/a.py", "import dimmer\n", True),
        ("lamp/start.sh", "python3 dimmer.py\n", True),
    ],
)
def test_an_added_script_that_nothing_starts_breaks_nothing(repository, compare, path, text, is_breaking):
    repository.commit({"lamp/package.xml": MANIFEST.format(""), "lamp/a.py": "", path: text})
    repository.write({"lamp/dimmer.py": "import serial\n"})
    assert breaking(compare(repository)) == ["packages imported for the first time: 'serial'"] * is_breaking


@pytest.mark.parametrize("name", ["requirements.txt", "Dockerfile", "install.sh"])
def test_a_project_that_a_file_of_the_repository_installs(repository, compare, name):
    repository.commit({"lamp/package.xml": MANIFEST.format(""), "lamp/a.py": "", name: "pip install pyserial\n"})
    repository.write({"lamp/a.py": "import serial\n"})
    assert breaking(compare(repository)) == []


DIMMER = '<launch><node pkg="dimmer" exec="dim" name="dim"/></launch>\n'


@pytest.mark.parametrize(
    ("new", "launch", "is_breaking"),
    [
        ("", DIMMER, True),
        ("<!-- <exec_depend>dimmer</exec_depend> -->", DIMMER, True),
        ("<exec_depend>dimmer_suite</exec_depend>", DIMMER, False),
        ("", DIMMER.replace("/></launch>", ' if="false"/></launch>'), False),
        ("", DIMMER.replace('"dimmer"', '"other"'), False),
    ],
)
def test_a_removed_dependency_that_a_launch_file_uses_is_breaking(repository, compare, new, launch, is_breaking):
    old = MANIFEST.format("<buildtool_depend>ament_cmake</buildtool_depend><exec_depend>dimmer</exec_depend>")
    repository.commit({"lamp/package.xml": old, "lamp/launch/lamp.launch.xml": launch})
    repository.write({"lamp/package.xml": old.replace("<exec_depend>dimmer</exec_depend>", new)})
    reasons = [str(change.reason) for _, change in compare(repository).breaking_changes]
    expected = "lamp/launch/lamp.launch.xml still uses 'dimmer', and no package.xml names it"
    assert reasons == ([expected] if is_breaking else [])


@pytest.mark.parametrize(
    ("text", "is_breaking"), [("<!-- <exec_depend>dimmer</exec_depend> -->", True), ("<url>dimmer</url>", False)]
)
def test_a_package_that_only_a_comment_names_is_new(repository, compare, text, is_breaking):
    old = '<launch>{}<node pkg="lamp" exec="lamp"/></launch>\n'
    repository.commit({"lamp/package.xml": MANIFEST.format(text), "lamp/launch/lamp.launch.xml": old.format("")})
    node = '<node pkg="dimmer" exec="dim"/>'
    repository.write({"lamp/launch/lamp.launch.xml": old.format(node)})
    reasons = [str(change.reason) for _, change in compare(repository).breaking_changes]
    expected = "package.xml does not name 'dimmer', without which the node does not start"
    assert reasons == ([expected] if is_breaking else [])
