"""tracking_node: it adds IDs to detections."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.messages import Time, get_message
from linkwright.nodes import NodeOptions
from linkwright.testing import SteppedGraph
from linkwright.vision.nodes.tracking_node import TrackingNode, YoloTrackingNode
from tests.vision.nodes.color_detector import detection, yolo_detection


def publish_detections(stepped, frame_index, *objects):
    header = get_message("std_msgs/msg/Header")(frame_id="camera")
    header.stamp = Time.from_nanoseconds(round(frame_index * 1e9 / 30))
    array = get_message("vision_msgs/msg/Detection2DArray")(header=header)
    array.detections = [detection(header, x - 20, 80, x + 20, 120, name, score) for x, name, score in objects]
    stepped.publish("/yolo/detections", array)
    stepped.settle()


def test_tracked_objects_have_ids_and_keep_detection_fields():
    with SteppedGraph() as stepped:
        TrackingNode(stepped.graph, NodeOptions(namespace="/yolo"))
        tracked = stepped.record("/yolo/tracking")
        stepped.settle()
        for number in range(10):
            publish_detections(
                stepped, number, (100 + number, "ball", 0.9), (300 - number, "crate", 0.8), (200, "ball", 0.15)
            )
        assert [[detection.id for detection in message.detections] for message in tracked] == [[]] + [["1", "2"]] * 9
        last = tracked.last.detections[1]
        assert last.results[0].hypothesis.class_id == "crate"
        assert last.bbox.center.position.x == pytest.approx(291)
        assert tracked.last.header.frame_id == "camera"
        publish_detections(stepped, 11)
        assert tracked.last.detections == []


def test_parameters_match_bytetrack():
    with SteppedGraph() as stepped:
        options = NodeOptions(parameters={"min_hits": 1, "track_high_thresh": 0.5, "new_track_thresh": 0.95})
        TrackingNode(stepped.graph, options)
        tracked = stepped.record("/tracking")
        stepped.settle()
        array = get_message("vision_msgs/msg/Detection2DArray")()
        array.detections = [detection(array.header, 0, 0, 9, 9, "ball", score) for score in (0.96, 0.9)]
        stepped.publish("/detections", array)
        stepped.settle()
        assert [detection.id for detection in tracked.last.detections] == ["1"]


@pytest.mark.parametrize(
    "invalid_parameters", [{"match_thresh": 1.5}, {"track_buffer": 0}, {"track_low_thresh": "low"}]
)
def test_invalid_parameters_are_rejected(invalid_parameters):
    with SteppedGraph() as stepped, pytest.raises(LinkwrightError):
        TrackingNode(stepped.graph, NodeOptions(parameters=invalid_parameters))


def test_yolo_ros_messages_and_parameters_are_supported():
    with SteppedGraph() as stepped:
        parameters = {"tracker": "bytetrack.yaml", "image_reliability": 1, "min_hits": 1}
        YoloTrackingNode(stepped.graph, NodeOptions(namespace="/yolo", parameters=parameters))
        tracked = stepped.record("/yolo/tracking")
        stepped.settle()
        array = get_message("yolo_msgs/msg/DetectionArray")()
        array.header.frame_id = "camera"
        array.detections = [yolo_detection(10, 20, 40, 60, "ball", 0.9), yolo_detection(80, 20, 90, 60, "cone", 0.8)]
        stepped.publish("/yolo/detections", array)
        stepped.settle()
        assert [(detection.id, detection.class_name, detection.class_id) for detection in tracked.last.detections] == [
            ("1", "ball", 4),
            ("2", "cone", 4),
        ]
        assert tracked.last.detections[0].bbox.size.y == 40
        assert tracked.last.header.frame_id == "camera"
        assert [detection.id for detection in array.detections] == ["", ""], "the received message must not be changed"
        assert not any("no parameter" in record.text or "not read" in record.text for record in stepped.log)
