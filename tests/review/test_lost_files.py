"""The lines of a review about installed files, headers and modules that are gone."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

CMAKE = """cmake_minimum_required(VERSION 3.8)
project(arm)
install(DIRECTORY include/ DESTINATION include)
install(DIRECTORY scripts/ DESTINATION lib/${PROJECT_NAME} USE_SOURCE_PERMISSIONS)
ament_python_install_package(${PROJECT_NAME})
"""
SETUP = """from setuptools import setup, find_packages
setup(name="arm", packages=find_packages(exclude=["test"]))
"""
CATKIN_SETUP = """from distutils.core import setup
from catkin_pkg.python_setup import generate_distutils_setup
setup(**generate_distutils_setup(packages=["arm"], package_dir={"": "src"}))
"""
CATKIN_ITEMS = """from distutils.core import setup
from catkin_pkg.python_setup import generate_distutils_setup
settings = generate_distutils_setup()
settings["packages"] = ["arm"]
settings["package_dir"] = {"": "src"}
setup(**settings)
"""
HEADER = "namespace arm {\nclass Driver {\n};\n}\n"
FILES = {
    "a/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "a/CMakeLists.txt": CMAKE,
    "a/include/arm/driver.hpp": HEADER,
    "a/include/arm/motor.hpp": "#define MOTORS 6\n",
    "a/scripts/home.sh": "#!/bin/sh\necho home\n",
    "a/scripts/rest.sh": "#!/bin/sh\necho rest\n",
    "a/arm/__init__.py": "",
    "a/arm/tools.py": "RATE = 10\n",
    "a/arm/driver.py": "def main():\n    print('driver')\n",
    "a/src/motor.cpp": "int motors = 6;\n",
}


@pytest.mark.parametrize(
    ("changes", "expected", "is_breaking"),
    [
        ({"a/include/arm/motor.hpp": None}, ["no longer installed: 'include/arm/motor.hpp'"], True),
        ({"a/include/arm/motor.hpp": None, "a/include/arm/motors.hpp": "#define MOTORS 6\n"},
         ["no longer installed: 'include/arm/motor.hpp'"], True),
        ({"a/scripts/home.sh": None}, ["no longer installed: 'lib/arm/home.sh'"], True),
        ({"a/arm/tools.py": None}, ["installed Python modules removed: 'arm.tools'"], True),
        ({"a/arm/tools.py": None, "a/arm/helpers.py": "RATE = 10\n"},
         ["Python module 'arm.tools' renamed to 'arm.helpers'"], True),
        ({"a/arm/driver.py": None}, ["installed Python modules removed: 'arm.driver'"], False),
        ({"a/src/motor.cpp": None}, [], False),
    ],
)  # fmt: skip
def test_files_that_are_no_longer_installed_are_reported(repository, compare, changes, expected, is_breaking):
    repository.commit(FILES)
    repository.commit(changes)
    result = compare(repository, "HEAD~1..HEAD")
    assert [sentence for found in result.subjects for sentence in sentences(found)] == expected
    assert bool(breaking(result)) is is_breaking


@pytest.mark.parametrize(("setup", "folder"), [(SETUP, "arm"), (CATKIN_SETUP, "src/arm"), (CATKIN_ITEMS, "src/arm")])
def test_modules_that_setup_installs_are_compared(repository, compare, setup, folder):
    modules = {f"a/{folder}/__init__.py": "", f"a/{folder}/tools.py": "RATE = 10\n"}
    repository.commit({"a/package.xml": FILES["a/package.xml"], "a/setup.py": setup, **modules})
    repository.commit({f"a/{folder}/tools.py": None})
    found = subject(compare(repository, "HEAD~1..HEAD"), "a/setup.py")
    assert sentences(found) == ["installed Python modules removed: 'arm.tools'"]


def test_class_of_a_header_that_is_not_installed_is_no_interface(repository, compare):
    repository.commit(
        {**FILES, "a/CMakeLists.txt": CMAKE.replace("install(DIRECTORY include/ DESTINATION include)", "")}
    )
    repository.write({"a/include/arm/driver.hpp": HEADER.replace("Driver", "Motor")})
    assert breaking(compare(repository)) == []


def test_renamed_class_of_a_header_in_a_folder_that_catkin_exports_is_breaking(repository, compare):
    cmake = "project(arm)\nfind_package(catkin REQUIRED)\ncatkin_package(INCLUDE_DIRS include)\n"
    repository.commit({**FILES, "a/CMakeLists.txt": cmake})
    repository.write({"a/include/arm/driver.hpp": HEADER.replace("Driver", "ArmDriver")})
    assert breaking(compare(repository)) == ["class 'Driver' renamed to 'ArmDriver'"]


def test_removed_class_of_an_installed_header_is_breaking(repository, compare):
    repository.commit(FILES)
    repository.write({"a/include/arm/driver.hpp": HEADER.replace("class Driver {\n};\n", "")})
    assert breaking(compare(repository)) == ["classes removed: 'Driver'"]


EXPORT = "ament_export_include_directories(include)\n"
LIBRARY = "project(arm)\nadd_library(core src/core.cpp)\n{}\ninstall(TARGETS core {} DESTINATION lib)\n"
FILE_SET = "target_sources(core PUBLIC FILE_SET HEADERS BASE_DIRS include FILES include/arm/{}.hpp)"
PROPERTIES = "set_target_properties(core PROPERTIES VERSION 1 PUBLIC_HEADER include/arm/driver.hpp)"


@pytest.mark.parametrize(
    ("cmake", "is_interface"),
    [
        (LIBRARY.format(EXPORT, ""), False),
        (LIBRARY.format(FILE_SET.format("driver"), ""), False),
        (LIBRARY.format(FILE_SET.format("driver"), "FILE_SET HEADERS"), True),
        (LIBRARY.format(FILE_SET.format("other"), "FILE_SET HEADERS"), False),
        (LIBRARY.format(PROPERTIES, "PUBLIC_HEADER"), True),
        (LIBRARY.format(PROPERTIES, ""), False),
        (LIBRARY.format(EXPORT, "") + "install(DIRECTORY include/ DESTINATION include)\n", True),
        (LIBRARY.format(EXPORT, "") + "install(DIRECTORY ${HEADERS} DESTINATION include)\n", True),
        (LIBRARY.format("", "") + "ament_auto_package()\n", True),
    ],
)
def test_header_is_an_interface_only_if_something_installs_it(repository, compare, cmake, is_interface):
    repository.commit({**FILES, "a/CMakeLists.txt": cmake})
    repository.write({"a/include/arm/driver.hpp": HEADER.replace("class Driver {\n};\n", "")})
    expected = ["classes removed: 'Driver'"] if is_interface else []
    assert [text for text in breaking(compare(repository)) if "classes" in text] == expected


def test_targets_of_a_build_file_that_another_one_replaces_are_reported(repository, compare):
    cmake = """project(arm)
