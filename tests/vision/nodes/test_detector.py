"""The node that finds objects in images, under all of its names."""

from __future__ import annotations

import threading
from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.graph import LogLevel, Parameter, QoSProfile, ReliabilityPolicy
from linkwright.messages import Time, get_message, get_service
from linkwright.nodes import NodeOptions
from linkwright.testing.stepped import AsyncSteppedGraph
from linkwright.vision.detector import Detector
from linkwright.vision.nodes import detector
from linkwright.vision.nodes.detector import (
    DarknetRosNode,
    DetectorNode,
    YoloRosNode,
    Yolov5Ros2Node,
    Yolov5RosNode,
)
from tests.vision.detectors.networks import write_column_network
from tests.waiting import TIMEOUT_S, eventually, is_waiting, wait_until


@pytest.fixture
async def test():
    async with AsyncSteppedGraph() as graph:
        yield graph


@pytest.fixture
def start(test):
    running = []

    async def begin(kind=DetectorNode, remappings=(), namespace="/yolo", loads=True, **parameters):
        options = NodeOptions(namespace=namespace, parameters=parameters, remappings=list(remappings))
        running.append(kind(test.graph, options))
        if loads:
            await eventually(lambda: running[-1].loaded.done() or running[-1].finished.done())
        return running[-1]

    yield begin
    for node in running:
        node.close()


def make_scene(encoding="rgb8"):
    pixels = np.full((120, 160, 3), 150, np.uint8)
    pixels[40:80, 100:130] = (20, 60, 200)
    pixels[40:80, 20:60] = (200, 20, 30)
    return np.ascontiguousarray(pixels[:, :, ::-1]) if encoding == "bgr8" else pixels


def make_image(encoding="rgb8", seconds=7):
    pixels = make_scene(encoding)
    message = get_message("sensor_msgs/msg/Image")(height=120, width=160, encoding=encoding, step=480)
    message.header.stamp, message.header.frame_id = Time.from_nanoseconds(seconds * 10**9), "camera"
    message.data = pixels.reshape(-1)
    return message


def make_compressed_image():
    file = BytesIO()
    Image.fromarray(make_scene()).save(file, "PNG")
    message = get_message("sensor_msgs/msg/CompressedImage")(format="rgb8; png compressed rgb8", data=file.getvalue())
    message.header.frame_id = "camera"
    return message


async def detect_in_image(test, recording, topic, message):
    """Publish an image, and return the published detections."""
    before = len(recording)
    test.publish(topic, message)
    await test.settle()

    def has_new_message():
        return len(recording) > before

    await eventually(has_new_message)
    return recording.last


def detected_classes(message):
    return sorted(detection.results[0].hypothesis.class_id for detection in message.detections)


@pytest.mark.parametrize("encoding", ["rgb8", "bgr8"])
async def test_detections_have_class_center_size_and_image_header(test, start, encoding):
    await start(model="colors")
    recording = test.record("/yolo/detections")
    await test.settle()
    message = await detect_in_image(test, recording, "/yolo/image_raw", make_image(encoding))
    assert (message.header.stamp.sec, message.header.frame_id) == (7, "camera")
    assert detected_classes(message) == ["blue", "red"]
    (blue,) = [detection for detection in message.detections if detection.results[0].hypothesis.class_id == "blue"]
    assert (blue.bbox.center.position.x, blue.bbox.center.position.y) == (115.0, 60.0)
    assert (blue.bbox.size_x, blue.bbox.size_y, blue.bbox.center.theta) == (30.0, 40.0, 0.0)
    assert blue.results[0].hypothesis.score == pytest.approx(1.0)
    assert blue.header == message.header


async def test_compressed_images_are_detected(test, start):
    await start(model="colors", input_image_topic="/camera/image_raw/compressed")
    recording = test.record("/yolo/detections")
    await test.settle()
    message = await detect_in_image(test, recording, "/camera/image_raw/compressed", make_compressed_image())
    assert detected_classes(message) == ["blue", "red"]


async def test_onnx_network_is_used(test, start, tmp_path):
    names = {"names": "{0: 'ball', 1: 'box', 2: 'cat'}"}
    await start(model=str(write_column_network(tmp_path / "v8.onnx", metadata=names)), threshold=0.6, max_det=5)
    recording = test.record("/yolo/detections")
    await test.settle()
    message = await detect_in_image(test, recording, "/yolo/image_raw", make_image())
    assert len(message.detections) == 5
    assert set(detected_classes(message)) <= {"ball", "box", "cat"}


async def test_debug_image_is_published_if_subscribed(test, start):
    await start(model="colors")
    recording = test.record("/yolo/debug_image")
    await test.settle()
    message = await detect_in_image(test, recording, "/yolo/image_raw", make_image())
    assert (message.encoding, message.width, message.height, message.step) == ("rgb8", 160, 120, 480)
    assert message.header.frame_id == "camera"
    assert (np.frombuffer(bytes(message.data), np.uint8) != make_scene().reshape(-1)).any()


