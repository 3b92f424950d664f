"""The tree of a message's fields, and its limits."""

from __future__ import annotations

from linkwright.messages import get_message
from linkwright.page.protocol.monitor import MessageField
from linkwright.panels.monitor.topics import make_message_tree


def row_at_path(rows: list[MessageField], *path: str) -> MessageField:
    row_of_path = next(row for row in rows if row.name == path[0])
    return row_at_path(row_of_path.children, *path[1:]) if path[1:] else row_of_path


def test_message_tree_has_types_and_values():
    message = get_message("sensor_msgs/msg/JointState")(name=["a"], position=[0.5])
    message.header.frame_id = "base"
    tree = make_message_tree(message)
    assert [field.name for field in tree] == ["header", "name", "position", "velocity", "effort"]
    assert row_at_path(tree, "header").kind == "std_msgs/Header"
    assert row_at_path(tree, "header", "frame_id").value == "base"
    assert (row_at_path(tree, "position").kind, row_at_path(tree, "position").value) == ("sequence<double>", "[0.5]")
    assert row_at_path(tree, "position", "[0]") == MessageField("[0]", "double", "0.5")


def test_long_arrays_are_truncated():
    image = get_message("sensor_msgs/msg/Image")(data=bytes(range(200)))
    data = row_at_path(make_message_tree(image), "data")
    assert data.value == "[0, 1, 2, 3, 4, 5, 6, 7, ...]"
    assert (len(data.children), data.omitted) == (64, 136)


def test_long_strings_are_truncated():
    (data,) = make_message_tree(get_message("std_msgs/msg/String")(data="x" * 5000))
    assert len(data.value) < 500
    assert data.value.endswith("...")


def test_tree_of_large_message_is_limited():
    marker = get_message("visualization_msgs/msg/Marker")
    point = get_message("geometry_msgs/msg/Point")
    message = get_message("visualization_msgs/msg/MarkerArray")(
        markers=[marker(points=[point()] * 60) for _ in range(60)]
    )

    def count(rows: list[MessageField]) -> int:
        return sum(1 + count(row.children) for row in rows)

    assert count(make_message_tree(message)) <= 1600


def test_all_value_types_are_formatted():
    status = get_message("diagnostic_msgs/msg/DiagnosticStatus")(level=b"\x02")
    assert row_at_path(make_message_tree(status), "level").value == "0x02"
    assert make_message_tree(get_message("std_msgs/msg/Bool")(data=True))[0].value == "true"
    assert make_message_tree(get_message("std_msgs/msg/Float32")(data=0.1))[0].value == "0.1"
