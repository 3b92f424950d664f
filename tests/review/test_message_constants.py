"""Constants of messages of the repository name topics and frames of sources."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

FILES = {
    "messages/arm_msgs/package.xml": PACKAGE_XML.replace("arm_description", "arm_msgs"),
    "messages/arm_msgs/msg/Topics.msg": "string DEPTH = 'dr/depth'  # m\nstring POSE = \"dr/pose\"\nint8 COUNT = 3\n",
    "nodes/drive/arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"),
}
PYTHON = """from arm_msgs.msg import Topics as ArmTopics
from std_msgs.msg import Float64


class Arm(Node):
    def __init__(self):
        self.topic = ArmTopics.DEPTH
        self.pub = self.create_publisher({}, {}, 10)
"""
CPP = """#include "arm_msgs/msg/topics.hpp"
using arm_msgs::msg::Topics;
Arm::Arm() {{
  pub_ = create_publisher<std_msgs::msg::{}>({}, 10);
}}
"""


@pytest.mark.parametrize(
    ("text", "old", "new"),
    [
        (PYTHON, "ArmTopics.DEPTH", "ArmTopics.POSE"),
        (PYTHON, "self.topic", "ArmTopics.POSE"),
        (CPP, "Topics::DEPTH", "arm_msgs::msg::Topics::POSE"),
    ],
)
def test_topic_of_another_constant_of_a_message_is_renamed(repository, compare, text, old, new):
    path = f"nodes/drive/arm/arm/arm.{'py' if text is PYTHON else 'cpp'}"
    repository.commit({**FILES, path: text.format("Float64", old)})
    repository.write({path: text.format("Float64", new)})
    result = compare(repository)
    assert breaking(result) == ["publisher 'dr/depth' (Float64) renamed to 'dr/pose' (Float64)"]


@pytest.mark.parametrize(
    ("old", "new"),
    [("ArmTopics.DEPTH", "'dr/depth'"), ("ArmTopics.COUNT", "ArmTopics.COUNT"), ("ArmTopics.X", "ArmTopics.X")],
)
def test_same_name_by_a_constant_of_a_message_is_no_change(repository, compare, old, new):
    path = "nodes/drive/arm/arm/arm.py"
    repository.commit({**FILES, path: PYTHON.format("Float64", old)})
    repository.write({path: PYTHON.format("Int8", new)})
    shown = "dr/depth" if "DEPTH" in old else old
    lines = sentences(subject(compare(repository), path))
    assert [line for line in lines if "publisher" in line] == [f"publisher '{shown}': type Float64 -> Int8"]


@pytest.mark.parametrize(("folder", "shown"), [("", "ArmTopics.DEPTH"), ("messages", "dr/depth")])
def test_messages_beside_the_repository_are_unknown(repository, compare, folder, shown):
    """What is beside a repository differs between the computers."""
    place = repository.root / (folder or "..") / "arm_msgs"
    for path, text in FILES.items():
        if path.startswith("messages/"):
            file = place / path.removeprefix("messages/arm_msgs/")
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
    package = "nodes/arm/" if folder else ""
    files = {f"{package}package.xml": FILES["nodes/drive/arm/package.xml"]}
    repository.commit({**files, f"{package}arm/arm.py": PYTHON.format("Float64", "ArmTopics.DEPTH")})
    repository.write({f"{package}arm/arm.py": PYTHON.format("Int8", "ArmTopics.DEPTH")})
    lines = sentences(subject(compare(repository), f"{package}arm/arm.py"))
    assert f"publisher '{shown}': type Float64 -> Int8" in lines
