"""The installed files of a package, as read from its CMakeLists.txt."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.diagnostics import SourceText
from linkwright.packages.readers.cmake import CMakeFile, read_cmake

HEAD = "cmake_minimum_required(VERSION 3.8)\nproject(arm)\nfind_package(ament_cmake REQUIRED)\n"


def rules(text: str, package: Path | None = None) -> CMakeFile:
    return read_cmake(SourceText("CMakeLists.txt", HEAD + text + "\nament_package()\n"), package)


def copied_paths(text: str, package: Path) -> dict[str, str]:
    """Return the source and destination of all copied files; nothing may be unknown."""
    install_rules = rules(text, package)
    assert install_rules.is_complete, install_rules.unknown
    return {file.source: file.destination for file in install_rules.installed_files(package)}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    for name in ("urdf/arm.urdf", "urdf/parts/hand.xacro", "urdf/notes.txt", "launch/show.launch.py", "scripts/run.py"):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("")
    return tmp_path


def test_install_directory_keeps_folder_name(package: Path) -> None:
    assert copied_paths("install(DIRECTORY urdf launch DESTINATION share/${PROJECT_NAME})", package) == {
        "urdf/arm.urdf": "share/arm/urdf/arm.urdf",
        "urdf/notes.txt": "share/arm/urdf/notes.txt",
        "urdf/parts/hand.xacro": "share/arm/urdf/parts/hand.xacro",
        "launch/show.launch.py": "share/arm/launch/show.launch.py",
    }


def test_trailing_slash_installs_folder_content(package: Path) -> None:
    copies = copied_paths('install(DIRECTORY "launch/" DESTINATION share/arm/start)', package)
    assert copies == {"launch/show.launch.py": "share/arm/start/show.launch.py"}


def test_install_patterns_select_files(package: Path) -> None:
    matching = 'install(DIRECTORY urdf DESTINATION share/arm FILES_MATCHING PATTERN "*.urdf" PATTERN "*.xacro")'
    assert set(copied_paths(matching, package)) == {"urdf/arm.urdf", "urdf/parts/hand.xacro"}
    excluding = 'install(DIRECTORY urdf DESTINATION share/arm PATTERN "parts" EXCLUDE)'
    assert set(copied_paths(excluding, package)) == {"urdf/arm.urdf", "urdf/notes.txt"}


@pytest.mark.parametrize(
    ("extra_text", "is_required"),
    [
        ("", True),
        ('PATTERN "*.h"', True),
        ('PATTERN ".svn" EXCLUDE', True),
        ('FILES_MATCHING PATTERN "*.h" PATTERN ".svn" EXCLUDE', False),
        ('FILES_MATCHING PATTERN "inc*"', True),
        ('PATTERN "include" EXCLUDE', False),
        ("OPTIONAL", False),
    ],
)
def test_excluded_missing_folder_is_not_required(package: Path, extra_text: str, is_required: bool) -> None:
    # As in file(INSTALL) of CMake 3.25: a folder that no pattern selects is skipped, even if it is missing.
    install_rules = rules(f"install(DIRECTORY include/ DESTINATION include {extra_text})")
    assert [item.text for item in install_rules.required_paths] == (["include/"] if is_required else [])


def test_install_programs_and_rename(package: Path) -> None:
    text = (
        "install(PROGRAMS scripts/run.py DESTINATION lib/${PROJECT_NAME})\n"
        "install(FILES urdf/arm.urdf DESTINATION share/${PROJECT_NAME} RENAME robot.urdf)"
    )
    assert copied_paths(text, package) == {"scripts/run.py": "lib/arm/run.py", "urdf/arm.urdf": "share/arm/robot.urdf"}
    assert rules(text).programs == {"run.py": "scripts/run.py"}


def test_interfaces_and_python_packages_are_found() -> None:
    install_rules = rules(
        'set(messages "msg/A.msg" msg/C.msg)\n'
        'rosidl_generate_interfaces(${PROJECT_NAME} ${messages} "srv/B.srv" DEPENDENCIES std_msgs)\n'
        "ament_python_install_package(${PROJECT_NAME})"
    )
    assert install_rules.interfaces == ["msg/A.msg", "msg/C.msg", "srv/B.srv"]
    assert install_rules.modules == ["arm"]


def test_auto_package_installs_to_share(package: Path) -> None:
    cmake = read_cmake(SourceText("CMakeLists.txt", "project(arm)\nament_auto_package(INSTALL_TO_SHARE launch)\n"))
    assert [file.destination for file in cmake.installed_files(package)] == ["share/arm/launch/show.launch.py"]


@pytest.mark.parametrize(
    "text",
    [
        "foreach(name urdf launch)\n  install(DIRECTORY ${name} DESTINATION share/arm)\nendforeach()",
        (
            "set(all urdf)\nlist(APPEND all launch)\nforeach(name IN LISTS all)\n"
            "  install(DIRECTORY ${name} DESTINATION ${CMAKE_INSTALL_DATADIR}/arm)\nendforeach()"
        ),
        (
            "function(share)\n  install(DIRECTORY ${ARGN} DESTINATION share/${PROJECT_NAME})\nendfunction()\n"
            "share(urdf launch)"
        ),
        (
            "macro(share folder)\n  install(DIRECTORY ${folder} DESTINATION share/arm)\nendmacro()\n"
            "share(urdf)\nshare(launch)"
        ),
        (
            'function(share)\n  cmake_parse_arguments(GIVEN "" "INTO" "FOLDERS" ${ARGN})\n'
            "  install(DIRECTORY ${GIVEN_FOLDERS} DESTINATION share/${GIVEN_INTO})\nendfunction()\n"
            "share(FOLDERS urdf launch INTO arm)"
        ),
        (
            "if(BUILD_ALL)\n  install(DIRECTORY urdf DESTINATION share/arm)\nendif()\n"
            "install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/launch DESTINATION ${CMAKE_INSTALL_PREFIX}/share/arm)"
        ),
    ],
)
def test_loops_functions_and_variables_are_followed(package: Path, text: str) -> None:
    assert copied_paths(text, package) == copied_paths("install(DIRECTORY urdf launch DESTINATION share/arm)", package)


def test_file_glob_is_expanded(package: Path) -> None:
    text = 'file(GLOB_RECURSE found "urdf/*.xacro")\ninstall(FILES ${found} DESTINATION share/arm/xacro)'
    assert copied_paths(text, package) == {"urdf/parts/hand.xacro": "share/arm/xacro/hand.xacro"}
    text = "file(GLOB found RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} urdf/*.urdf)\ninstall(FILES ${found} DESTINATION x)"
    assert copied_paths(text, package) == {"urdf/arm.urdf": "x/arm.urdf"}


@pytest.mark.parametrize(
    "words",
    [
        "GLOB found LIST_DIRECTORIES FALSE RELATIVE ${PROJECT_SOURCE_DIR} urdf/*f urdf/p*",
        "GLOB found CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR} ./ urdf/arm**.urdf",
        "GLOB_RECURSE found . urdf/ arm.urdf",
        "GLOB_RECURSE found urdf/**.urdf",
    ],
)
def test_file_glob_supports_options_folders_and_double_stars(package: Path, words: str) -> None:
    text = f"project(arm)\nfile({words})\ninstall(FILES ${{found}} DESTINATION share/arm)"
    assert copied_paths(text, package) == {"urdf/arm.urdf": "share/arm/arm.urdf"}


def test_subdirectories_and_included_files_are_read(package: Path) -> None:
    (package / "urdf" / "CMakeLists.txt").write_text(
        "install(FILES arm.urdf DESTINATION share/${PROJECT_NAME}/robots)\n"
        "install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/parts DESTINATION share/${PROJECT_NAME})\n"
    )
    (package / "more.cmake").write_text("install(FILES launch/show.launch.py DESTINATION share/arm)\n")
    text = "include(GNUInstallDirs)\ninclude(more.cmake)\nadd_subdirectory(urdf)"
    assert copied_paths(text, package) == {
        "launch/show.launch.py": "share/arm/show.launch.py",
        "urdf/arm.urdf": "share/arm/robots/arm.urdf",
        "urdf/parts/hand.xacro": "share/arm/parts/hand.xacro",
    }
    install_rules = rules(text, package)
    assert install_rules.span(install_rules.files[1]).file == str(package / "urdf" / "CMakeLists.txt")


def test_configured_files_are_installed(package: Path) -> None:
    (package / "limits.yaml.in").write_text("@PROJECT_NAME@: ${SPEED}@MISSING@\n")
    install_rules = rules(
        "set(SPEED 2)\nconfigure_file(limits.yaml.in ${CMAKE_CURRENT_BINARY_DIR}/limits.yaml)\n"
        "install(FILES ${CMAKE_CURRENT_BINARY_DIR}/limits.yaml DESTINATION share/arm)",
        package,
    )
    (file,) = install_rules.installed_files(package)
    assert (file.source, file.destination) == ("limits.yaml.in", "share/arm/limits.yaml")
    assert file.text(package) == "arm: 2\n"


def test_deeply_nested_blocks_are_not_read(package: Path) -> None:
    def nested(depth: int) -> str:
        return "if(1)\n" * depth + "install(DIRECTORY urdf DESTINATION share/arm)\n" + "endif()\n" * depth

    assert rules(nested(60), package).is_complete
    install_rules = rules(nested(3000), package)
    assert not install_rules.is_complete
    assert not install_rules.copies


def test_compiled_targets_are_listed_and_other_rules_read(package: Path) -> None:
    text = "add_executable(move src/move.cpp)\nadd_library(kinematics SHARED k.cpp)\nadd_library(headers INTERFACE)\n"
    install_rules = rules(text + "install(DIRECTORY launch DESTINATION share/arm)", package)
    assert install_rules.compiled == ["move", "kinematics"]
    assert install_rules.executables == {"move"}
    assert [file.source for file in install_rules.installed_files(package)] == ["launch/show.launch.py"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("foreach(name ${SOMETHING})\n  install(DIRECTORY ${name} DESTINATION share/arm)\nendforeach()", "foreach()"),
        ("install(DIRECTORY urdf DESTINATION ${SOMEWHERE})", "cannot be read without CMake"),
        ("if(A)\nset(x urdf)\nelse()\nset(x launch)\nendif()\ninstall(DIRECTORY ${x} DESTINATION y)", "without CMake"),
        ("add_subdirectory(none)", "add_subdirectory()"),
        ("function(again)\n  again()\nendfunction()\nagain()", "function()"),
        ("foreach(a 1 2 3 4 5 6 7 8 9)\n" * 9 + "message(x)\n" + "endforeach()\n" * 9, "message()"),
    ],
)
def test_unknown_values_are_reported(package: Path, text: str, message: str) -> None:
    assert any(message in reason for reason in rules(text, package).unknown)


def test_missing_files_are_reported_unless_optional(package: Path) -> None:
    with pytest.raises(FileNotFoundError, match="meshes"):
        list(rules("install(DIRECTORY meshes DESTINATION share/arm)").installed_files(package))
    for text in ("install(FILES none DESTINATION x OPTIONAL)", "if(A)\ninstall(FILES none DESTINATION x)\nendif()"):
        assert copied_paths(text, package) == {}


_DONE_BY_CMAKE = [
    (
        """
        set(ROS_VERSION $ENV{ROS_VERSION})
        if(ROS_VERSION EQUAL 1)
          find_package(catkin)
          install(DIRECTORY urdf DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
        elseif(${ROS_VERSION} EQUAL 2)
          install(FILES urdf/arm.urdf DESTINATION share/arm RENAME two.urdf)
        endif()
        """,
        ["share/arm/two.urdf"],
    ),
    (
        """
        find_package(catkin QUIET)
        if(catkin_FOUND)
          install(FILES urdf/notes.txt DESTINATION share/arm)
        else(catkin_FOUND)
          install(FILES urdf/arm.urdf DESTINATION share/arm)
        endif(catkin_FOUND)
        """,
        ["share/arm/arm.urdf"],
    ),
    (
        """
        foreach(folder urdf worlds)
          if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${folder}/arm.urdf)
            install(FILES ${folder}/arm.urdf DESTINATION share/arm/${folder})
          endif()
        endforeach()
        """,
        ["share/arm/urdf/arm.urdf"],
    ),
    (
        """
        file(GLOB found RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} urdf/*)
        foreach(each ${found})
          if(NOT IS_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/${each} AND NOT each MATCHES [[txt$]])
            list(APPEND kept ${each})
          endif()
        endforeach()
        install(FILES ${kept} DESTINATION share/arm)
        """,
        ["share/arm/arm.urdf"],
    ),
    (
        """
        option(ALL "all of it" OFF)
        if(ALL OR WIN32 AND (NOT UNIX))
          install(FILES urdf/notes.txt DESTINATION share/arm)
        else()
          install(FILES urdf/arm.urdf DESTINATION share/arm)
        endif()
        """,
        ["share/arm/arm.urdf"],
    ),
    (
        """
        if("$ENV{ROS_DISTRO}" STREQUAL "foxy" OR CMAKE_VERSION VERSION_LESS 2)
          set(which notes.txt)
        else()
          set(which arm.urdf)
        endif()
        set(which arm.urdf)
        install(FILES urdf/${which} DESTINATION share/arm)
        """,
        ["share/arm/arm.urdf"],
    ),
    (
        """
        function(install_scripts)
          cmake_parse_arguments(PARSE_ARGV 0 given "" DESTINATION "")
          foreach(script IN LISTS given_UNPARSED_ARGUMENTS)
            get_filename_component(name ${script} NAME_WE)
            install(PROGRAMS ${script} RENAME ${name} DESTINATION ${given_DESTINATION})
          endforeach()
        endfunction()
        install_scripts(scripts/run.py DESTINATION lib/arm)
        """,
        ["lib/arm/run"],
    ),
    (
        """
        set(files urdf/arm.urdf scripts/run.py)
        set(names a b)
        foreach(file name IN ZIP_LISTS files names)
          install(FILES ${file} DESTINATION share/arm RENAME ${name})
        endforeach()
        """,
        ["share/arm/a", "share/arm/b"],
    ),
    (
        """
        foreach(number RANGE 1 3)
          if(number EQUAL 2)
            continue()
          endif()
          install(FILES urdf/arm.urdf DESTINATION share/arm RENAME ${number}.urdf)
        endforeach()
        """,
        ["share/arm/1.urdf", "share/arm/3.urdf"],
    ),
    (
        """
        set(i 0)
        while(TRUE)
          math(EXPR i "${i} + 1")
          if(i GREATER 2)
            break()
          endif()
          install(FILES urdf/arm.urdf DESTINATION share/arm RENAME ${i}.urdf)
        endwhile()
        """,
        ["share/arm/1.urdf", "share/arm/2.urdf"],
    ),
    (
        """
        function(pick out)
          set(${out} urdf PARENT_SCOPE)
          return()
          set(${out} none PARENT_SCOPE)
        endfunction()
        pick(WHERE)
        install(FILES ${WHERE}/arm.urdf DESTINATION share/arm)
        """,
        ["share/arm/arm.urdf"],
    ),
    (
        """
        macro(share what)
          if(${ARGC} GREATER 1)
            install(FILES ${what} DESTINATION share/${ARGV1})
          endif()
        endmacro()
        share(urdf/notes.txt)
        share(urdf/arm.urdf arm)
        """,
        ["share/arm/arm.urdf"],
    ),
    (
        """
        set(all urdf launch scripts)
        list(REMOVE_ITEM all launch)
        list(REVERSE all)
        list(TRANSFORM all APPEND "/")
        list(GET all 1 which)
        string(REPLACE "/" "" name ${which})
        string(TOUPPER ${name} name)
        install(FILES ${which}arm.urdf DESTINATION share/arm/${name})
        """,
        ["share/arm/URDF/arm.urdf"],
    ),
    (
        r"""
        string(REGEX REPLACE "([a-z]+)\\.urdf$" "\\1" name urdf/arm.urdf)
        install(FILES urdf/arm.urdf DESTINATION share/${name})
        """,
        ["share/urdf/arm/arm.urdf"],
    ),
    (
        """
        project(arm VERSION 1.2.3)
        install(FILES urdf/arm.urdf DESTINATION share/${PROJECT_VERSION_MINOR}/${arm_VERSION})
        """,
        ["share/2/1.2.3/arm.urdf"],
    ),
    (
        """
        install(FILES urdf/arm.urdf TYPE DATA)
        """,
        ["share/arm.urdf"],
    ),
    (
        r"""
        install(DIRECTORY urdf DESTINATION x FILES_MATCHING REGEX "\\.xacro$")
        """,
        ["x/urdf/parts/hand.xacro"],
    ),
    (
        """
        install(DIRECTORY urdf DESTINATION x PATTERN "parts/*" EXCLUDE REGEX "not" EXCLUDE)
        """,
        ["x/urdf/arm.urdf"],
    ),
]
"""Texts of a CMakeLists.txt, and the files that CMake itself installs for them."""


@pytest.mark.parametrize(("text", "destinations"), _DONE_BY_CMAKE)
def test_supported_cmake_commands_match_cmake(package: Path, text: str, destinations: list[str]) -> None:
    install_rules = rules(text, package)
    assert install_rules.is_complete, install_rules.unknown
    assert sorted(file.destination for file in install_rules.installed_files(package)) == destinations


@pytest.mark.parametrize(
    "condition", ["ANYTHING", "NOT DEFINED ANYTHING", "A STREQUAL ${B}", "EXISTS notes", "A AND NOT B"]
)
def test_undecidable_condition_reads_all_branches(package: Path, condition: str) -> None:
    text = f"""
        if({condition})
          install(FILES urdf/arm.urdf DESTINATION a)
        else()
          install(FILES none DESTINATION b)
        endif()
    """
    assert copied_paths(text, package) == {"urdf/arm.urdf": "a/arm.urdf"}


_SET_TWICE = "set(FOLDER a_${x})\n  set(FOLDER b_${x})\n  install(FILES urdf/arm.urdf DESTINATION ${FOLDER})"
_USED_LATER = "\ninstall(DIRECTORY launch DESTINATION ${FOLDER})"


@pytest.mark.parametrize("before", ["", "set(FOLDER c)\n"])
@pytest.mark.parametrize(
    "text",
    [
        f"set(x 1)\nif(A)\n  {_SET_TWICE}\nendif()",
        f"set(x 1)\nif(A)\n  if(B)\n  {_SET_TWICE}\n  endif()\nendif()",
        f"set(x 1)\nif(A)\n  set(FOLDER d)\nelse()\n  {_SET_TWICE}\nendif()",
        f"function(copy x)\n  {_SET_TWICE}\nendfunction()\nif(A)\n  copy(1)\nendif()",
    ],
)
def test_variable_that_a_branch_sets_twice_has_the_second_value_in_it(package: Path, text: str, before: str) -> None:
    assert copied_paths(before + text, package) == {"urdf/arm.urdf": "b_1/arm.urdf"}
    install_rules = rules(before + text + _USED_LATER, package)
    is_local = "function" in text and before != ""
    is_new = "function" not in text and "else" not in text and before == ""
    assert install_rules.is_complete is (is_local or is_new)


def test_files_generated_by_build_are_installed(package: Path) -> None:
    (package / "robot.urdf.in").write_text("@NAME@")
    install_rules = rules(
        "foreach(NAME a b)\n  configure_file(robot.urdf.in ${PROJECT_BINARY_DIR}/made/${NAME}.urdf)\nendforeach()\n"
        'file(WRITE ${PROJECT_BINARY_DIR}/note "arm ")\nfile(APPEND ${PROJECT_BINARY_DIR}/note "is built")\n'
        "install(DIRECTORY ${PROJECT_BINARY_DIR}/made DESTINATION share/arm)\n"
        "install(FILES ${PROJECT_BINARY_DIR}/note DESTINATION share/arm)",
        package,
    )
    written = {file.destination: file.text(package) for file in install_rules.installed_files(package)}
    assert written == {"share/arm/made/a.urdf": "a", "share/arm/made/b.urdf": "b", "share/arm/note": "arm is built"}


def test_ament_commands_install_files(package: Path) -> None:
    for name in ("hooks/arm.dsv.in", "hooks/more.sh", "plugins/arm.xml"):
        (package / name).parent.mkdir(exist_ok=True)
        (package / name).write_text("set;ROBOT;@PROJECT_NAME@" if name.endswith(".in") else "")
    install_rules = rules(
        'ament_environment_hooks("${CMAKE_CURRENT_SOURCE_DIR}/hooks/${PROJECT_NAME}.dsv.in" hooks/more.sh)\n'
        'ament_index_register_resource(robots CONTENT "urdf/arm.urdf")\n'
        "pluginlib_export_plugin_description_file(controllers plugins/arm.xml)\n"
        "ament_python_install_module(scripts/run.py)",
        package,
    )
    files = {file.destination: file for file in install_rules.installed_files(package)}
    index = "share/ament_index/resource_index"
    assert sorted(files) == [
        f"{index}/controllers__pluginlib__plugin/arm",
        f"{index}/robots/arm",
        "share/arm/arm.xml",
        "share/arm/environment/arm.dsv",
        "share/arm/environment/more.sh",
    ]
    assert files["share/arm/environment/arm.dsv"].text(package) == "set;ROBOT;arm"
    assert files[f"{index}/robots/arm"].text(package) == "urdf/arm.urdf"
    assert files[f"{index}/controllers__pluginlib__plugin/arm"].text(package) == "share/arm/arm.xml\n"
    assert install_rules.hooks == ["share/arm/environment/arm.dsv", "share/arm/environment/more.sh"]
    assert install_rules.modules == ["scripts/run.py"]


def test_xacro_add_files_is_reported_as_unknown(package: Path) -> None:
    install_rules = rules("xacro_add_files(urdf/arm.urdf.xacro INSTALL DESTINATION urdf)", package)
    assert install_rules.unknown == ["'urdf/arm.urdf' would have to be made by xacro"]


@pytest.mark.parametrize(
    "text",
    [
        "set(x a)\n" + 'set(x "${x}${x}")\n' * 60,
        "set(x a)\nforeach(i RANGE 60)\n  list(APPEND x ${x})\nendforeach()\n",
        "set(x a)\nforeach(i RANGE 60)\n  string(APPEND x ${x}${x})\nendforeach()\n",
    ],
)
def test_exponentially_growing_values_are_rejected(text: str, package: Path) -> None:
    install_rules = rules(f"project(arm)\n{text}install(DIRECTORY launch DESTINATION share/arm)\n", package)
    assert install_rules.unknown
