"""The lines of a review about headers that a package newly offers to other packages."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

BUILD = "project(arm)\nfind_package(ament_cmake REQUIRED)\n{install}ament_package()\n"
EXPORTED = "install(DIRECTORY src/include/ DESTINATION include/arm)\nament_export_include_directories({})\n"
INSTALL = "install(DIRECTORY include/ DESTINATION include)\n"
HEADER = "#pragma once\nnamespace arm {\nclass Leg {\n public:\n  void bend();\n};\n}\n"
LINES = ["header added: other packages can include 'arm/leg.hpp'", "classes added: 'Leg'"]


@pytest.mark.parametrize(
    ("install", "path", "expected"),
    [
        (INSTALL, "arm/include/arm/leg.hpp", LINES),
        (EXPORTED.format("include"), "arm/src/include/leg.hpp", LINES),
        (EXPORTED.format("include/${PROJECT_NAME}"), "arm/src/include/arm/leg.hpp", LINES),
        ("", "arm/include/arm/leg.hpp", []),
        (INSTALL, "arm/src/leg.hpp", []),
    ],
)
def test_an_added_header_is_told_if_it_is_installed(repository, compare, install, path, expected):
    files = {
        "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
        "arm/CMakeLists.txt": BUILD.format(install=install),
        "arm/include/arm/arm.hpp": "#pragma once\n",
    }
    repository.commit(files)
    repository.write({path: HEADER})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert [line for line in lines if "Leg" in line or "leg" in line] == expected


@pytest.mark.parametrize(("install", "expected"), [(INSTALL, ["functions added: 'lift' (double)"]), ("", [])])
def test_functions_outside_of_classes_of_an_added_header_are_told(repository, compare, install, expected):
    files = {
        "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
        "arm/CMakeLists.txt": BUILD.format(install=install),
        "arm/include/arm/arm.hpp": "#pragma once\n",
    }
    repository.commit(files)
    repository.write(
        {"arm/include/arm/leg.hpp": HEADER.replace("};\n}", "};\nnamespace motion {\nint lift(double);\n}\n}")}
    )
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert [line for line in lines if "functions" in line] == expected


@pytest.mark.parametrize("guard", ["#pragma once\n{}", "#ifndef LEG_H\n#define LEG_H\n{}\n#endif  // LEG_H\n", "{}"])
def test_header_of_comments_has_no_code(repository, compare, guard):
    code = "class Leg {};\n#define LEGS 4\n"
    comments = "".join(f"// {line}\n" for line in code.splitlines())
    files = {
        "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
        "arm/CMakeLists.txt": BUILD.format(install=INSTALL),
        "arm/include/arm/leg.hpp": guard.format(code),
    }
    repository.commit(files)
    repository.commit({"arm/include/arm/leg.hpp": guard.format(comments)})
    lines = [line for subject in compare(repository, "HEAD~1..HEAD").subjects for line in sentences(subject)]
    assert "the file has no code any more" in lines
    repository.commit({"arm/include/arm/foot.hpp": guard.format(comments)})
    lines = [line for subject in compare(repository, "HEAD~1..HEAD").subjects for line in sentences(subject)]
    assert [line for line in lines if "header" in line] == ["header without code added: 'arm/foot.hpp'"]
    repository.commit({"arm/include/arm/leg.hpp": guard.format(code)})
    lines = [line for subject in compare(repository, "HEAD~1..HEAD").subjects for line in sentences(subject)]
    assert not [line for line in lines if "no code" in line]


@pytest.mark.parametrize(
    ("old", "new", "is_told"),
    [
        (("include", "include"), ("include/arm", "include/arm"), False),
        (("include/arm", "include"), ("include", "include"), False),
        (("include", "include"), ("include/arm", "include"), True),
    ],
)
def test_headers_that_move_are_told_if_other_packages_no_longer_find_them(repository, compare, old, new, is_told):
    install = "install(DIRECTORY include/ DESTINATION {})\nament_export_include_directories({})\n"
    files = {
        "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
        "arm/CMakeLists.txt": BUILD.format(install=install.format(*old)),
        "arm/include/arm/leg.hpp": HEADER,
    }
    repository.commit(files)
    repository.write({"arm/CMakeLists.txt": BUILD.format(install=install.format(*new))})
    lines = [line for subject in compare(repository).subjects for line in sentences(subject)]
    assert any("leg.hpp" in line for line in lines) is is_told
