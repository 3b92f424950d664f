"""The lines of a review about methods that are removed from classes with base classes."""

from __future__ import annotations

import pytest

from linkwright.graph import Node
from linkwright.review.sources.python.bases import NODE_NAMES
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PYTHON = {
    **MANIFEST,
    "arm/setup.py": "from setuptools import setup\nsetup(name='arm', packages=['arm'])\n",
    "arm/arm/__init__.py": "",
}
CPP = {**MANIFEST, "arm/CMakeLists.txt": "project(arm)\ninstall(DIRECTORY include/ DESTINATION include)\n"}
METHOD = "\n    def {}(self):\n        return 2\n"
BASE = "class Base:\n    def halt(self):\n        return 1\n\n\n"
OWN_NAMES = {"declare_parameters_from_overrides", "undeclared_overrides", "parameter_names"}
"""The public names of our nodes that rclpy does not have."""
REMOVED = "functions removed: 'Arm.{}'"


@pytest.mark.parametrize(
    ("head", "base", "method", "expected"),
    [
        ("from rclpy.node import Node\n\n\n", "Node", "stop", [REMOVED]),
        ("import rclpy.node\n\n\n", "rclpy.node.Node", "stop", [REMOVED]),
        ("from rclpy.node import Node\n\n\n", "Node", "destroy_node", []),
        (BASE, "Base", "stop", [REMOVED]),
        (BASE, "Base", "halt", []),
        ("from .base import Base\n\n\n", "Base", "stop", [REMOVED]),
        ("from arm.base import Base\n\n\n", "Base", "halt", []),
        ("from other.base import Base\n\n\n", "Base", "stop", []),
        (BASE, "Base, metaclass=Maker", "stop", []),
    ],
)
def test_a_method_removed_from_a_python_class_with_known_bases_is_breaking(
    repository, compare, head, base, method, expected
):
    text = f"{head}class Arm({base}):\n    def start(self):\n        return 1\n"
    repository.commit({**PYTHON, "arm/arm/base.py": BASE, "arm/arm/a.py": text + METHOD.format(method)})
    repository.write({"arm/arm/a.py": text})
    assert breaking(compare(repository)) == [sentence.format(method) for sentence in expected]


def test_a_method_that_moves_to_the_base_class_is_not_breaking(repository, compare):
    text = "from .base import Base\n\n\nclass Arm(Base):\n    def start(self):\n        return 1\n"
    repository.commit({**PYTHON, "arm/arm/base.py": BASE, "arm/arm/a.py": text + METHOD.format("stop")})
    repository.write({"arm/arm/base.py": BASE.rstrip() + "\n" + METHOD.format("stop"), "arm/arm/a.py": text})
    assert breaking(compare(repository)) == []


def test_other_arguments_of_a_method_are_breaking_if_the_base_class_is_in_a_deeper_module_of_the_package(
    repository, compare
):
    files = {f"arm/arm/{name}": "" for name in ("parts/__init__.py", "tools/__init__.py")}
    text = "from arm.parts.base import Base\n\n\nclass Arm(Base):\n    def read(self, count):\n        return count\n"
    setup = PYTHON["arm/setup.py"].replace("['arm']", "['arm', 'arm.tools']")
    repository.commit(
        {**PYTHON, **files, "arm/setup.py": setup, "arm/arm/parts/base.py": BASE, "arm/arm/tools/a.py": text}
    )
    repository.write({"arm/arm/tools/a.py": text.replace("(self, count)", "(self, register, count)")})
    assert breaking(compare(repository)) == ["function 'Arm.read': arguments (count) -> (register, count)"]


@pytest.mark.parametrize(
    ("packages", "is_installed"),
    [("['arm']", False), ("['arm', 'arm.parts']", True), ("find_packages()", True), ("list_packages()", True)],
)
def test_a_class_removed_from_a_folder_that_setup_does_not_install_is_not_breaking(
    repository, compare, packages, is_installed
):
    setup = f"from setuptools import find_packages, setup\nsetup(name='arm', packages={packages})\n"
    build_type = "<export><build_type>ament_python</build_type></export></package>"
    repository.commit(
        {
            "arm/package.xml": MANIFEST["arm/package.xml"].replace("</package>", build_type),
            "arm/setup.py": setup,
            "arm/arm/__init__.py": "",
            "arm/arm/parts/__init__.py": "",
            "arm/arm/parts/a.py": "class Arm:\n    pass\n\n\nclass Leg:\n    pass\n",
        }
    )
    repository.write({"arm/arm/parts/a.py": "class Leg:\n    pass\n"})
    assert breaking(compare(repository)) == (["classes removed: 'Arm'"] if is_installed else [])


def test_the_public_names_of_our_nodes_are_among_those_of_rclpy():
    public = {name for name in dir(Node) if not name.startswith("_") and name.islower()}
    assert public - OWN_NAMES <= NODE_NAMES