async def test_images_are_subscribed_only_while_outputs_are_subscribed(test, start):
    await start(model="colors")
    await test.settle()
    assert test.graph.count_subscribers("/yolo/image_raw") == 0
    test.record("/yolo/detections")
    await test.settle()
    assert test.graph.count_subscribers("/yolo/image_raw") == 1


async def test_limits_can_change_at_runtime(test, start):
    node = (await start(model="colors")).node
    recording = test.record("/yolo/detections")
    await test.settle()
    for name, value, expected in [
        ("classes", ["red"], ["red"]),
        ("classes", [""], ["blue", "red"]),
        ("max_det", 1, ["red"]),
    ]:
        (result,) = node.set_parameters([Parameter(name, value=value)])
        assert result.successful, result.reason
        assert detected_classes(await detect_in_image(test, recording, "/yolo/image_raw", make_image())) == expected


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("threshold", 1.5, ""),
        ("max_det", 0, "cannot be '0'"),
        ("classes", ["blu"], "did you mean 'blue'?"),
        ("model", "aruco", ""),
    ],
)
async def test_invalid_parameter_values_are_rejected(test, start, name, value, words):
    node = (await start(model="colors")).node
    (result,) = node.set_parameters([Parameter(name, value=value)])
    assert not result.successful
    assert words in result.reason


async def test_services_enable_and_set_classes(test, start):
    await start(model="colors")
    recording = test.record("/yolo/detections")
    await test.settle()
    switch, choose = get_service("std_srvs/srv/SetBool"), get_service("yolo_msgs/srv/SetClasses")
    assert (await test.call("/yolo/set_classes", choose.Request(classes=["red"]))).success
    assert detected_classes(await detect_in_image(test, recording, "/yolo/image_raw", make_image())) == ["red"]
    assert "did you mean 'red'?" in (await test.call("/yolo/set_classes", choose.Request(classes=["rd"]))).message
    assert (await test.call("/yolo/set_classes", choose.Request(classes=[]))).success
    assert (await test.call("/yolo/enable", switch.Request(data=False))).success
    before = len(recording)
    test.publish("/yolo/image_raw", make_image(seconds=8))
    await test.settle()
    assert (await test.call("/yolo/enable", switch.Request(data=True))).success
    message = await detect_in_image(test, recording, "/yolo/image_raw", make_image(seconds=9))
    assert (message.header.stamp.sec, len(recording) - before) == (9, 1)


async def test_max_rate_limits_images_per_second(test, start):
    await start(model="colors", max_rate=10.0)
    recording = test.record("/yolo/detections")
    await test.settle()
    await detect_in_image(test, recording, "/yolo/image_raw", make_image(seconds=1))
    await test.advance(0.05)
    test.publish("/yolo/image_raw", make_image(seconds=2))
    await test.settle()
    await test.advance(0.05)
    message = await detect_in_image(test, recording, "/yolo/image_raw", make_image(seconds=3))
    assert (message.header.stamp.sec, len(recording)) == (3, 2)


async def test_malformed_image_is_reported_and_next_one_is_processed(test, start):
    await start(model="colors")
    recording = test.record("/yolo/detections")
    await test.settle()
    broken = make_image()
    broken.encoding = "rainbow8"
    test.publish("/yolo/image_raw", broken)
    await test.settle()
    await eventually(lambda: any("rainbow8" in record.text for record in test.log))
    assert detected_classes(await detect_in_image(test, recording, "/yolo/image_raw", make_image())) == ["blue", "red"]


async def test_custom_colors_are_detected(test, start):
    await start(model="colors", colors={"sky": [95, 110, 50, 130, 255, 255]}, least_area=10.0)
    recording = test.record("/yolo/detections")
    await test.settle()
    assert detected_classes(await detect_in_image(test, recording, "/yolo/image_raw", make_image())) == ["sky"]


async def test_yolo_ros_messages_and_older_topic_are_supported(test, start):
    await start(YoloRosNode, model="colors", remappings=[("image_raw", "/camera/rgb/image_raw")])
    recording, debug_images = test.record("/yolo/detections"), test.record("/yolo/dbg_image")
    await test.settle()
    message = await detect_in_image(test, recording, "/camera/rgb/image_raw", make_image())
    (blue,) = [detection for detection in message.detections if detection.class_name == "blue"]
    assert (blue.class_id, blue.score) == (4, pytest.approx(1.0))
    assert (blue.bbox.center.position.x, blue.bbox.size.y) == (115.0, 40.0)
    await eventually(lambda: len(debug_images) == 1)


