"""Changes of the topics that the programs of topic_tools forward, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import subject

GONE = "programs that use the name '{}' do not find it"
NOT_FORWARDED = "the messages of '{}' are no longer forwarded"


@pytest.mark.parametrize(
    ("program", "old", "new", "reason"),
    [
        ("relay", "/a /b", "/c /b", NOT_FORWARDED.format("/a")),
        ("relay", "/a /b", "/a /c", GONE.format("/b")),
        ("relay", "/a", "/c", GONE.format("/a_relay")),
        ("relay", "/a /b", "a b", None),
        ("throttle", "messages /a 1.0 /b", "messages /a 2.0 /b", None),
        ("throttle", "messages /a 1.0", "messages /a 1.0 /b", GONE.format("/a_throttle")),
        ("throttle", "bytes /a 100 1 /b", "bytes /a 100 1 /c", GONE.format("/b")),
        ("drop", "/a 1 2 /b", "/a 1 2 /c", GONE.format("/b")),
        ("drop", "/a 1 2", "/a 1 3", None),
        ("mux", "out /a /b", "out /a", NOT_FORWARDED.format("/b")),
        ("mux", "out /a", "out /a /b", None),
        ("transform", "/a/x /b std_msgs/Float64 m.x", "/a/x /c std_msgs/Float64 m.x", GONE.format("/b")),
    ],
)
def test_topics_in_the_arguments_of_topic_tools(repository, compare, program, old, new, reason):
    text = f'<launch><node pkg="topic_tools" type="{program}" name="tool" args="ARGS"/></launch>'
    repository.commit({"arm/launch/arm.launch": text.replace("ARGS", old)})
    repository.write({"arm/launch/arm.launch": text.replace("ARGS", new)})
    (change,) = subject(compare(repository), "arm/launch/arm.launch").changes
    assert (None if change.reason is None else str(change.reason)) == reason