def _header(name: str, bases: str, *methods: str) -> str:
    lines = "".join(f"  {method};\n" for method in methods)
    return f"#pragma once\nnamespace arm {{\nclass {name}{bases} {{\npublic:\n  {name}();\n{lines}}};\n}}\n"


@pytest.mark.parametrize(
    ("base_header", "bases", "is_removed"),
    [
        (_header("Base", "", "void stop()"), " : public Base", False),
        (_header("Base", "", "void stop()"), " : public Other, public detail::Base", False),
        (_header("Base", "", "void halt()"), " : public Base", True),
        (_header("Base", " : public Root", "void stop() override"), " : public Base", False),
        (_header("Other", "", "void stop()"), " : public Base", True),
        (_header("Other", " : public Base", "void stop() override"), " : public Base", True),
    ],
)
@pytest.mark.parametrize("is_base_changed", [True, False])
def test_a_method_removed_from_a_cpp_class_is_breaking_unless_a_base_has_it(
    repository, compare, base_header, bases, is_removed, is_base_changed
):
    header = "arm/include/arm/arm.hpp"
    files = {"arm/include/arm/base.hpp": base_header, header: _header("Arm", bases, "void stop()", "void go()")}
    repository.commit({**CPP, **files})
    repository.write({header: _header("Arm", bases, "void go()")})
    if is_base_changed:
        repository.write({"arm/include/arm/base.hpp": base_header + "// changed\n"})
    assert breaking(compare(repository)) == (["functions removed: 'Arm::stop'"] if is_removed else [])


@pytest.mark.parametrize(
    ("head", "base", "method", "expected"),
    [
        ("from rclpy.action import ActionClient\n\n\n", "ActionClient", "is_accepted", [REMOVED]),
        ("from rclpy.action import ActionClient\n\n\n", "ActionClient", "send_goal", []),
        ("from rclpy.action.server import ActionServer\n\n\n", "ActionServer", "halt", [REMOVED]),
        ("import actionlib\n\n\n", "actionlib.SimpleActionServer", "halt", [REMOVED]),
        ("import actionlib\n\n\n", "actionlib.SimpleActionServer", "set_aborted", []),
        ("from smach import State\n\n\n", "State", "halt", [REMOVED]),
        ("", "Exception", "halt", [REMOVED]),
        ("", "dict", "update", []),
        ("from typing import Generic, TypeVar\n\nT = TypeVar('T')\n\n\n", "Generic[T]", "halt", [REMOVED]),
    ],
)
def test_a_method_removed_from_a_class_of_actions_or_a_built_in_class_is_breaking(
    repository, compare, head, base, method, expected
):
    text = f"{head}class Arm({base}):\n    def begin(self):\n        return 1\n"
    repository.commit({**PYTHON, "arm/arm/a.py": text + METHOD.format(method)})
    repository.write({"arm/arm/a.py": text})
    assert breaking(compare(repository)) == [sentence.format(method) for sentence in expected]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("return True", "self.count = 1", "True -> None"),
        ("return self.count", "return", "self.count -> None"),
        ("return self.read()", "self.read()", None),  # may have returned nothing, too
        ("return True", "raise NotImplementedError", None),
        ("return True", "pass", None),
        ("yield 1", "self.count = 1", None),
        ("self.count = 1", "return True", None),
        ("def inner():\n            return 1\n        inner()", "self.count = 1", None),
    ],
)
def test_a_method_that_returns_no_value_any_more_is_breaking(repository, compare, old, new, expected):
    text = "class Arm:\n    def stop(self):\n        {}\n"
    repository.commit({**PYTHON, "arm/arm/a.py": text.format(old)})
    repository.write({"arm/arm/a.py": text.format(new)})
    line = f"function 'Arm.stop': returned value {expected}"
    assert breaking(compare(repository)) == ([] if expected is None else [line])


def test_the_stated_type_of_a_lost_result_is_shown_for_functions_and_methods(repository, compare):
    text = (
        "def start() -> bool:\n    return check()\n\n\nclass Arm:\n    def stop(self) -> int:\n        return check()\n"
    )
    repository.commit({**PYTHON, "arm/arm/a.py": text})
    repository.write({"arm/arm/a.py": text.replace("return check()", "check()").replace("-> int", "-> None")})
    result = compare(repository)
    assert breaking(result) == [
        "function 'start': returned value bool -> None",
        "function 'Arm.stop': returned value int -> None",
    ]
    assert {str(change.reason) for _, change in result.breaking_changes} == {"programs that use the result get None"}


@pytest.mark.parametrize("added", ["goal.stop = True", "goal.stopped.connect(self.stop)"])
def test_a_method_is_not_removed_because_its_class_uses_the_name_in_another_way(repository, compare, added):
    text = f"class Arm:\n    def start(self, goal):\n        return 1\n{METHOD.format('stop')}"
    repository.commit({**PYTHON, "arm/arm/a.py": text})
    repository.write({"arm/arm/a.py": text.replace("return 1", f"{added}\n        return 1")})
    assert breaking(compare(repository)) == []
