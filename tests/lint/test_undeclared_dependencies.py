"""Packages that the build or a Python file requires, but package.xml does not name."""

from __future__ import annotations

import pytest

from linkwright.lint.engine import examine_package
from linkwright.lint.settings import Settings
from tests.lint.manifest import MANIFEST

CATKIN = "<buildtool_depend>catkin</buildtool_depend>"
SETTINGS = Settings(select=("LW812", "LW813"))


def find(tmp_path, files, more="<depend>rclcpp</depend>"):
    """Return the names that the rules report for a package."""
    tmp_path.joinpath("package.xml").write_text(MANIFEST.format(more=more))
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return [str(finding.message).split("'")[1] for finding in examine_package(tmp_path, SETTINGS).diagnostics]


@pytest.mark.parametrize(
    ("command", "names"),
    [
        ("find_package(rosbag2_cpp REQUIRED)", ["rosbag2_cpp"]),
        ("find_package(catkin REQUIRED COMPONENTS tf joy)", ["tf", "joy"]),
        ("find_package(fmt REQUIRED)", []),
        ("find_package(rosbag2_cpp QUIET)", []),
        ("if(WITH_BAG)\n  find_package(rosbag2_cpp REQUIRED)\nendif()", []),
        ("foreach(name cv_bridge rclcpp)\n  find_package(${name} REQUIRED)\nendforeach()", ["cv_bridge"]),
        ("ament_target_dependencies(node PUBLIC rclcpp cv_bridge)", ["cv_bridge"]),
        ("find_package(OpenCV REQUIRED)\nfind_package(Threads REQUIRED)\nfind_package(fmt REQUIRED)", []),
        ("find_package(nlohmann_json REQUIRED)\nfind_package(console_bridge REQUIRED)", []),
        ("find_package(std_msgs REQUIRED)\nfind_package(tf2_ros REQUIRED)\nfind_package(rclcpp_action REQUIRED)", []),
        ("find_package(rosbag2_cpp REQUIRED)\nfind_package(rosbag2_cpp REQUIRED)", ["rosbag2_cpp"]),
    ],
)
def test_packages_that_the_build_requires(tmp_path, command, names):
    assert find(tmp_path, {"CMakeLists.txt": f"project(p)\n{command}\n"}) == names


@pytest.mark.parametrize(("build_type", "names"), [("ament_python", []), ("ament_cmake", ["rosbag2_cpp"])])
def test_build_file_that_the_build_type_does_not_use_requires_nothing(tmp_path, build_type, names):
    export = f"<export><build_type>{build_type}</build_type></export>"
    assert find(tmp_path, {"CMakeLists.txt": "project(p)\nfind_package(rosbag2_cpp REQUIRED)\n"}, export) == names


@pytest.mark.parametrize(
    "more",
    [
        "<build_depend>rosbag2_cpp</build_depend>",
        '<depend condition="$ROS_VERSION == 2">rosbag2_cpp</depend>',
        "<depend>rosbag2_cpp_vendor</depend>",
        "<depend>$name</depend>",
    ],
)
def test_named_packages_are_not_reported(tmp_path, more):
    assert find(tmp_path, {"CMakeLists.txt": "project(p)\nfind_package(rosbag2_cpp REQUIRED)\n"}, more) == []


@pytest.mark.parametrize(
    ("declared", "used", "names"),
    [
        ("ros2_control", "hardware_interface", []),
        ("phidgets_drivers", "phidgets_spatial", []),
        ("velodyne", "velodyne_pointcloud", []),
        ("velodyne", "velodyne_description", ["velodyne_description"]),
        ("ros2_controllers", "diff_drive_controller", []),
    ],
)
def test_dependency_of_a_declared_package_is_not_reported(tmp_path, declared, used, names):
    cmake = f"project(p)\nfind_package({used} REQUIRED)\n"
    assert find(tmp_path, {"CMakeLists.txt": cmake}, f"<depend>{declared}</depend>") == names


