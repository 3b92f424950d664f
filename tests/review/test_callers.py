"""The lines of a review about Python files that use removed parts of a module."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

MODULE = """import os


def load(path, log):
    return read(path, log)


class Plan:
    def __init__(self, name, size=1):
        self.name = name


def walk():
    pass
"""
FILES = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
    "arm/arm/__init__.py": "",
    "arm/arm/plans.py": MODULE,
}
CALLER = "from arm.plans import load, walk\nfrom . import plans\n\n\ndef main():\n    load('a', log)\n    walk()\n"


@pytest.fixture
def review_calls(repository, compare):
    """Review a replacement in the module.

    Return the breaking lines of the caller with their places.
    """

    def run(old, new, caller=CALLER, path="arm/arm/node.py", module="arm/arm/plans.py"):
        assert old in MODULE
        files = {**FILES, path: caller}
        files[module] = files.pop("arm/arm/plans.py")
        repository.commit(files)
        repository.write({module: MODULE.replace(old, new)})
        found = [each for each in compare(repository).subjects if each.path == path]
        return [(str(change.sentence), change.location.line) for each in found for change in each.changes]

    return run


OLD_CALL = "calls '{}' of 'arm/arm/plans.py' with the old arguments; the new ones are {}"


@pytest.mark.parametrize(
    ("old", "new", "caller", "expected"),
    [
        ("load(path, log)", "load(path, color, log)", CALLER,
         [(OLD_CALL.format("load", "(path, color, log)"), 6)]),
        ("name, size=1", "size, name", "from arm import plans as p\np.Plan('a')\n",
         [(OLD_CALL.format("Plan", "(size, name)"), 2)]),
        ("name, size=1", "name", "import arm.plans\narm.plans.Plan('a', size=3)\n",
         [(OLD_CALL.format("Plan", "(name)"), 2)]),
        ("def walk():", "def go():", CALLER, [("imports 'walk', which 'arm/arm/plans.py' no longer has", 1)]),
        ("def walk():", "def go():", "from . import plans\nplans.walk()\n",
         [("calls 'walk', which 'arm/arm/plans.py' no longer has", 2)]),
    ],
)  # fmt: skip
def test_a_caller_whose_calls_no_longer_fit_is_breaking(review_calls, old, new, caller, expected):
    assert review_calls(old, new, caller) == expected


@pytest.mark.parametrize(
    ("old", "new", "caller"),
    [
        ("load(path, log)", "load(path, log, color=1)", CALLER),
        ("load(path, log)", "load(path, color, log)", CALLER.replace("'a', log", "'a', 1, log")),
        ("load(path, log)", "load(path, color, log)", CALLER.replace("'a', log", "*items")),
        ("load(path, log)", "load(path, color, log)", "from other.plans import load\nload('a', log)\n"),
        ("load(path, log)", "load(path, color, log)", "from arm.plans import load\nload = f\nload('a', log)\n"),
        ("def load", "@cached\ndef load", CALLER),
        ("def walk():", "from arm.walking import walk\n\n\ndef go():", CALLER),
        ("def walk():", "from arm.walking import *\n\n\ndef go():", CALLER),
        ("def walk():", "def go():", "try:\n    from arm.plans import walk\nexcept ImportError:\n    walk = None\n"),
    ],
)
def test_calls_that_fit_and_modules_that_are_not_certain_are_not_told(review_calls, old, new, caller):
    assert review_calls(old, new, caller) == []


def test_a_module_beside_a_script_is_found(review_calls):
    caller = "from plans import load\nload('a', log)\n"
    found = review_calls(
        "load(path, log)", "load(path, color, log)", caller, "arm/scripts/n.py", "arm/scripts/plans.py"
    )
    assert [line for _, line in found] == [2]
    assert review_calls("load(path, log)", "load(log)", caller, "arm/scripts/n.py", "arm/other/plans.py") == []


def test_an_import_of_a_module_that_is_gone_is_breaking(repository, compare):
    repository.commit({**FILES, "arm/arm/node.py": CALLER, "arm/arm/other.py": "import plans\nimport arm\n"})
    repository.write({"arm/arm/plans.py": None})
    result = compare(repository)
    sentence = "imports 'arm/arm/plans.py', which no longer exists"
    assert sentences(subject(result, "arm/arm/node.py")) == [sentence, sentence]
    assert breaking(result).count(sentence) == 2


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("load(path, log)", "load(path, color, log)",
         ["function 'load': arguments (path, log) -> (path, color, log)"], True),
        ("load(path, log)", "load(path, log=None)",
         ["function 'load': arguments (path, log) -> (path, log=None)"], False),
        ("name, size=1", "name, size", ["class 'Plan': arguments (name, size=1) -> (name, size)"], True),
        ("def walk", "def stop(now):\n    pass\n\n\ndef walk", ["functions added: 'stop' (now)"], False),
    ],
)  # fmt: skip
def test_other_arguments_of_a_module_are_told(repository, compare, old, new, expected, is_breaking):
    repository.commit(FILES)
    repository.write({"arm/arm/plans.py": MODULE.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, "arm/arm/plans.py")) == expected
    assert bool(breaking(result)) is is_breaking


def test_the_functions_of_a_class_with_another_name_are_compared(repository, compare):
    repository.commit(FILES)
    method = "        self.name = name\n\n    def run(self):\n        go({})\n"
    text = MODULE.replace("        self.name = name\n", method)
    repository.commit({"arm/arm/plans.py": text.format(1)})
    repository.write({"arm/arm/plans.py": text.format("now()").replace("class Plan", "class Plans")})
    assert sentences(subject(compare(repository), "arm/arm/plans.py")) == [
        "class 'Plan' (name, size=1) renamed to 'Plans' (name, size=1)",
        "in 'Plans.run()': `go(1)` -> `go(now())`",
    ]


def test_a_class_in_a_folder_that_is_no_package_is_told_and_not_breaking(repository, compare):
    repository.commit({**FILES, "arm/arm/tools/grip.py": "class Grip:\n    def __init__(self, force):\n        pass\n"})
    repository.write({"arm/arm/tools/grip.py": "class Hold:\n    def __init__(self, width, time):\n        pass\n"})
    result = compare(repository)
    assert sentences(subject(result, "arm/arm/tools/grip.py")) == [
        "classes added: 'Hold' (width, time)",
        "classes removed: 'Grip' (force)",
    ]
    assert breaking(result) == []


SETUP = "from setuptools import setup\nsetup(name='arm', version='1.0.0', packages=['arm'])\n"
METHODS = "class Plan:\n    def __init__(self):\n        f(self.on_end)\n\n    def run(self, goal):\n        pass\n\n"
METHODS += "    def on_end(self):\n        pass\n\n    def _own(self):\n        pass\n"


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        ("def run(self, goal)", "def run(self, goal, time)",
         "function 'Plan.run': arguments (goal) -> (goal, time)", True),
        ("def run(self, goal)", "def run(self, goal, time=1)",
         "function 'Plan.run': arguments (goal) -> (goal, time=1)", False),
        ("def run(self, goal)", "def runs(self, goal)",
         "function 'Plan.run' (goal) renamed to 'Plan.runs' (goal)", True),
        ("    def run(self, goal):\n        pass\n\n", "", "functions removed: 'Plan.run' (goal)", True),
        ("    def on_end(self):\n        pass\n", "", "uses its attribute 'on_end', which is no longer defined", True),
        ("    def _own(self):\n        pass\n", "", "code removed: 'Plan._own()'", False),
        ("class Plan:", "class Plan(Base):", "code changed in 'Plan'", False),
    ],
)  # fmt: skip
def test_methods_of_an_installed_class_are_told(repository, compare, old, new, expected, is_breaking):
    repository.commit({**FILES, "arm/setup.py": SETUP, "arm/arm/plans.py": METHODS})
    repository.write({"arm/arm/plans.py": METHODS.replace(old, new)})
    result = compare(repository)
    assert sentences(subject(result, "arm/arm/plans.py")) == [expected]
    assert bool(breaking(result)) is is_breaking


SELF_CALLER = """class Arm:
    def step(self):
        self.move()

    def move(self):
        pass