@pytest.mark.parametrize(
    ("kind", "parameters", "topic", "output"),
    [
        (
            Yolov5RosNode,
            {"weights": "colors", "confidence_threshold": 0.5, "input_image_topic": "/image", "output_topic": "/out"},
            "/image",
            "/out",
        ),
        (Yolov5Ros2Node, {"model": "colors", "image_topic": "/camera/image_raw"}, "/camera/image_raw", "/yolo_result"),
        (
            DarknetRosNode,
            {"network": {"weights": "colors"}, "detection": {"threshold": 0.5, "nms_threshold": 0.4}},
            "/detector_node/images",
            "/detector_node/detections",
        ),
    ],
)
async def test_topics_and_parameters_of_other_packages_are_supported(test, start, kind, parameters, topic, output):
    await start(kind, namespace="/", **parameters)
    recording = test.record(output)
    await test.settle()
    assert detected_classes(await detect_in_image(test, recording, topic, make_image())) == ["blue", "red"]
    assert not any("no parameter" in record.text or "not read" in record.text for record in test.log)


@pytest.mark.parametrize(
    ("parameters", "code"),
    [
        ({"model": "colors", "image_transport": "theora"}, "NODE433"),
        ({"model": "colors", "image_reliability": 9}, "NODE433"),
        ({"model": "colors", "max_det": 0}, "NODE433"),
        ({"model": "colors", "threshold": 2.0}, "GRAPH204"),
        ({"model": "colors", "max_rate": -5.0}, "GRAPH204"),
        ({"model": "things", "imgsz_height": -3, "imgsz_width": 320}, "GRAPH204"),
        ({"model": "things", "imgsz_width": 320}, "VISION109"),
    ],
)
async def test_invalid_start_parameters_are_rejected(test, start, parameters, code):
    with pytest.raises(LinkwrightError) as caught:
        await start(**parameters)
    assert [diagnostic.code for diagnostic in caught.value.diagnostics] == [code]


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"model": "gone.onnx"}, "there is neither a file nor a detector 'gone.onnx'"),
        ({"model": "yolov8n.pt"}, "'yolov8n.pt' is not an ONNX file"),
        ({"model": "aruco", "dictionary": "5X"}, "'dictionary' of the detector cannot be '5X'"),
        ({"model": "things", "device": "gpu"}, "'device' of the detector cannot be 'gpu'"),
        ({"model": "colors", "classes": ["blu"]}, "parameter 'classes' of 'yolo_node' cannot be 'blu'"),
    ],
)
async def test_unloadable_detector_ends_node_with_one_error_and_hint(test, start, parameters, words):
    running = await start(**parameters)
    assert running.finished.result() == 1
    logged = [record.text for record in test.log if record.level is LogLevel.FATAL]
    assert len(logged) == 2, "the log has the error and the hint"
    assert words in logged[0]


# --- missing images -----------------------------------------------------------------------------------------------


IMAGE, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"


@pytest.fixture
def logged_warnings(test):
    """Return the warnings."""
    return lambda: [record.text for record in test.log if record.level is LogLevel.WARN]


async def test_unpublished_topic_is_reported_once_with_image_topics(test, start, logged_warnings):
    await start(model="colors")
    test.record("/yolo/detections")
    test.record("/yolo/debug_image")
    test.node.create_publisher(get_message(IMAGE), "/camera/image_raw", 1)
    await test.advance(30.0)
    assert logged_warnings() == [
        "no images arrive: no node publishes '/yolo/image_raw'",
        "images are published on '/camera/image_raw': set the topic with the parameter 'input_image_topic'",
    ]


async def test_topic_type_mismatch_is_reported(test, start, logged_warnings):
    await start(DarknetRosNode, namespace="/", network={"weights": "colors"}, remappings=[("~/images", "/camera")])
    test.record("/detector_node/detections")
    test.node.create_publisher(get_message(COMPRESSED), "/camera", 1)
    test.node.create_publisher(get_message(IMAGE), "/kinect/image_raw", 1)
    await test.advance(11.0)
    assert logged_warnings()[-2:] == [
        f"no images arrive: the type of '/camera' is '{COMPRESSED}', not '{IMAGE}'",
        "images are published on '/kinect/image_raw': remap '/camera'",
    ]


async def test_incompatible_qos_is_reported(test, start, logged_warnings):
    await start(model="colors", image_reliability=1)
    test.record("/yolo/detections")
    best_effort = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
    test.node.create_publisher(get_message(IMAGE), "/yolo/image_raw", best_effort)
    await test.advance(11.0)
    assert logged_warnings()[-2:] == [
        (
            "no images arrive: the publisher of '/yolo/image_raw' offers best-effort reliability, but this "
            "node requests reliable"
        ),
        "set 'image_reliability' to 2",
    ]