def test_components_of_catkin(tmp_path):
    cmake = "project(p)\nfind_package(catkin REQUIRED COMPONENTS roscpp tf image_transport)\n"
    more = f"{CATKIN}<depend>tf</depend>"
    assert find(tmp_path, {"CMakeLists.txt": cmake}, more) == ["image_transport"]


def test_package_of_the_same_repository_needs_no_underscore(tmp_path):
    other = tmp_path / "drivers"
    other.mkdir()
    (other / "package.xml").write_text(MANIFEST.format(more="").replace("<name>p<", "<name>drivers<"))
    folder = tmp_path / "p"
    folder.mkdir()
    assert find(folder, {"CMakeLists.txt": "project(p)\nfind_package(drivers REQUIRED)\n"}) == ["drivers"]


@pytest.mark.parametrize(
    ("path", "text", "names"),
    [
        ("scripts/a.py", "from nav2_msgs.action import NavigateToPose\n", ["nav2_msgs"]),
        ("p/a.py", "import os\nfrom nav2_msgs.srv import Clear\nfrom nav2_msgs.msg import Path\n", ["nav2_msgs"]),
        ("p/a.py", "try:\n    from nav2_msgs.msg import Path\nexcept ImportError:\n    pass\n", []),
        ("p/a.py", '"""Use\nfrom nav2_msgs.msg import Path\n"""\n', []),
        ("p/a.py", "from nav2_msgs.msg import Path\ndef broken(:\n", []),
        ("p/a.py", "from std_msgs.msg import String\nfrom os.path import join\n", []),
        ("p/a.py", "from p.msg import Own\n", []),
        ("test/a.py", "from nav2_msgs.msg import Path\n", []),
        ("p/test_a.py", "from nav2_msgs.msg import Path\n", []),
    ],
)
def test_packages_whose_messages_are_imported(tmp_path, path, text, names):
    assert find(tmp_path, {path: text}) == names


def test_module_of_the_package_itself_is_not_reported(tmp_path):
    files = {"src/vendored/msg.py": "", "src/a.py": "from vendored.msg import X\n"}
    assert find(tmp_path, files) == []


def test_fix_adds_a_depend_element(tmp_path):
    find(
        tmp_path,
        {"CMakeLists.txt": "project(p)\nfind_package(rosbag2_cpp REQUIRED)\n"},
        "\n  <depend>rclcpp</depend>\n",
    )
    (finding,) = examine_package(tmp_path, SETTINGS).diagnostics
    assert [edit.replacement for edit in finding.fix.edits] == ["\n  <depend>rosbag2_cpp</depend>"]


def test_imports_of_python2_sources_are_read(tmp_path):
    text = "import rospy\nfrom arm_msgs.msg import State\nprint 'arm'\ndef f():\n    print 'a'\n"
    assert find(tmp_path, {"scripts/arm.py": text}) == ["arm_msgs"]


def test_invalid_escapes_in_a_file_give_no_warnings(tmp_path, recwarn):
    text = "import re\nfrom nav2_msgs.srv import Clear\nPATTERN = re.compile('\\d')\n"
    assert find(tmp_path, {"p/__init__.py": "", "p/node.py": text}) == ["nav2_msgs"]
    assert not recwarn.list


@pytest.mark.parametrize(
    ("used", "codes"), [("p4_description", ["LW848"]), ("p_description", ["LW848"]), ("p3_descripton", [])]
)
def test_package_of_another_robot_of_a_family_is_no_misspelling(tmp_path, used, codes):
    tmp_path.joinpath("package.xml").write_text(MANIFEST.format(more="").replace("<name>p<", "<name>p3_description<"))
    launch = tmp_path / "launch" / "show.launch"
    launch.parent.mkdir()
    launch.write_text(f'<launch><node pkg="{used}" exec="show"/></launch>')
    findings = examine_package(tmp_path, Settings(select=("LW848",))).diagnostics
    assert [finding.code for finding in findings] == codes
