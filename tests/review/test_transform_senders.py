"""The line of a review about sources that no longer publish transforms."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking

SENDER = """#include "node.hpp"
void Node::publish(const Frame & frame) {
  // {} {}
  tf_->sendTransform(frame.stamped(now()));
}
"""
CALL = "tf_->sendTransform(frame.stamped(now()));"
PYTHON = "class Node:\n    def publish(self, frame):\n        self.tf.sendTransform(frame.stamped())\n"
LINE = "no longer publishes transforms"


@pytest.mark.parametrize(
    ("name", "text", "new", "is_lost"),
    [
        ("node.cpp", SENDER, {"node.cpp": SENDER.replace(CALL, "log(frame);")}, True),
        ("node.cpp", SENDER, {"node.cpp": SENDER.replace(CALL, f"// {CALL}")}, True),
        ("node.cpp", SENDER, {"node.cpp": SENDER.replace(CALL, "more(frame);") + SENDER}, False),
        ("node.cpp", SENDER, {"node.cpp": SENDER.replace(CALL, "log(frame);"), "b.cpp": SENDER}, False),
        ("node.cpp", SENDER, {"node.cpp": 'void f() { n->create_publisher<TFMessage>("/tf", 10); }\n'}, False),
        ("node.py", PYTHON, {"node.py": PYTHON.replace("self.tf.sendTransform(frame.stamped())", "pass")}, True),
        ("node.py", PYTHON, {"node.py": PYTHON.replace("frame.stamped", "frame.stamp")}, False),
    ],
)
def test_lost_transforms_are_breaking(repository, compare, name, text, new, is_lost):
    repository.commit({"arm/package.xml": PACKAGE_XML, f"arm/src/{name}": text})
    repository.write({f"arm/src/{path}": content for path, content in new.items()})
    assert (LINE in breaking(compare(repository))) is is_lost


def test_a_line_about_lost_frames_is_enough(repository, compare):
    text = SENDER.replace("  tf_->", '  stamped_.child_frame_id = "tool";\n  tf_->')
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/src/node.cpp": text})
    repository.write({"arm/src/node.cpp": "void f() { g(1); }\n"})
    assert [line for line in breaking(compare(repository)) if "transform" in line or "frame" in line] == [
        "frames removed: 'tool'"
    ]
