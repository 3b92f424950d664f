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
