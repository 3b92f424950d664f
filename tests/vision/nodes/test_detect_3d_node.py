"""detect_3d_node: boxes in images become boxes in meters."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.graph import STATIC_TF_PUBLISHER_QOS
from linkwright.messages import TFMessage, Time, TransformBatch, get_message
from linkwright.nodes import NodeOptions
from linkwright.testing import SteppedGraph
from linkwright.vision.nodes.detect_3d_node import Detect3DNode, YoloDetect3DNode
from tests.vision.nodes.color_detector import detection, yolo_detection

NOW = Time.from_nanoseconds(10**9)


@pytest.fixture
def test():
    with SteppedGraph() as graph:
        yield graph


def start_node(test, kind=Detect3DNode, **parameters):
    node = kind(test.graph, NodeOptions(parameters=parameters))
    recording = test.record("/detections_3d")
    markers = test.record("/markers")
    test.settle()
    # The camera looks forward, half a meter above the ground.
    batch = TransformBatch(("base_link",), ("camera",), 0, np.array([[0.1, 0.0, 0.5, -0.5, 0.5, -0.5, 0.5]]))
    test.publish("/tf_static", TFMessage(batch=batch), STATIC_TF_PUBLISHER_QOS)
    test.settle()
    return node, recording, markers


def make_header(frame="camera", stamp=NOW):
    return get_message("std_msgs/msg/Header")(frame_id=frame, stamp=stamp)


def publish_camera(test, topic, width=640, height=480, **fields):
    info = get_message("sensor_msgs/msg/CameraInfo")(header=make_header(), width=width, height=height, **fields)
    info.k = [500.0, 0.0, width / 2 - 0.5, 0.0, 500.0, height / 2 - 0.5, 0.0, 0.0, 1.0]
    test.publish(topic, info)
    test.settle()


def publish_depth(test, values, encoding="32FC1", **fields):
    rows = np.ascontiguousarray(values, "<f4" if encoding == "32FC1" else "<u2")
    image = get_message("sensor_msgs/msg/Image")(header=make_header(**fields), encoding=encoding)
    image.height, image.width = rows.shape
    image.step, image.data = rows.strides[0], np.frombuffer(rows.tobytes(), np.uint8)
    test.publish("/depth_image", image)
    test.settle()


def publish_boxes(test, *detections, frame="camera"):
    array = get_message("vision_msgs/msg/Detection2DArray")(header=make_header(frame))
    array.detections = [detection(array.header, *box, "ball") for box in detections]
    for number, array_detection in enumerate(array.detections):
        array_detection.id = str(number + 7)
    test.publish("/detections", array)
    test.settle()


WALL = np.full((480, 640), 5.0)
WALL[220:260, 300:340] = 2.0
BOX = (300.0, 220.0, 340.0, 260.0)


def logged_warnings(test):
    return [record.text for record in test.log if record.level.name == "WARN"]


@pytest.mark.parametrize(
    ("encoding", "factor", "divisor"), [("32FC1", 1.0, 1000), ("16UC1", 1000.0, 1000), ("16UC1", 5000.0, 5000)]
)
def test_depth_image_gives_positions_in_target_frame(test, encoding, factor, divisor):
    _, recording, markers = start_node(test, depth_image_units_divisor=divisor)
    publish_camera(test, "/depth_info")
    publish_depth(test, WALL * factor, encoding)
    publish_boxes(test, BOX)
    (detection,) = recording.last.detections
    position, size = detection.bbox.center.position, detection.bbox.size
    assert (position.x, position.y, position.z) == pytest.approx((2.1, 0.0, 0.5), abs=0.02)
    assert (size.y, size.z) == pytest.approx((0.16, 0.16), abs=0.01)
    assert recording.last.header.frame_id == detection.header.frame_id == "base_link"
    assert detection.id == "7"
    assert detection.results[0].hypothesis.class_id == "ball"
    assert detection.results[0].pose.pose.position.x == position.x
    turn = detection.bbox.center.orientation
    assert abs(turn.w) == pytest.approx(1.0), "the box's x axis is along the view, and its z axis is up"
    _, box, label = markers.last.markers
    assert (box.type, box.scale.y) == (box.CUBE, size.y)
    assert (label.type, label.text) == (label.TEXT_VIEW_FACING, "ball 7 2.0 m")


def test_depth_image_may_have_half_size(test):
    _, recording, _ = start_node(test)
    publish_camera(test, "/camera_info")
    publish_camera(test, "/depth_info", 320, 240)
    publish_depth(test, WALL[::2, ::2])
    publish_boxes(test, BOX)
    assert recording.last.detections[0].bbox.center.position.x == pytest.approx(2.1, abs=0.02)


def test_objects_are_placed_on_ground_without_depth(test):
    _, recording, _ = start_node(test, ground_frame="base_link")
    publish_camera(test, "/camera_info")
    publish_boxes(test, (295.0, 320.0, 345.0, 365.0), (300.0, 100.0, 340.0, 140.0))
    (detection,) = recording.last.detections
    assert detection.id == "7", "the other object is above the horizon"
    assert detection.bbox.center.position.x == pytest.approx(2.1, abs=0.02)
    assert detection.bbox.center.position.z == pytest.approx(0.09, abs=0.02)
    assert logged_warnings(test) == []


def test_ground_is_used_for_box_without_depths(test):
    _, recording, _ = start_node(test, ground_frame="base_link")
    publish_camera(test, "/camera_info")
    publish_depth(test, np.full((480, 640), np.nan))
    publish_boxes(test, (295.0, 320.0, 345.0, 365.0))
    assert recording.last.detections[0].bbox.center.position.x == pytest.approx(2.1, abs=0.02)


def test_empty_detections_are_published_and_delete_markers(test):
    _, recording, markers = start_node(test)
    publish_boxes(test)
    assert recording.last.detections == []
    assert [marker.action for marker in markers.last.markers] == [markers.last.markers[0].DELETEALL]


def test_missing_inputs_are_reported(test):
    _, recording, _ = start_node(test)
    publish_boxes(test, BOX)
    assert logged_warnings(test) == ["the positions of detections are unknown: no camera_info has arrived"]
    publish_camera(test, "/camera_info")
    test.advance(6.0)
    publish_boxes(test, BOX)
    assert logged_warnings(test)[-1].endswith("no depth image has arrived with a stamp near that of the detections")
    publish_depth(test, WALL, frame="elsewhere")
    test.advance(6.0)
    publish_boxes(test, BOX)
    assert "must be registered" in logged_warnings(test)[-1]
    test.advance(6.0)
    publish_boxes(test, BOX, frame="nowhere")
    assert "nowhere" in logged_warnings(test)[-1]
    test.advance(6.0)
    publish_depth(test, WALL, frame="camera", stamp=Time.from_nanoseconds(5 * 10**9))
    publish_boxes(test, BOX)
    assert len(recording) == 5
    assert all(message.detections == [] for message in recording)


def test_unsupported_distortion_model_is_reported(test):
    start_node(test)
    publish_camera(test, "/camera_info", distortion_model="equidistant", d=[0.1, 0.0, 0.0, 0.0])
    assert "equidistant" in logged_warnings(test)[-1]


def test_yolo_ros_messages_and_parameters_are_supported(test):
    parameters = {"maximum_detection_threshold": 0.3, "depth_image_reliability": 2, "depth_info_reliability": 2}
    _, recording, markers = start_node(test, YoloDetect3DNode, **parameters)
    publish_camera(test, "/depth_info")
    publish_depth(test, WALL)
    array = get_message("yolo_msgs/msg/DetectionArray")(header=make_header())
    array.detections = [yolo_detection(*BOX, "ball", 0.9)]
    array.detections[0].id = "7"
    test.publish("/detections", array)
    test.settle()
    (detection,) = recording.last.detections
    position, size = detection.bbox3d.center.position, detection.bbox3d.size
    assert (position.x, position.y, position.z) == pytest.approx((2.1, 0.0, 0.5), abs=0.02)
    assert (size.y, size.z) == pytest.approx((0.16, 0.16), abs=0.01)
    assert recording.last.header.frame_id == detection.bbox3d.frame_id == "base_link"
    assert (detection.id, detection.class_name, detection.bbox.center.position.x) == ("7", "ball", 320.0)
    assert array.detections[0].bbox3d.frame_id == "", "the received message must not be changed"
    _, box, label = markers.last.markers
    assert (box.scale.y, label.text) == (size.y, "ball 7 2.0 m")