add_library(arm_core SHARED src/core.cpp)
add_executable(drive src/drive.cpp)
add_executable(stop src/stop.cpp)
install(TARGETS arm_core EXPORT arm_targets DESTINATION lib)
install(TARGETS drive stop DESTINATION lib/${PROJECT_NAME})
"""
    entries = "entry_points={'console_scripts': ['drive = arm.drive:main']}"
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/CMakeLists.txt": cmake}
    repository.commit(files)
    (repository.root / "arm/CMakeLists.txt").unlink()
    repository.write(
        {"arm/setup.py": f"from setuptools import setup\nsetup(name='arm', packages=['arm'], {entries})\n"}
    )
    lines = breaking(compare(repository))
    assert "installed executables removed: 'stop'" in lines
    assert "installed libraries removed: 'arm_core'" in lines
    assert not [line for line in lines if "'drive'" in line]


@pytest.mark.parametrize("name", ["arm.launch.py", "bringup.py"])
def test_a_removed_launch_file_is_one_line_whatever_its_name(repository, compare, name):
    launch = "def generate_launch_description():\n    return LaunchDescription([])\n"
    install = "install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})\nament_package()"
    cmake = f"cmake_minimum_required(VERSION 3.8)\nproject(arm)\n{install}\n"
    files = {"a/package.xml": FILES["a/package.xml"], "a/CMakeLists.txt": cmake, "a/launch/b.txt": "b\n"}
    repository.commit({**files, f"a/launch/{name}": launch})
    repository.commit({f"a/launch/{name}": None})
    assert breaking(compare(repository, "HEAD~1..HEAD")) == ["launch file removed"]


@pytest.mark.parametrize("is_installed", [False, True])
def test_a_file_that_replaces_an_uninstalled_one_is_no_new_fault(repository, compare, is_installed):
    folder = "maps" if is_installed else ""
    build = f"""project(arm)
