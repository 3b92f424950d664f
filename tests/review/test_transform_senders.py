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


NEW_LINE = "publishes transforms now"


@pytest.mark.parametrize(
    ("old", "new", "is_new"),
    [
        ({"node.cpp": SENDER.replace(CALL, "log(frame);")}, {"node.cpp": SENDER}, True),
        ({"node.cpp": SENDER.replace(CALL, "log(frame);"), "b.cpp": SENDER},
         {"node.cpp": SENDER, "b.cpp": SENDER.replace(CALL, "log(frame);")}, False),
        ({"node.cpp": SENDER}, {"node.cpp": SENDER.replace("now()", "time")}, False),
    ],
)  # fmt: skip
def test_new_transforms_are_told(repository, compare, old, new, is_new):
    repository.commit({"arm/package.xml": PACKAGE_XML, **{f"arm/src/{path}": text for path, text in old.items()}})
    repository.write({f"arm/src/{path}": content for path, content in new.items()})
    lines = [str(change.sentence) for subject in compare(repository).subjects for change in subject.changes]
    assert (NEW_LINE in lines) is is_new
