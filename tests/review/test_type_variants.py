"""The lines of a review about topics that a source uses with several types under one name."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

NODE = """class Drive : public rclcpp::Node {{
public:
  Drive() : Node("drive") {{
    std::string topic;
    declare_parameter("topic", "twist");
    get_parameter("topic", topic);
{}  }}
}};
"""
TWIST = "    a_ = create_subscription<geometry_msgs::msg::Twist>({}, 1, std::bind(&Drive::f, this, _1));\n"
STAMPED = "    b_ = create_subscription<geometry_msgs::msg::TwistStamped>({}, 1, std::bind(&Drive::g, this, _1));\n"
BOTH = f"    if (is_stamped_) {{\n{STAMPED}    }} else {{\n{TWIST}    }}\n"


@pytest.mark.parametrize(
    ("old", "new", "expected", "is_breaking"),
    [
        (TWIST, BOTH, "subscriptions added: 'twist' (TwistStamped)", False),
        (BOTH, TWIST, "subscriptions removed: 'twist' (TwistStamped)", True),
        (TWIST, STAMPED, "subscription 'twist': type Twist -> TwistStamped", True),
    ],
)
@pytest.mark.parametrize("name", ['"twist"', "topic"])
def test_a_second_type_under_the_same_name_is_another_subscription(
    repository, compare, old, new, expected, is_breaking, name
):
    old, new = (NODE.format(text.replace("{}", name).replace("{{", "{").replace("}}", "}")) for text in (old, new))
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), "arm/src/drive.cpp": old})
    repository.write({"arm/src/drive.cpp": new})
    result = compare(repository)
    lines = [line for found in result.subjects for line in sentences(found)]
    assert [line for line in lines if line.startswith("subscription")] == [expected]
    assert breaking(result) == [expected] * is_breaking
