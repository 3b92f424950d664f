"""RViz configurations that show a topic which a changed source no longer publishes."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

SOURCE = 'self.pose = self.create_publisher(Pose, "pose", 10)\n'
DISPLAY = "Displays:\n  - Class: rviz_default_plugins/Pose\n    Topic:\n      Depth: 5\n      Value: /pose\n"
EXPECTED = "shows the topic 'pose', which 'arm/node.py' no longer publishes"


@pytest.mark.parametrize(
    ("others", "is_lost"),
    [
        ({}, True),
        ({"arm/other.py": SOURCE}, False),
        ({"arm/launch/arm.launch.py": 'remappings=[("out", "/pose")]\n'}, False),
        ({"arm/config/arm.yaml": "pose_topic: /pose\n"}, False),
        ({"arm/config/arm.yaml": "pose_topic: /arm/pose\n"}, True),
    ],
)
def test_configuration_of_rviz_that_shows_a_lost_topic_is_breaking(repository, compare, others, is_lost):
    repository.commit({"arm/node.py": SOURCE, "arm/rviz/arm.rviz": DISPLAY, **others})
    repository.write({"arm/node.py": SOURCE.replace('"pose"', '"state"')})
    result = compare(repository)
    assert (EXPECTED in breaking(result)) == is_lost
    if is_lost:
        assert sentences(subject(result, "arm/rviz/arm.rviz")) == [EXPECTED]
