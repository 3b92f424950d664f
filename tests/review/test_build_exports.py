"""The lines of a review about what packages export to others, and about renamed components."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

HEAD = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\nadd_library(arm src/arm.cpp)\n"
INSTALL = "install(TARGETS arm DESTINATION lib)\nament_export_include_directories(include)\n{}\nament_package()\n"
MANIFEST = PACKAGE_XML.replace("arm_description", "arm")


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("ament_export_libraries(${parts})", "", []),  # nothing sets the variable, so that nothing is exported
        ("ament_export_libraries(arm)", "", ["exported targets removed: 'arm'"]),
        ("ament_export_dependencies(ament_cmake)", "", []),
        ("ament_export_dependencies(rclcpp)", "", ["exported dependencies removed: 'rclcpp'"]),
    ],
)
def test_only_an_export_that_others_may_use_is_breaking_when_it_is_gone(repository, compare, old, new, expected):
    cmake = HEAD + INSTALL
    repository.commit({"arm/package.xml": MANIFEST, "arm/CMakeLists.txt": cmake.format(old)})
    repository.write({"arm/CMakeLists.txt": cmake.format(new)})
    assert breaking(compare(repository)) == expected


FOLDER_EXPORT = "ament_export_include_directories({})\n"
CATKIN_EXPORT = "find_package(catkin REQUIRED)\ncatkin_package(INCLUDE_DIRS {})\n"
INSTALLED_FOLDER = "install(DIRECTORY include/ DESTINATION include)\n"


@pytest.mark.parametrize(
    ("export", "more", "is_breaking"),
    [
        (FOLDER_EXPORT.format("include"), "", False),  # installs nothing there
        (FOLDER_EXPORT.format("msg"), INSTALLED_FOLDER, False),
        (FOLDER_EXPORT.format("include"), INSTALLED_FOLDER, True),
        (FOLDER_EXPORT.format("include"), "install(DIRECTORY ${{folders}} DESTINATION include)\n", True),
        (FOLDER_EXPORT.format("${EIGEN3_INCLUDE_DIR}"), "", True),
        (CATKIN_EXPORT.format("include"), "", True),  # users of the devel space find headers of the sources
        (CATKIN_EXPORT.format("src"), "", False),
    ],
)
def test_an_exported_folder_without_headers_is_not_breaking_when_it_is_gone(
    repository, compare, export, more, is_breaking
):
    cmake = HEAD + more + "{}ament_package()\n"
    files = {"arm/package.xml": MANIFEST, "arm/include/arm/arm.hpp": "int arm();\n", "arm/src/arm.cpp": "int i;\n"}
    new = export.replace("INCLUDE_DIRS include", "").replace("INCLUDE_DIRS src", "") if "catkin" in export else ""
    repository.commit({**files, "arm/CMakeLists.txt": cmake.format(export)})
    repository.write({"arm/CMakeLists.txt": cmake.format(new)})
    result = compare(repository)
    removed = [text for text in breaking(result) if text.startswith("exported include folders removed")]
    assert bool(removed) is is_breaking
    assert any("exported include folders" in text for text in sentences(subject(result, "arm/CMakeLists.txt")))


@pytest.mark.parametrize(
    ("runtime", "left", "is_breaking"),
    [("", "", False), ("", "add_message_files(FILES B.msg)\n", True), ("tf", "", True)],
)
def test_the_runtime_of_messages_leaves_with_the_last_message(repository, compare, runtime, left, is_breaking):
    cmake = "project(arm)\nfind_package(catkin REQUIRED)\n{}catkin_package(CATKIN_DEPENDS roscpp {})\n"
    old = cmake.format("add_message_files(FILES A.msg)\n" + left, f"message_runtime {runtime}")
    messages = {"arm/msg/A.msg": "int32 a\n", "arm/msg/B.msg": "int32 b\n"}
    repository.commit({"arm/package.xml": MANIFEST, "arm/CMakeLists.txt": old, **messages})
    repository.commit({"arm/CMakeLists.txt": cmake.format(left, ""), "arm/msg/A.msg": None})
    removed = [text for text in breaking(compare(repository, "HEAD~1..HEAD")) if "exported dependencies" in text]
    assert bool(removed) is is_breaking
    assert all("message_runtime" in text for text in removed) or runtime


@pytest.mark.parametrize(("name", "is_breaking"), [("ament_cmake", False), ("catkin", False), ("rclcpp", True)])
@pytest.mark.parametrize("new", ["<buildtool_depend>{}</buildtool_depend>", ""])
def test_a_build_tool_that_is_no_depend_any_more_is_not_breaking(repository, compare, name, is_breaking, new):
    manifest = MANIFEST.replace("<license>", f"<depend>{name}</depend><license>")
    repository.commit({"arm/package.xml": manifest, "arm/CMakeLists.txt": HEAD + INSTALL.format("")})
    repository.write({"arm/package.xml": manifest.replace(f"<depend>{name}</depend>", new.format(name))})
    result = compare(repository)
    assert len(sentences(subject(result, "arm/package.xml"))) == 1
    assert bool(breaking(result)) is is_breaking


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        ("arm::Lamp", ["components: 'arm::Light_Node' renamed to 'arm::Lamp'"]),
        ("leg::Light_Node", ["components: 'arm::Light_Node' renamed to 'leg::Light_Node'"]),
        ("leg::Lamp", ["components added: 'leg::Lamp'", "components removed: 'arm::Light_Node'"]),
    ],
)
def test_a_component_with_another_class_or_namespace_is_renamed(repository, compare, new, expected):
    cmake = HEAD + 'rclcpp_components_register_nodes(arm "{}")\n' + INSTALL.format("")
    repository.commit({"arm/package.xml": MANIFEST, "arm/CMakeLists.txt": cmake.format("arm::Light_Node")})
    repository.write({"arm/CMakeLists.txt": cmake.format(new)})
    result = compare(repository)
    assert sentences(subject(result, "arm/CMakeLists.txt")) == expected
    assert breaking(result) == expected[-1:]


def test_moved_interfaces_break_programs_that_use_the_types(repository, compare):
    names = ("Load", "Rate", "State")
    files = {f"arm/msg/{name}.msg": f"int32 {name.lower()}\nint32 count\nint32 number\n" for name in names}
    cmake = "project(arm)\nrosidl_generate_interfaces(arm {})\n".format(" ".join(f"msg/{name}.msg" for name in names))
    repository.commit({"arm/package.xml": MANIFEST, "arm/CMakeLists.txt": cmake, **files})
    moved = {path.replace("arm/", "parts/", 1): text for path, text in files.items()}
    others = {
        "parts/package.xml": MANIFEST.replace("arm", "parts"),
        "parts/CMakeLists.txt": cmake.replace("arm", "parts"),
    }
    repository.write(
        {**dict.fromkeys(files), **moved, **others, "arm/CMakeLists.txt": "project(arm)\n", "arm/a.txt": ""}
    )
    repository.git("add", "-A")
    (change,) = subject(compare(repository), "parts/").changes
    assert str(change.sentence).endswith("msg/Load.msg, msg/Rate.msg, msg/State.msg")
    assert str(change.reason) == "programs that use the types do not build or start"


@pytest.mark.parametrize("folders", [("config", "launch", "urdf"), ("config", "launch")])
def test_folders_that_are_installed_in_another_folder_together_share_a_line(repository, compare, folders):
    cmake = "project(arm)\nfind_package(ament_cmake)\ninstall(DIRECTORY {} DESTINATION {})\nament_package()\n"
    files = {f"arm/{folder}/{name}.txt": name for folder in folders for name in ("a", "b")}
    names = " ".join(folders)
    old, new = "share/${PROJECT_NAME}", "share/${PROJECT_NAME}/{PROJECT_NAME}"
    repository.commit({"arm/package.xml": MANIFEST, "arm/CMakeLists.txt": cmake.format(names, old), **files})
    repository.write({"arm/CMakeLists.txt": cmake.format(names, new)})
    lines = breaking(compare(repository))
    parts = ", ".join(f"'{folder}/' with 2 files" for folder in folders)
    whole = f"installed in share/arm/{{PROJECT_NAME}} instead of share/arm: {parts}"
    single = [
        f"installed in share/arm/{{PROJECT_NAME}}/{folder} instead of share/arm/{folder}: 'a.txt', 'b.txt'"
        for folder in folders
    ]
    assert lines == ([whole] if len(folders) > 2 else single)


def test_a_folder_that_a_renamed_package_installs_as_before_is_not_new(repository, compare):
    cmake = "project({0})\nfind_package(ament_cmake)\ninstall(DIRECTORY config DESTINATION share/${{PROJECT_NAME}})\n"
    manifest = PACKAGE_XML.replace("arm_description", "{0}")
    files = {"package.xml": manifest, "CMakeLists.txt": cmake, "config/a.txt": "a\nb\n"}
    repository.commit({f"arm/{path}": text.format("arm") for path, text in files.items()})
    repository.write({**{f"arm/{path}": text.format("gear") for path, text in files.items()}, "arm/config/c.txt": "c"})
    assert sentences(subject(compare(repository), "arm/package.xml")) == ["package 'arm' renamed to 'gear'"]
    assert not any("installed now" in line for found in compare(repository).subjects for line in sentences(found))


MOVED = "installed in share/arm/plugins instead of share/arm: 'p.xml'"


@pytest.mark.parametrize(("exported", "is_breaking"), [("plugins/p.xml", False), ("p.xml", True)])
def test_plugin_description_may_move_with_its_export(repository, compare, exported, is_breaking):
    manifest = MANIFEST.replace("</package>", '<export><moveit_core plugin="${prefix}/p.xml"/></export></package>')
    cmake = f"{HEAD}find_package(catkin REQUIRED)\ncatkin_package()\ninstall(FILES p.xml DESTINATION share/arm)\n"
    repository.commit({"arm/package.xml": manifest, "arm/CMakeLists.txt": cmake, "arm/p.xml": "<library/>\n"})
    repository.write(
        {
            "arm/package.xml": manifest.replace("/p.xml", f"/{exported}"),
            "arm/CMakeLists.txt": cmake.replace("share/arm)", "share/arm/plugins)"),
        }
    )
    result = compare(repository)
    assert MOVED in sentences(subject(result, "arm/CMakeLists.txt"))
    assert (MOVED in breaking(result)) is is_breaking


@pytest.mark.parametrize(("find", "is_breaking"), [("", False), ("find_package(catkin REQUIRED)\n", True)])
def test_build_file_of_ament_with_commands_of_catkin_built_nothing(repository, compare, find, is_breaking):
    cmake = HEAD + INSTALL.format("ament_export_dependencies(rclcpp)")
    old = cmake.replace(
        "add_library", f"{find}catkin_install_python(PROGRAMS scripts/tool DESTINATION lib/arm)\nadd_library"
    )
    repository.commit({"arm/package.xml": MANIFEST, "arm/CMakeLists.txt": old, "arm/scripts/tool": ""})
    repository.write({"arm/CMakeLists.txt": cmake})
    result = compare(repository)
    assert bool(breaking(result)) is is_breaking
    failed = "the old version calls 'catkin_install_python' without catkin, so that its build fails"
    assert (failed in sentences(subject(result, "arm/CMakeLists.txt"))) is not is_breaking


@pytest.mark.parametrize(
    ("manifest", "folder", "is_breaking"),
    [("arm/package.xml", "lib/arm", True), ("hand/package.xml", "lib/arm", False), ("hand/package.xml", "bin", True)],
)
def test_program_of_a_folder_without_a_manifest_was_not_found(repository, compare, manifest, folder, is_breaking):
    cmake = "project(arm)\nadd_executable(drive src/drive.cpp)\n{}"
    install = f"install(TARGETS drive RUNTIME DESTINATION {folder})\n"
    files = {manifest: MANIFEST, "arm/src/drive.cpp": "int main() {}\n"}
    repository.commit({**files, "arm/CMakeLists.txt": cmake.format(install)})
    repository.write({"arm/package.xml": MANIFEST, "arm/CMakeLists.txt": cmake.format("")})
    result = compare(repository)
    removed = "installed executables removed: 'drive'"
    assert removed in sentences(subject(result, "arm/CMakeLists.txt"))
    assert (removed in breaking(result)) is is_breaking


@pytest.mark.parametrize(
    ("version", "name", "expected"),
    [
        ("7", "gz-sim${GZ_VERSION}", "exported dependencies: 'gz-sim8' replaced by 'gz-sim${GZ_VERSION}'"),
        ("7", "gz-msgs${GZ_VERSION}", "exported dependencies removed: 'gz-sim8'"),
        ("${gz-sim8_VERSION_MAJOR}", "gz-sim${GZ_VERSION}", None),
    ],
)
def test_exported_name_with_a_variable_can_be_the_old_one(repository, compare, version, name, expected):
    choice = f"set(GZ_VERSION {version})\nif($ENV{{GZ_VERSION}} STREQUAL 8)\n  set(GZ_VERSION 8)\nendif()\n"
    cmake = f"project(arm)\n{choice}ament_export_dependencies(%s)\nament_package()\n"
    repository.commit({"arm/package.xml": MANIFEST, "arm/CMakeLists.txt": cmake % "gz-sim8"})
    repository.write({"arm/CMakeLists.txt": cmake % name})
    result = compare(repository)
    assert breaking(result) == ([expected] if expected and "removed" in expected else [])
    found = sentences(subject(result, "arm/CMakeLists.txt")) if result.subjects else []
    added = [f"exported dependencies added: '{name}'"] if breaking(result) else []
    assert set(found) == {*added, *([] if expected is None else [expected])}
