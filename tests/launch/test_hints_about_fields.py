"""Hints about fields that a message does not have."""

import pytest

from linkwright.launch.errors.user_code import create_hint
from linkwright.messages import get_message


@pytest.mark.parametrize(
    ("name", "field", "hint"),
    [
        ("geometry_msgs/msg/PoseStamped", "position", "did you mean '.pose.position'?"),
        ("geometry_msgs/msg/Twist", "x", "did you mean '.angular.x' or '.linear.x'?"),
        ("sensor_msgs/msg/LaserScan", "range", "did you mean 'ranges', 'range_min' or 'range_max'?"),
        ("std_msgs/msg/String", "lower", "did you mean '.data.lower'?"),
        ("std_msgs/msg/String", "position", "None"),
    ],
)
def test_missing_field_has_hint(name, field, hint):
    with pytest.raises(AttributeError) as error:
        getattr(get_message(name)(), field)
    assert str(create_hint(error.value)) == hint
