"""The lines of a review about names in sources that depend on a new condition."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences

MANIFEST = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
PYTHON = "from rclpy.node import Node\n\n\nclass Arm(Node):\n    def start(self):\n        self.ok = True\n{}"
PUBLISHER = "        self.create_publisher(Bool, '{}', 10)\n"
IF = "        if self.debug:\n    {}"
CPP = "void Arm::start() {{\n  ok_ = true;\n{}}}\n"
CPP_PUBLISHER = '  pub_ = create_publisher<std_msgs::msg::Bool>("out", 10);\n'
DECLARED = "        self.declare_parameter('rate', 10)\n"
READ = "        self.rate = self.get_parameter('rate').value\n"
OUT = PUBLISHER.format("out")


@pytest.mark.parametrize(
    ("path", "old", "new", "expected"),
    [
        ("a.py", OUT, IF.format(OUT), ["publisher 'out': now only if self.debug"]),
        ("a.py", IF.format(OUT), OUT, ["publisher 'out': no longer only if self.debug"]),
        ("a.py", OUT, "        if self.ok:\n            pass\n        else:\n    " + OUT,
         ["publisher 'out': now only if not (self.ok)"]),
        ("a.py", OUT + PUBLISHER.format("b"), IF.format(OUT) + "    " + PUBLISHER.format("b"),
         ["publishers 'out', 'b': now only if self.debug"]),
        ("a.py", OUT, IF.format(OUT) + "        else:\n    " + OUT.replace("10", "5"), []),
        ("a.cpp", CPP_PUBLISHER, "  if (debug_ && name_ == \"a)\") {\n  " + CPP_PUBLISHER + "  }\n",
         ["publisher 'out': now only if debug_ && name_ == \"a)\""]),
        ("a.cpp", CPP_PUBLISHER, "  if (debug_)\n  " + CPP_PUBLISHER, ["publisher 'out': now only if debug_"]),
        ("a.cpp", CPP_PUBLISHER, "  if (a_) {\n    f();\n  } else if (b_) {\n    g();\n  } else {\n" + CPP_PUBLISHER
         + "  }\n", ["publisher 'out': now only if !(a_) and !(b_)"]),
        ("a.cpp", CPP_PUBLISHER, "  if (a_) { f(); }\n" + CPP_PUBLISHER, []),
        ("a.py", DECLARED, IF.format(DECLARED), ["parameter 'rate': now only if self.debug"]),
        ("a.py", DECLARED + READ, DECLARED + IF.format(READ), ["parameter 'rate': read now only if self.debug"]),
        ("a.py", DECLARED + IF.format(READ), DECLARED + READ, ["parameter 'rate': no longer read only if self.debug"]),
        ("a.py", DECLARED, "        if not self.has_parameter('rate'):\n    " + DECLARED, []),
        ("a.cpp", '  nh_.getParam("rate", rate_);\n', '  if (slow_) {\n  nh_.getParam("rate", rate_);\n  }\n',
         ["parameter 'rate': now only if slow_"]),
        ("a.cpp", '  nh_.getParam("rate", rate_);\n',
         '  if (nh_.hasParam("rate")) {\n  nh_.getParam("rate", rate_);\n  }\n', []),
    ],
)  # fmt: skip
def test_a_name_behind_a_new_condition_is_told(repository, compare, path, old, new, expected):
    text = PYTHON if path.endswith(".py") else CPP
    repository.commit({**MANIFEST, f"arm/{path}": text.format(old)})
    repository.write({f"arm/{path}": text.format(new)})
    found = [line for line in sentences(compare(repository).subjects[0]) if "only if" in line]
    assert found == expected


PARAMETER = "        self.debug = self.declare_parameter('debug', {}).value\n"
CPP_PARAMETER = '  declare_parameter("debug", {0});\n  get_parameter("debug", debug_);\n'
REASON = "by default, programs that use the name 'out' do not find it"


@pytest.mark.parametrize(
    ("path", "default", "condition", "is_breaking"),
    [
        ("a.py", "False", "self.debug", True),
        ("a.py", "True", "self.debug", False),
        ("a.py", "True", "not self.debug", True),
        ("a.py", "'slow'", "self.debug == 'fast'", True),
        ("a.py", "'slow'", "self.debug != 'fast'", False),
        ("a.py", "False", "self.ok and self.debug", True),
        ("a.py", "False", "self.ok or self.debug", False),
        ("a.py", "False", "self.get_parameter('debug').value", True),
        ("a.py", "False", "self.other", False),
        ("a.cpp", "false", "debug_", True),
        ("a.cpp", "true", "!debug_", True),
        ("a.cpp", "3", "ok_ && debug_ == 2", True),
        ("a.cpp", "2", "debug_ == 2", False),
    ],
)
def test_a_condition_that_a_parameter_does_not_fulfill_by_default_is_breaking(
    repository, compare, path, default, condition, is_breaking
):
    if path.endswith(".py"):
        head, old = PARAMETER.format(default), OUT
        new, text = f"        if {condition}:\n    {OUT}", PYTHON
    else:
        head, old = CPP_PARAMETER.format(default), CPP_PUBLISHER
        new, text = f"  if ({condition}) {{\n{CPP_PUBLISHER}  }}\n", CPP
    repository.commit({**MANIFEST, f"arm/{path}": text.format(head + old)})
    repository.write({f"arm/{path}": text.format(head + new)})
    (change,) = [each for each in compare(repository).subjects[0].changes if "only if" in str(each.sentence)]
    assert (None if change.reason is None else str(change.reason)) == (REASON if is_breaking else None)


MODES = """class Mode(IntEnum):
    SLOW = 0

    FAST = 1  # quick


MODE = 'mode'


"""


@pytest.mark.parametrize(
    ("condition", "is_breaking"),
    [("mode is Mode.FAST", True), ("mode == Mode.SLOW", False), ("mode is not Mode.SLOW", True),
     ("mode is Mode.OTHER", False)],
)  # fmt: skip
def test_a_condition_on_a_member_of_an_enumeration_has_its_value(repository, compare, condition, is_breaking):
    lines = "        given = self.declare_parameter(MODE, value=Mode.SLOW)\n        mode = Mode(given.value)\n"
    text = MODES + PYTHON
    repository.commit({**MANIFEST, "arm/a.py": text.format(lines + OUT)})
    repository.write({"arm/a.py": text.format(f"{lines}        if {condition}:\n    {OUT}")})
    (change,) = [each for each in compare(repository).subjects[0].changes if "only if" in str(each.sentence)]
    assert (None if change.reason is None else str(change.reason)) == (REASON if is_breaking else None)


def test_a_condition_on_a_parameter_that_a_file_of_the_package_sets_is_not_breaking(repository, compare):
    head, settings = PARAMETER.format("False"), {"arm/config/arm.yaml": "arm:\n  ros__parameters:\n    debug: true\n"}
    repository.commit({**MANIFEST, **settings, "arm/a.py": PYTHON.format(head + OUT)})
    repository.write({"arm/a.py": PYTHON.format(head + IF.format(OUT))})
    assert [str(each.reason) for each in compare(repository).subjects[0].changes if each.reason] == []
