"""The contents of the files of a new package that is built with CMake."""

from __future__ import annotations

from collections.abc import Sequence

from linkwright.loading.lean_typing import TYPE_CHECKING

if TYPE_CHECKING:
    from linkwright.packages.creation.request import PackageRequest

_WARNING_OPTIONS = """
if(CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  add_compile_options(-Wall -Wextra -Wpedantic)
endif()
"""

_NO_DEPENDENCIES = """\
# Find what the package depends on, one line each:
# find_package(<dependency> REQUIRED)
"""

_LINTER_TESTS = """
if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  # Remove this line once every source file names its copyright holder and license.
  set(ament_cmake_copyright_FOUND TRUE)
  # Remove this line once the package is in a git repository, which cpplint needs.
  set(ament_cmake_cpplint_FOUND TRUE)
  ament_lint_auto_find_test_dependencies()
endif()
"""


def ament_cmake_lists(request: PackageRequest) -> str:
    """Return the ``CMakeLists.txt`` of an ament_cmake package."""
    library, node = request.library_name, request.node
    tools = ["ament_cmake", "ament_cmake_ros"] if library else ["ament_cmake"]
    parts = [_format_header(request), _format_find_packages([*tools, *request.dependencies])]
    if not request.dependencies:
        parts.append(_NO_DEPENDENCIES)
    if library:
        parts += [
            _format_library_target(request, f"add_library({library} src/{library}.cpp)", "include/${PROJECT_NAME}"),
            _format_ament_dependencies(library, request.dependencies),
            _format_export_definition(request),
            "\ninstall(\n  DIRECTORY include/\n  DESTINATION include/${PROJECT_NAME}\n)\n",
            _format_library_installation(library, "export_${PROJECT_NAME}"),
        ]
    if node:
        parts.append(_format_executable_target(request, "include/${PROJECT_NAME}"))
        if library:
            parts.append(f"target_link_libraries({node} {library})\n")
        else:
            parts.append(_format_ament_dependencies(node, request.dependencies))
        parts.append(f"\ninstall(TARGETS {node}\n  DESTINATION lib/${{PROJECT_NAME}})\n")
    parts.append(_LINTER_TESTS)
    if library:
        parts += [
            '\nament_export_include_directories(\n  "include/${PROJECT_NAME}"\n)\n',
            f"ament_export_libraries(\n  {library}\n)\n",
            "ament_export_targets(\n  export_${PROJECT_NAME}\n)\n",
        ]
    parts.append("\nament_package()\n")
    return "".join(parts)


def plain_cmake_lists(request: PackageRequest) -> str:
    """Return the ``CMakeLists.txt`` of a package that does not use ament."""
    library, node = request.library_name, request.node
    parts = [_format_header(request, version=True)]
    parts.append(_format_find_packages(request.dependencies) if request.dependencies else f"\n{_NO_DEPENDENCIES}")
    if library:
        parts += [
            _format_library_target(request, f"add_library({library} SHARED src/{library}.cpp)", "include"),
            _format_plain_dependencies(library, request.dependencies),
            _format_export_definition(request),
            "\ninstall(\n  DIRECTORY include/\n  DESTINATION include\n)\n",
            _format_library_installation(library, f"export_{request.name}"),
        ]
    if node:
        parts.append(_format_executable_target(request, "include"))
        if library:
            parts.append(f"target_link_libraries({node} PUBLIC {library})\n")
        else:
            parts.append(_format_plain_dependencies(node, request.dependencies))
        parts.append(
            f"\ninstall(\n  TARGETS {node}\n  EXPORT export_{request.name}\n  DESTINATION lib/${{PROJECT_NAME}}\n)\n"
        )
    if library or node:
        parts.append(_format_package_config(request))
    return "".join(parts)


def config(request: PackageRequest) -> str:
    """Return ``<name>Config.cmake.in``, the template for ``find_package`` in other projects."""
    lines = [
        f"# Found by find_package({request.name}). It defines",
        f"#   {request.name}_INCLUDE_DIRS: folders with headers",
    ]
    settings = [f'set({request.name}_INCLUDE_DIRS "${{CMAKE_CURRENT_LIST_DIR}}/../../../include")']
    if request.library_name:
        lines.append(f"#   {request.name}_LIBRARIES: the targets to link with")
        settings.append(f"set({request.name}_LIBRARIES {request.name}::{request.library_name})")
    if request.node:
        lines.append(f"#   {request.name}_EXECUTABLE: the target of the program")
        settings.append(f"set({request.name}_EXECUTABLE {request.name}::{request.node})")
    lines += ["", *_format_find_dependencies(request.dependencies)]
    lines.append(f'include("${{CMAKE_CURRENT_LIST_DIR}}/export_{request.name}.cmake")')
    return "\n".join([*lines, "", *settings]) + "\n"


def config_version_template() -> str:
    """Return ``<name>ConfigVersion.cmake.in``, which checks the requested version."""
    return """\
set(PACKAGE_VERSION "@PROJECT_VERSION@")

if(PACKAGE_VERSION VERSION_LESS PACKAGE_FIND_VERSION)
  set(PACKAGE_VERSION_COMPATIBLE FALSE)
else()
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
  if(PACKAGE_FIND_VERSION VERSION_EQUAL PACKAGE_VERSION)
    set(PACKAGE_VERSION_EXACT TRUE)
  endif()
endif()
"""


def node_cpp(request: PackageRequest) -> str:
    """Return the source of the executable."""
    return f"""\
#include <iostream>

int main()
{{
  std::cout << "Hello from {request.name}." << std::endl;
  return 0;
}}
"""