find_package(ament_cmake REQUIRED)
install(DIRECTORY launch {folder} DESTINATION share/${{PROJECT_NAME}})
ament_package()
"""
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    text = '<launch><arg name="map" default="$(find-pkg-share arm)/maps/{}.yaml"/></launch>'
    path = "arm/launch/arm.launch.xml"
    files = {
        "arm/package.xml": manifest,
        "arm/CMakeLists.txt": build,
        "arm/maps/flat.yaml": "a: 1",
        "arm/maps/room.yaml": "b: 2",
    }
    repository.commit({**files, path: text.format("flat")})
    new = build.replace(" maps ", " ")
    repository.write({path: text.format("room"), "arm/CMakeLists.txt": new})
    assert ("names 'maps/room.yaml' of 'arm', which is not installed" in breaking(compare(repository))) == is_installed


@pytest.mark.parametrize("folders", ["robots", "robots pairs", ""])
def test_a_description_of_another_package_that_is_not_installed_is_told(repository, compare, folders):
    install = "install(DIRECTORY ${dir}/ DESTINATION share/${PROJECT_NAME}/${dir})"
    lines = f"foreach(dir {folders})\n{install}\nendforeach()\n"
    # DROP(DIRECTORY ${{dir}}/ DESTINATION share/${{PROJECT_NAME}}/${{dir}})\nendforeach()\n"
    build = "project({})\nfind_package(catkin REQUIRED)\ncatkin_package()\n"
    launch_build = build.format("driver") + "install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})\n"
    manifests = {f"{name}/package.xml": PACKAGE_XML.replace("arm_description", name) for name in ("arm", "driver")}
    files = {"arm/robots/one.xacro": "<robot name='a'/>", "arm/pairs/two.xacro": "<robot name='b'/>"}
    builds = {"arm/CMakeLists.txt": build.format("arm") + lines, "driver/CMakeLists.txt": launch_build}
    text = '<launch><param name="robot_description" command="xacro $(find arm)/{} a:=1"/></launch>'
    path = "driver/launch/arm.launch"
    repository.commit({**manifests, **files, **builds, path: text.format("robots/one.xacro")})
    repository.write({path: text.format("pairs/two.xacro")})
    told = "names 'pairs/two.xacro' of 'arm', which is not installed"
    assert (told in breaking(compare(repository))) == (folders == "robots")


@pytest.mark.parametrize(("left", "is_told"), [({}, False), ({"a/meshes/hand.obj": "mtllib arm.mtl\n"}, True)])
def test_materials_that_move_with_their_meshes_are_not_lost(repository, compare, left, is_told):
    cmake = CMAKE + "install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})\n"
    mesh = "mtllib arm.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    material = "newmtl red\nKd 0.8 0.1 0.1\n"
    repository.commit(
        {**FILES, "a/CMakeLists.txt": cmake, "a/meshes/arm.obj": mesh, "a/meshes/arm.mtl": material, **left}
    )
    moved = {"a/meshes/visual/arm.obj": mesh, "a/meshes/visual/arm.mtl": material}
    repository.write({"a/meshes/arm.obj": None, "a/meshes/arm.mtl": None, **moved})
    told = "no longer installed: 'share/arm/meshes/arm.mtl'" in breaking(compare(repository))
    assert told is is_told


@pytest.mark.parametrize(
    ("named", "installed", "is_breaking"),
    [
        ("config/lamp.yaml", "launch", False),
        ("maps/lamp.yaml", "launch", True),
        ("maps/lamp.yaml", "launch maps", True),
    ],
    ids=["beside-another", "other-folder", "installed-folder"],
)
def test_a_file_beside_one_that_is_not_installed_either(repository, compare, named, installed, is_breaking):
    cmake = "project(arm)\nfind_package(catkin REQUIRED)\ncatkin_package()\n"
    install = f"install(DIRECTORY {installed} DESTINATION share/${{PROJECT_NAME}})\n"
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    files = {"arm/package.xml": manifest.replace("<exec_dep", "<buildtool_depend>catkin</buildtool_depend><exec_dep")}
    files |= {"arm/CMakeLists.txt": cmake + install, "arm/config/net.yaml": "a: 1", f"arm/{named}": "b: 2"}
    node = '<launch><rosparam file="$(find arm)/{}" command="load"/>{}</launch>\n'
    path = "arm/launch/arm.launch"
    repository.commit({**files, path: node.format(named, "")})
    repository.write({path: node.format(named, '<param name="net" value="$(find arm)/config/net.yaml"/>')})
    lines = [str(change.sentence) for found in compare(repository).subjects for change in found.changes]
    told = "names 'config/net.yaml' of 'arm', which is not installed"
    assert told in lines
    assert (told in breaking(compare(repository))) == is_breaking
