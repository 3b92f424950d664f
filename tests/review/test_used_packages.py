"""The lines of a review about packages and headers that sources include or import."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
CODE = "int f() { return 1; }\n"


def make_source(*headers: str) -> str:
    return "".join(f"#include <{header}>\n" for header in headers) + CODE


def find_sentences(repository, compare, old: dict[str, str], new: dict[str, str]) -> list[str]:
    repository.commit({**MANIFEST, **old})
    repository.write(new)
    result = compare(repository)
    assert breaking(result) == []
    return [sentence for found in result.subjects for sentence in sentences(found)]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (["a/b.h"], ["a/b.h", "bag_cpp/writer.hpp"], ["packages included for the first time: 'bag_cpp'"]),
        (["a/b.h"], ["a/b.h", "google/protobuf/message.h"], ["packages included for the first time: 'protobuf'"]),
        (["a/b.h", "bag_cpp/writer.hpp"], ["a/b.h"], ["packages no longer included: 'bag_cpp'"]),
        (["a/b.h"], ["a/b.h", "nav_msgs/msg/path.hpp", "nav_msgs/msg/grid.hpp"],
         ["packages included for the first time: 'nav_msgs'"]),
        (["a/noise.h"], ["a/Noise.hpp"], ["includes added: 'a/Noise.hpp'", "includes removed: 'a/noise.h'"]),
        (["a/noise.h"], ["a/noise.h", "a/dust.h"], ["includes added: 'a/dust.h'"]),
        (["nav_msgs/msg/path.hpp"], ["nav_msgs/msg/path.hpp", "nav_msgs/msg/grid.hpp"], []),
        (["a/b.h"], ["a/b.h", "vector", "sys/socket.h", "arm/tool.hpp", "detail/tool.hpp"], []),
    ],
)  # fmt: skip
def test_includes_of_other_packages(repository, compare, old, new, expected):
    own = {"arm/include/arm/tool.hpp": "#pragma once\n", "arm/src/detail/tool.hpp": "#pragma once\n"}
    files = {"arm/src/a.cpp": make_source(*old), **own}
    assert find_sentences(repository, compare, files, {"arm/src/a.cpp": make_source(*new)}) == expected


def test_package_that_another_source_includes_is_not_new(repository, compare):
    files = {"arm/src/a.cpp": make_source("a/b.h"), "arm/src/b.cpp": make_source("bag_cpp/writer.hpp")}
    new = {"arm/src/a.cpp": make_source("a/b.h", "bag_cpp/writer.hpp")}
    assert find_sentences(repository, compare, files, new) == []


def test_package_that_several_sources_include_is_told_once(repository, compare):
    files = {f"arm/src/{name}.cpp": make_source("a/b.h") for name in "ab"}
    new = {f"arm/src/{name}.cpp": make_source("a/b.h", "bag_cpp/writer.hpp") for name in "ab"}
    expected = ["packages included for the first time: 'bag_cpp'"]
    assert find_sentences(repository, compare, files, new) == expected


def test_headers_are_told_only_if_nothing_else_is(repository, compare):
    text = '#include <a/b.h>\n{}void Arm::f() {{ p = create_publisher<Bool>("{}", 1); }}\n'
    files, new = ({"arm/src/a.cpp": text.format(*values)} for values in (("", "on"), ("#include <a/c.h>\n", "off")))
    repository.commit({**MANIFEST, **files})
    repository.write(new)
    (found,) = compare(repository).subjects
    assert sentences(found) == ["publisher 'on' (Bool) renamed to 'off' (Bool)"]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("import rclpy\n", "import rclpy\nfrom nav_msgs.msg import Path\n",
         ["packages imported for the first time: 'nav_msgs'"]),
        ("import rclpy\n", "import os, numpy as np\nimport rclpy\n", ["packages imported for the first time: 'numpy'"]),
        ("import rclpy\nimport numpy\n", "import rclpy\n", ["packages no longer imported: 'numpy'"]),
        ("import rclpy\n", "import rclpy\nimport urllib2\nfrom arm.tool import open\nfrom tool import close\n",
         ["imports added: 'import urllib2', 'from arm.tool import open', 'from tool import close'"]),
    ],
)  # fmt: skip
def test_imports_of_other_packages(repository, compare, old, new, expected):
    files = {"arm/arm/a.py": old, "arm/arm/tool.py": "X = 1\n"}
    assert find_sentences(repository, compare, files, {"arm/arm/a.py": new}) == expected


def test_package_that_a_script_without_suffix_imports_is_not_new(repository, compare):
    script = "#!/usr/bin/env python3\nimport rclpy\nimport serial\n"
    files = {"arm/scripts/driver": script, "arm/scripts/notes": "import numpy\n"}
    repository.commit({**MANIFEST, **files})
    repository.write({"arm/arm/driver.py": "import serial\nimport numpy\n"})
    (found,) = compare(repository).subjects
    assert sentences(found) == ["packages imported for the first time: 'numpy'"]


def test_undeclared_package_of_a_script_without_suffix_is_breaking(repository, compare):
    script = "#!/usr/bin/env python3\nimport rclpy\n"
    repository.commit({**MANIFEST, "arm/scripts/driver": script})
    repository.write({"arm/scripts/driver": f"{script}import serial\n"})
    assert breaking(compare(repository)) == ["packages imported for the first time: 'serial'"]


def test_sources_of_a_new_package_use_no_new_packages(repository, compare):
    repository.commit(MANIFEST)
    repository.write(
        {"leg/package.xml": PACKAGE_XML.replace("arm_description", "leg"), "leg/a.cpp": make_source("a/b.h")}
    )
    found = [sentence for item in compare(repository).subjects for sentence in sentences(item)]
    assert not any("first time" in sentence for sentence in found)


@pytest.mark.parametrize(("name", "is_told"), [("nav_msgs", False), ("bag_tools", True)])
def test_package_of_messages_that_sources_in_cpp_include_is_not_new_in_python(repository, compare, name, is_told):
    manifest = MANIFEST["arm/package.xml"].replace("</package>", f"<depend>{name}</depend></package>")
    sources = {"arm/src/a.cpp": make_source(f"{name}/writer.h"), "arm/scripts/b.py": "import rospy\n"}
    files = {"arm/package.xml": manifest, **sources}
    new = {"arm/scripts/b.py": f"import rospy\nfrom {name}.msg import Path\n"}
    found = find_sentences(repository, compare, files, new)
    assert (f"packages imported for the first time: '{name}'" in found) == is_told