def library_hpp(request: PackageRequest) -> str:
    """Return the header of the library."""
    guard = f"{request.name}__{request.library_name}_HPP_".upper()
    name = _make_class_name(request)
    return f"""\
#ifndef {guard}
#define {guard}

#include "{request.name}/visibility_control.h"

namespace {request.name}
{{

class {request.name.upper()}_PUBLIC {name}
{{
public:
  {name}();

  virtual ~{name}();
}};

}}  // namespace {request.name}

#endif  // {guard}
"""


def library_cpp(request: PackageRequest) -> str:
    """Return the source of the library."""
    name = _make_class_name(request)
    return f"""\
#include "{request.name}/{request.library_name}.hpp"

namespace {request.name}
{{

{name}::{name}()
{{
}}

{name}::~{name}()
{{
}}

}}  // namespace {request.name}
"""


def visibility_control(request: PackageRequest) -> str:
    """Return the header with the macros that make a symbol visible outside a shared library."""
    name = request.name.upper()
    guard = f"{name}__VISIBILITY_CONTROL_H_"
    return f"""\
#ifndef {guard}
#define {guard}

// {name}_PUBLIC marks symbols for users of the library, {name}_LOCAL marks internal symbols.
// On Windows, {name}_PUBLIC differs between the build of the library and its users.

#if defined _WIN32 || defined __CYGWIN__
  #ifdef {name}_BUILDING_LIBRARY
    #define {name}_PUBLIC __declspec(dllexport)
  #else
    #define {name}_PUBLIC __declspec(dllimport)
  #endif
  #define {name}_LOCAL
#else
  #define {name}_PUBLIC __attribute__ ((visibility("default")))
  #define {name}_LOCAL __attribute__ ((visibility("hidden")))
#endif

#endif  // {guard}
"""


def _format_header(request: PackageRequest, *, version: bool = False) -> str:
    project = f"{request.name} VERSION 0.0.0" if version else request.name
    return f"cmake_minimum_required(VERSION 3.8)\nproject({project})\n{_WARNING_OPTIONS}"


def _format_find_packages(names: Sequence[str]) -> str:
    return "\n# find dependencies\n" + "".join(f"find_package({name} REQUIRED)\n" for name in names)


def _format_library_target(request: PackageRequest, declaration: str, installed_headers: str) -> str:
    library = request.library_name
    return f"""
{declaration}
add_library({request.name}::{library} ALIAS {library})
{_format_target_settings(str(library), installed_headers)}"""


def _format_executable_target(request: PackageRequest, installed_headers: str) -> str:
    node = request.node
    return f"\nadd_executable({node} src/{node}.cpp)\n{_format_target_settings(str(node), installed_headers)}"


def _format_target_settings(target: str, installed_headers: str) -> str:
    return f"""\
target_compile_features({target} PUBLIC c_std_99 cxx_std_17)
target_include_directories({target} PUBLIC
  $<BUILD_INTERFACE:${{CMAKE_CURRENT_SOURCE_DIR}}/include>
  $<INSTALL_INTERFACE:{installed_headers}>
)
"""


def _format_ament_dependencies(target: str, names: Sequence[str]) -> str:
    if not names:
        return ""
    dependency_lines = "".join(f'  "{name}"\n' for name in names)
    return f"ament_target_dependencies(\n  {target}\n{dependency_lines})\n"


def _format_plain_dependencies(target: str, names: Sequence[str]) -> str:
    if not names:
        return ""
    folders = "".join(f"  ${{{name}_INCLUDE_DIRS}}\n" for name in names)
    libraries = "".join(f"  ${{{name}_LIBRARIES}}\n" for name in names)
    return (
        f"target_include_directories({target} PUBLIC\n{folders})\ntarget_link_libraries({target} PUBLIC\n{libraries})\n"
    )


def _format_export_definition(request: PackageRequest) -> str:
    return f"""
# On Windows: export the library's symbols while it is built, import them while it is used.
target_compile_definitions({request.library_name} PRIVATE "{request.name.upper()}_BUILDING_LIBRARY")
"""


def _format_library_installation(library: str, export: str) -> str:
    return f"""\
install(
  TARGETS {library}
  EXPORT {export}
  ARCHIVE DESTINATION lib
  LIBRARY DESTINATION lib
  RUNTIME DESTINATION bin
)
"""


def _format_package_config(request: PackageRequest) -> str:
    name = request.name
    return f"""
# what find_package({name}) of another project reads
configure_file({name}Config.cmake.in "${{PROJECT_BINARY_DIR}}/{name}Config.cmake" @ONLY)
configure_file({name}ConfigVersion.cmake.in "${{PROJECT_BINARY_DIR}}/{name}ConfigVersion.cmake" @ONLY)

install(
  FILES
    "${{PROJECT_BINARY_DIR}}/{name}Config.cmake"
    "${{PROJECT_BINARY_DIR}}/{name}ConfigVersion.cmake"
  DESTINATION share/${{PROJECT_NAME}}/cmake
)
install(
  EXPORT export_{name}
  NAMESPACE {name}::
  DESTINATION share/${{PROJECT_NAME}}/cmake
)
"""


def _format_find_dependencies(names: Sequence[str]) -> list[str]:
    if not names:
        return []
    return ["include(CMakeFindDependencyMacro)", *(f"find_dependency({name})" for name in names), ""]


def _make_class_name(request: PackageRequest) -> str:
    return "".join(word.title() for word in str(request.library_name).split("_"))
