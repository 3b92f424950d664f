# SPDX-License-Identifier: Apache-2.0
"""What the node decides, without a robot."""

import pytest
from my_robot_vision.follow_object import class_of, velocity
from vision_msgs.msg import BoundingBox2D, Detection2D, ObjectHypothesisWithPose


def box(x, width):
    made = BoundingBox2D(size_x=float(width), size_y=float(width))
    made.center.position.x = float(x)
    return made


def test_a_thing_in_the_middle_is_driven_to_until_it_is_wide_enough():
    forward, turn = velocity(box(320, 40), 640, 0.25, 0.3, 1.0)
    assert (forward, turn) == (pytest.approx(0.3), pytest.approx(0.0))
    assert velocity(box(320, 160), 640, 0.25, 0.3, 1.0)[0] == pytest.approx(0.0)
    assert velocity(box(320, 300), 640, 0.25, 0.3, 1.0)[0] == 0.0, 'it never drives back'


def test_a_thing_on_the_left_is_turned_to_the_left():
    forward, turn = velocity(box(0, 40), 640, 0.25, 0.3, 1.0)
    assert forward == pytest.approx(0.0)
    assert turn == pytest.approx(1.0)


def test_the_most_likely_class_counts():
    detection = Detection2D()
    assert class_of(detection) == ''
    for name, score in (('crate', 0.2), ('ball', 0.7)):
        result = ObjectHypothesisWithPose()
        result.hypothesis.class_id, result.hypothesis.score = name, score
        detection.results.append(result)
    assert class_of(detection) == 'ball'
