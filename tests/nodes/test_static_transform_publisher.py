"""`static_transform_publisher`: both forms of its arguments, and its transform."""

import re
from math import pi, sqrt

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import Graph
from linkwright.nodes import NodeOptions
from linkwright.nodes.static_transform_publisher import StaticTransformPublisher, parse_arguments

SQRT_HALF = sqrt(0.5)


@pytest.mark.parametrize(
    ("arguments", "translation", "rotation", "is_old_style"),
    [
        ("--frame-id map --child-frame-id odom", (0, 0, 0), (0, 0, 0, 1), False),
        (
            f"--x 1 --y -2 --yaw {pi / 2} --frame-id map --child-frame-id odom",
            (1, -2, 0),
            (0, 0, SQRT_HALF, SQRT_HALF),
            False,
        ),
        (f"--roll {pi} --frame-id map --child-frame-id odom", (0, 0, 0), (1, 0, 0, 0), False),
        ("--qx 1 --qw 1 --frame-id map --child-frame-id odom", (0, 0, 0), (SQRT_HALF, 0, 0, SQRT_HALF), False),
        (f"1 2 3 {pi / 2} 0 0 map odom", (1, 2, 3), (0, 0, SQRT_HALF, SQRT_HALF), True),
        (f"1 2 3 0 {pi / 2} 0 map odom", (1, 2, 3), (0, SQRT_HALF, 0, SQRT_HALF), True),
        ("1 2 3 0 0 1 0 map odom", (1, 2, 3), (0, 0, 1, 0), True),
    ],
)  # fmt: skip
def test_new_and_old_style_arguments_are_parsed(arguments, translation, rotation, is_old_style):
    parsed = parse_arguments(arguments.split())
    assert parsed.translation == translation
    assert parsed.rotation == pytest.approx(rotation)
    assert (parsed.frame_id, parsed.child_frame_id, parsed.is_old_style) == ("map", "odom", is_old_style)


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        ("", "Frame id must not be empty"),
        ("--frame-id map", "Child frame id must not be empty"),
        ("--frame-id", "Not enough arguments for --frame-id"),
        ("--x one --frame-id a --child-frame-id b", "Failed to parse --x argument as float"),
        ("1 2 3", "Extra unparsed arguments on command-line"),
        ("--frame a", "Extra unparsed arguments on command-line"),
        (
            "--x 1 1 2 3 0 0 0 a b",
            "Cannot specify both new-style (flags) and old-style (arguments)",
        ),
        (
            "--yaw 1 --qw 1 --frame-id a --child-frame-id b",
            "Cannot specify both quaternion and Euler rotations",
        ),
        ("--qw 0 --frame-id a --child-frame-id b", "The quaternion must not be zero"),
    ],
)
def test_invalid_arguments_are_rejected_with_usage(arguments, reason):
    with pytest.raises(LinkwrightError) as caught:
        parse_arguments(arguments.split())
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.code == "NODE301"
    assert diagnostic.message == f"error parsing command line arguments: {reason}"
    assert diagnostic.hint.startswith("usage: static_transform_publisher [--x X]")


async def test_static_transform_is_latched(harness, logged):
    options = NodeOptions(arguments=["1", "2", "3", "0", "0", "0", "map", "base"])
    first = StaticTransformPublisher(harness.graph, options)
    second = StaticTransformPublisher(
        harness.graph, NodeOptions(arguments=["--frame-id", "base", "--child-frame-id", "camera", "--z", "4"])
    )
    await harness.graph.settle()
    np.testing.assert_allclose(harness.buffer.lookup("map", "camera"), [1, 2, 7, 0, 0, 0, 1])
    names = [publisher.node.get_name() for publisher in (first, second)]
    assert all(re.fullmatch(r"static_transform_publisher_[A-Za-z0-9]{16}", name) for name in names)
    assert names[0] != names[1]
    assert logged("WARN") == ["Old-style arguments are deprecated; see --help for new-style arguments"]
    assert logged("INFO")[0] == (
        "Spinning until stopped - publishing transform\ntranslation: ('1.000000', '2.000000', '3.000000')\n"
        "rotation: ('0.000000', '0.000000', '0.000000', '1.000000')\nfrom 'map' to 'base'"
    )
    assert harness.tf_static[0].batch.stamp_ns == harness.clock.now_ns()
    first.close()
    assert harness.graph.count_publishers("/tf_static") == 1


async def test_invalid_arguments_end_node(harness: object, graph: Graph, logged):
    with pytest.raises(LinkwrightError):
        StaticTransformPublisher(graph, NodeOptions(name="camera_tf", arguments=["1"]))
    assert logged("FATAL") == ["error parsing command line arguments: Extra unparsed arguments on command-line"]
    assert graph.node_names() == ["/test_node"]


async def test_help_is_printed(harness):
    printed = []
    running = StaticTransformPublisher(harness.graph, NodeOptions(arguments=["--help"], output=printed.append))
    assert running.finished.result() == 0
    assert printed[0].startswith("A command line utility for manually sending a static transform.")
    assert harness.graph.count_publishers("/tf_static") == 0