async def test_stopped_camera_is_reported_and_later_each_time(test, start, logged_warnings):
    await start(model="colors")
    recording = test.record("/yolo/detections")
    await test.settle()
    stopped = "no image has arrived on '/yolo/image_raw' for {} s".format
    await detect_in_image(test, recording, "/yolo/image_raw", make_image())
    await test.advance(9.0)
    assert logged_warnings() == []
    await test.advance(3.0)
    assert logged_warnings() == [stopped(5)]
    await detect_in_image(test, recording, "/yolo/image_raw", make_image())
    await test.advance(5.0)
    assert [record.text for record in test.log][-1] == "images are arriving"
    await test.advance(7.0)
    assert logged_warnings() == [stopped(5)]
    await test.advance(5.0)
    assert logged_warnings() == [stopped(5), stopped(10)]


async def test_missing_images_are_not_reported_without_subscribers(test, start, logged_warnings):
    await start(model="colors")
    await test.advance(30.0)
    assert logged_warnings() == []


# --- loading of the detector ----------------------------------------------------------------------------------------


class SlowDetectorFactory:
    """A detector class whose loading the test delays."""

    def __init__(self, make):
        self._make, self.proceed, self.begun = make, threading.Event(), threading.Event()

    def __call__(self, model, options):
        self.begun.set()
        assert self.proceed.wait(TIMEOUT_S)
        return self._make(model, options)


@pytest.fixture
def slow_factory(monkeypatch):
    factory = SlowDetectorFactory(detector.make_detector)
    monkeypatch.setattr(detector, "make_detector", factory)
    yield factory
    factory.proceed.set()


async def test_node_answers_services_while_detector_loads(test, start, slow_factory):
    running = await start(model="colors", loads=False)
    recording = test.record("/yolo/detections")
    await eventually(slow_factory.begun.is_set)
    switch = get_service("std_srvs/srv/SetBool")
    assert (await test.call("/yolo/enable", switch.Request(data=False))).success
    assert (await test.call("/yolo/enable", switch.Request(data=True))).success
    (result,) = running.node.set_parameters([Parameter("threshold", value=0.2)])
    assert result.successful
    (result,) = running.node.set_parameters([Parameter("classes", value=["red"])])
    assert (result.successful, "cannot be set until the detector is loaded" in result.reason) == (False, True)
    assert test.graph.count_subscribers("/yolo/image_raw") == 0
    slow_factory.proceed.set()
    await eventually(running.loaded.done)
    await test.settle()
    assert detected_classes(await detect_in_image(test, recording, "/yolo/image_raw", make_image())) == ["blue", "red"]


async def test_classes_set_during_loading_apply_after_loading(test, start, slow_factory):
    await start(model="colors", loads=False)
    recording = test.record("/yolo/detections")
    await eventually(slow_factory.begun.is_set)
    choose = get_service("yolo_msgs/srv/SetClasses")
    client = test.node.create_client(choose, "/yolo/set_classes")
    responses = [client.call_async(choose.Request(classes=[name])) for name in ("rd", "red")]
    await test.settle()
    assert not any(response.done() for response in responses)
    slow_factory.proceed.set()
    await eventually(lambda: all(response.done() for response in responses))
    assert [response.result().success for response in responses] == [False, True]
    assert "did you mean 'red'?" in responses[0].result().message
    assert detected_classes(await detect_in_image(test, recording, "/yolo/image_raw", make_image())) == ["red"]


async def test_closing_node_waits_silently_for_loading_detector(test, start, monkeypatch):
    main, has_begun = threading.current_thread(), threading.Event()

    def load(model, options):
        has_begun.set()
        wait_until(lambda: is_waiting(main))
        raise LinkwrightError(Diagnostic("VISION102", phrase("gone")))

    monkeypatch.setattr(detector, "make_detector", load)
    running = await start(model="colors", loads=False)
    await eventually(has_begun.is_set)
    running.close()
    await test.settle()
    assert not running.finished.done()
    assert [record.text for record in test.log if record.level >= LogLevel.ERROR] == []


class FailingDetector(Detector):
    """A user's detector, which raises an unexpected error."""

    @property
    def names(self):
        return ("red",)

    def detect(self, image, limits):
        raise KeyError("odd")


async def test_exception_of_third_party_detector_is_reported(test, start, monkeypatch):
    monkeypatch.setattr(detector, "make_detector", lambda model, options: FailingDetector())
    await start(model="odd")
    test.record("/yolo/detections")
    await test.settle()
    test.publish("/yolo/image_raw", make_image())
    await eventually(lambda: any("the detector failed: KeyError: 'odd'" in record.text for record in test.log))
    monkeypatch.setattr(detector, "make_detector", lambda model, options: {}["odder"])
    running = await start(model="odder", namespace="/other")
    assert running.finished.result() == 1
    assert any("the detector failed: KeyError: 'odder'" in record.text for record in test.log)