"""


@pytest.mark.parametrize(
    ("text", "other_text", "is_breaking"),
    [
        ("class Arm:", "class Arm:", True),
        ("class Arm:", "class Arm(Base):", False),
        ("self.move()", "try: self.move()\n        except E: pass", False),
        ("    def step", "    move = None\n\n    def step", False),
    ],
)
def test_a_class_that_calls_a_removed_method_of_itself_fails(repository, compare, text, other_text, is_breaking):
    source = SELF_CALLER.replace(text, other_text)
    repository.commit({"scripts/arm.py": source})
    repository.write({"scripts/arm.py": source.replace("def move", "def go")})
    found = ["calls its method 'move', which is no longer defined"] if is_breaking else []
    assert breaking(compare(repository)) == found


ROBOT = """class Robot:
    def __init__(self, ip):
        self.ip = ip

    def read_position(self):
        pass
"""
USER = """from arm.robot import Robot


class Node:
    def __init__(self):
        self.bot = Robot("1")

    def step(self):
        self.bot.read_position()
        self.bot.ip.strip()
"""
OBJECT_FILES = {"arm/package.xml": FILES["arm/package.xml"], "arm/arm/__init__.py": "", "arm/arm/robot.py": ROBOT}


@pytest.mark.parametrize(
    ("path", "old", "new", "is_breaking"),
    [
        ("node.py", "read_position()", "read_pose()", True),
        ("robot.py", "def read_position", "def read_pose", True),
        ("robot.py", "class Robot:", "class Robot(Base):", False),
        ("node.py", 'Robot("1")', 'Robot("1") if a else Other()', False),
    ],
)
def test_a_method_that_the_class_of_an_object_lacks_is_breaking(repository, compare, path, old, new, is_breaking):
    repository.commit({**OBJECT_FILES, "arm/arm/node.py": USER})
    text = {"node.py": USER, "robot.py": ROBOT}[path].replace(old, new)
    text = text if is_breaking else text.replace("read_position", "read_pose")
    repository.write({f"arm/arm/{path}": text})
    name = "read_pose" if path == "node.py" else "read_position"
    sentence = f"calls the method '{name}', which 'Robot' in 'arm/arm/robot.py' does not have"
    assert (sentence in breaking(compare(repository))) == is_breaking


def test_a_method_that_was_missing_before_is_not_new(repository, compare):
    repository.commit({**OBJECT_FILES, "arm/arm/node.py": USER.replace("read_position", "read_pose")})
    repository.write({"arm/arm/node.py": USER.replace("read_position", "read_pose").replace('"1"', '"2"')})
    assert breaking(compare(repository)) == []


def test_a_module_of_another_folder_is_found_if_the_file_adds_folders(repository, compare):
    user = USER.replace("from arm.robot import", "import sys\nsys.path.append('tools')\nfrom robot import")
    files = {"arm/package.xml": FILES["arm/package.xml"], "arm/tools/robot.py": ROBOT, "arm/src/node.py": user}
    repository.commit(files)
    repository.write({"arm/src/node.py": user.replace("read_position()", "read_pose()")})
    expected = "calls the method 'read_pose', which 'Robot' in 'arm/tools/robot.py' does not have"
    assert breaking(compare(repository)) == [expected]


@pytest.mark.parametrize("head", ["# Generated by the protocol buffer compiler.  DO NOT EDIT!\n", ""])
def test_a_generated_module_may_leave_the_repository(repository, compare, head):
    repository.commit(
        {**FILES, "arm/arm/state_pb2.py": f"{head}State = 1\n", "arm/arm/node.py": "from arm import state_pb2\n"}
    )
    repository.write({"arm/arm/state_pb2.py": None})
    failing = [sentence for sentence in breaking(compare(repository)) if sentence.startswith("imports ")]
    assert bool(failing) == (not head)


def test_functions_of_an_added_module_are_told(repository, compare):
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    repository.commit({"arm/package.xml": manifest, "arm/arm/__init__.py": ""})
    text = "def walk(now):\n    pass\n\n\nclass Plan:\n    def run(self):\n        pass\n"
    repository.write({"arm/arm/plans.py": text})
    lines = sentences(subject(compare(repository), "arm/arm/plans.py"))
    assert lines == ["classes added: 'Plan'", "functions added: 'walk' (now)"]


def test_a_class_in_another_language_is_not_the_same_class(repository, compare):
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    repository.commit({"arm/package.xml": manifest, "arm/arm/__init__.py": "", "arm/src/plan.cpp": "class Plan {};\n"})
    repository.write({"arm/arm/plans.py": "class Plan:\n    pass\n", "arm/src/plan.cpp": "class Plan { int a; };\n"})
    assert sentences(subject(compare(repository), "arm/arm/plans.py")) == ["classes added: 'Plan'"]


LAUNCH_USER = (
    "from arm import Robot\n\n\ndef generate_launch_description():\n    return [Robot.make_ip(), Robot.PORT]\n"
)
CLASS_METHODS = "class Robot:\n    PORT = 1\n\n    @staticmethod\n    def make_ip():\n        return 2\n"
LOST_METHOD = "calls the method 'make_ip', which 'Robot' in 'arm/arm/robot.py' does not have"
LOST_CONSTANT = "uses the attribute 'PORT', which 'Robot' in 'arm/arm/robot.py' does not have"


@pytest.mark.parametrize(
    ("old", "new", "init", "expected"),
    [
        ("def make_ip", "def find_ip", "from .robot import Robot\n", [LOST_METHOD]),
        ("PORT = 1", "DOOR = 1", "from arm.robot import Robot\n", [LOST_CONSTANT]),
        ("def make_ip", "def find_ip", "from other.robot import Robot\n", []),
        ("class Robot:\n    PORT = 1", "class Robot(Base):\n    DOOR = 1", "from .robot import Robot\n", []),
    ],
)
def test_a_launch_file_that_uses_what_a_class_lost_fails(repository, compare, old, new, init, expected):
    files = {**OBJECT_FILES, "arm/arm/__init__.py": init, "arm/arm/robot.py": CLASS_METHODS}
    repository.commit({**files, "arm/launch/arm.launch.py": LAUNCH_USER})
    repository.write({"arm/arm/robot.py": CLASS_METHODS.replace(old, new)})
    found = breaking(compare(repository))
    assert [sentence for sentence in found if "does not have" in sentence] == expected


def test_a_test_that_calls_a_removed_function_fails(repository, compare):
    repository.commit(
        {**FILES, "arm/test/test_plans.py": "from arm.plans import walk\n\n\ndef test_walk():\n    walk()\n"}
    )
    repository.write({"arm/arm/plans.py": MODULE.replace("def walk", "def run")})
    assert "imports 'walk', which 'arm/arm/plans.py' no longer has" in breaking(compare(repository))


@pytest.mark.parametrize(
    ("base", "method", "is_breaking"),
    [("Node", "halt", True), ("Node", "get_logger", False), ("other.Thing", "halt", False), ("Plain", "halt", True)],
)
def test_a_method_that_a_class_with_a_known_base_class_lacks_is_breaking(
    repository, compare, base, method, is_breaking
):
    robot = f"from rclpy.node import Node\nimport other\n\n\nclass Plain:\n    pass\n\n\nclass Robot({base}):\n"
    user = f"from arm.robot import Robot\n\nbot = Robot()\nbot.{method}()\n"
    lost = f"    def {method}(self):\n        pass\n"
    repository.commit({**OBJECT_FILES, "arm/arm/robot.py": f"{robot}    speed = 1\n\n{lost}", "arm/arm/main.py": user})
    repository.write({"arm/arm/robot.py": f"{robot}    speed = 1\n"})
    sentence = f"calls the method '{method}', which 'Robot' in 'arm/arm/robot.py' does not have"
    assert (sentence in breaking(compare(repository))) is is_breaking
