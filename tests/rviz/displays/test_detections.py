"""Displays of vision_msgs: boxes in the scene, and over images."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.graph import SetParametersResult
from linkwright.images.color_words import RGB_BY_COLOR_WORD
from linkwright.messages import Time, get_message
from linkwright.rviz import RvizConfig
from linkwright.rviz.displays.class_colors import choose_class_color, read_class_colors
from tests.viewer.contents import unpack_contents
from tests.viewer.scene import open_world
from tests.waiting import eventually

HYPOTHESIS = get_message("vision_msgs/msg/ObjectHypothesisWithPose")
PLUGINS = "vision_msgs_rviz_plugins"


def make_config(cls: str, extra: str = "") -> RvizConfig:
    return RvizConfig.parse(
        "Visualization Manager:\n  Global Options: {Fixed Frame: base}\n  Displays:\n"
        f"    - {{Class: {cls}, Enabled: true, Topic: {{Value: /topic}}{extra}}}\n"
    )


def publish_detections(world, topic: str, *messages) -> None:
    publisher = world.graph.create_node("talker").create_publisher(type(messages[0]), topic, 10)
    for message in messages:
        publisher.publish(message)


def make_box(x: float = 1.0):
    message = get_message("vision_msgs/msg/BoundingBox3D")()
    message.center.position.x = x
    message.size.x, message.size.y, message.size.z = 0.5, 1.0, 2.0
    return message


def make_result(name: str, score: float):
    message = HYPOTHESIS()
    message.hypothesis.class_id, message.hypothesis.score = name, score
    return message


def make_detection(*results, frame: str = "tip"):
    message = get_message("vision_msgs/msg/Detection3D")(bbox=make_box(), results=list(results))
    message.header.frame_id = frame
    return message


def make_array(*detections):
    message = get_message("vision_msgs/msg/Detection3DArray")(detections=list(detections))
    message.header.frame_id = "tip"
    return message


async def displayed_fields(cls: str, message, extra: str = "") -> dict:
    async with open_world(make_config(f"{PLUGINS}/{cls}", extra)) as world:
        world.move_arm()
        publish_detections(world, "/topic", message)
        await world.settle()
        (content,) = unpack_contents(world.display(cls))
        return content.fields | {"frame": content.frame}


@pytest.mark.parametrize(("cls", "wrap"), [("Detection3DArray", make_array), ("Detection3D", lambda message: message)])
async def test_detections_are_boxes_with_likeliest_class_and_score(cls, wrap):
    fields = await displayed_fields(cls, wrap(make_detection(make_result("ball", 0.25), make_result("person", 0.75))))
    assert fields["poses"].tolist() == [1, 0, 0, 0, 0, 0, 1]
    assert fields["sizes"].tolist() == [0.5, 1, 2]
    assert fields["colors"].tolist() == [0, 0, 255]
    assert (fields["names"], fields["scores"].tolist(), fields["frame"]) == (["person"], [0.75], "tip")


async def test_detection_without_results_is_box_without_class():
    fields = await displayed_fields("Detection3DArray", make_array(make_detection()))
    assert (fields["names"], fields["scores"].tolist(), fields["colors"].tolist()) == ([""], [-1], [255, 22, 80])


async def test_boxes_without_header_are_in_fixed_frame():
    fields = await displayed_fields("BoundingBox3D", make_box(3.0))
    assert (fields["frame"], fields["poses"].tolist()) == ("base", [3, 0, 0, 0, 0, 0, 1])


async def test_bounding_box_array_has_no_classes():
    message = get_message("vision_msgs/msg/BoundingBox3DArray")(boxes=[make_box(1.0), make_box(2.0)])
    message.header.frame_id = "tip"
    fields = await displayed_fields("BoundingBox3DArray", message)
    assert (fields["sizes"].shape, fields["names"]) == ((6,), ["", ""])


async def test_nonfinite_boxes_are_rejected():
    async with open_world(make_config(f"{PLUGINS}/BoundingBox3D")) as world:
        publish_detections(world, "/topic", make_box(float("nan")))
        await world.settle()
        assert unpack_contents(world.display("BoundingBox3D")) == []
        assert "invalid floating point" in " ".join(text for _, text in world.status("BoundingBox3D").values())


async def test_class_colors_are_read_from_file(tmp_path):
    path = tmp_path / "colors.yaml"
    path.write_text("Ball: {r: 1, g: 2, b: 3}\n")
    fields = await displayed_fields(
        "Detection3DArray", make_array(make_detection(make_result("ball", 1.0))), f", ConfigPath: {path}"
    )
    assert fields["colors"].tolist() == [1, 2, 3]


@pytest.mark.parametrize("text", ["- 1", "ball: red", "ball: {r: 1, g: 2}", "ball: {r: 256, g: 0, b: 0}", "{"])
async def test_file_without_colors_is_reported(tmp_path, text):
    path = tmp_path / "colors.yaml"
    path.write_text(text)
    async with open_world(make_config(f"{PLUGINS}/Detection3DArray", f", ConfigPath: {path}")) as world:
        level, status = world.status("Detection3DArray")["ConfigPath"]
        assert level == "error"
        assert str(path) in status
    with pytest.raises(ValueError, match=r"cannot read"):
        read_class_colors(str(tmp_path / "none.yaml"))


def test_class_color_is_stable():
    assert choose_class_color("ball", {}) == choose_class_color("ball", {})
    assert choose_class_color("Person", {}) == (0, 0, 255)
    assert len({choose_class_color(name, {}) for name in ("ball", "crate", "cone", "can")}) > 2


def test_class_named_after_color_has_it_unless_overridden():
    assert choose_class_color("red", {}) == choose_class_color("Red_cube", {}) == RGB_BY_COLOR_WORD["red"]
    assert choose_class_color("ball-gray", {}) == RGB_BY_COLOR_WORD["grey"]
    assert choose_class_color("infrared lamp", {}) != RGB_BY_COLOR_WORD["red"]
    assert choose_class_color("red", {"red": (1, 2, 3)}) == (1, 2, 3)


# --- over images -------------------------------------------------------------------------------------------------


def make_image(seconds: int):
    message = get_message("sensor_msgs/msg/Image")(height=1, width=1, encoding="mono8", step=1, data=[seconds])
    message.header.stamp = Time(sec=seconds, nanosec=0)
    return message


def detection_message(seconds: int, *results):
    marked = get_message("vision_msgs/msg/Detection2D")(results=list(results))
    marked.bbox.center.position.x, marked.bbox.center.position.y = 10.0, 20.0
    marked.bbox.size_x, marked.bbox.size_y = 4.0, 6.0
    message = get_message("vision_msgs/msg/Detection2DArray")(detections=[marked])
    message.header.stamp = Time(sec=seconds, nanosec=0)
    return message


async def test_image_is_shown_with_matching_detections(monkeypatch):
    monkeypatch.setattr("linkwright.rviz.displays.detection_image._DETECTION_TIMEOUT_S", 1e9)
    async with open_world(make_config("linkwright/Detections", ", Detections Topic: {Value: /found}")) as world:
        node = world.graph.create_node("camera")
        camera = node.create_publisher("sensor_msgs/msg/Image", "/topic", 10)
        detector = node.create_publisher("vision_msgs/msg/Detection2DArray", "/found", 10)

        async def settle_and_read() -> list:
            await world.settle()
            facts = {content.fields["kind"]: content for content in unpack_contents(world.display("Detections"))}
            shown, boxes = facts.get("image_frame"), facts.get("image_boxes")
            return [shown and shown.stamp, boxes and boxes.stamp, boxes and boxes.fields["of_image"]]

        camera.publish(make_image(1))
        assert await settle_and_read() == [1.0, None, None]
        # Images without an expected detection are not stored, so these boxes have no image.
        detector.publish(detection_message(1, make_result("ball", 0.5)))
        assert await settle_and_read() == [1.0, 1.0, False]
        camera.publish(make_image(2))
        camera.publish(make_image(3))
        assert await settle_and_read() == [1.0, 1.0, False]
        detector.publish(detection_message(2, make_result("ball", 0.5)))
        assert await settle_and_read() == [2.0, 2.0, True]
        (boxes,) = [
            content
            for content in unpack_contents(world.display("Detections"))
            if content.fields["kind"] == "image_boxes"
        ]
        assert boxes.fields["boxes"].tolist() == [10, 20, 4, 6, 0]
        assert (boxes.fields["names"], boxes.fields["scores"].tolist()) == (["ball"], [0.5])
        assert np.array_equal(boxes.fields["colors"], choose_class_color("ball", {}))


async def test_images_are_shown_without_waiting_if_detector_is_silent(monkeypatch):
    monkeypatch.setattr("linkwright.rviz.displays.detection_image._DETECTION_TIMEOUT_S", -1.0)
    async with open_world(make_config("linkwright/Detections", ", Detections Topic: {Value: /found}")) as world:
        publish_detections(world, "/found", detection_message(1, make_result("ball", 0.5)))
        publish_detections(world, "/topic", make_image(5))
        await world.settle()
        assert [content.fields["kind"] for content in unpack_contents(world.display("Detections"))] == ["image_frame"]


# --- the threshold -----------------------------------------------------------------------------------------------


async def threshold_status(world) -> tuple[str, str]:
    """Wait for the display's status of its threshold, and return it."""
    await eventually(lambda: "Threshold" in world.status("Detections"))
    return world.status("Detections")["Threshold"]


def start_detector_node(world, **parameters):
    node = world.graph.create_node("yolo_node", namespace="/yolo")
    for name, value in parameters.items():
        node.declare_parameter(name.replace("__", "."), value)
    node.create_publisher("vision_msgs/msg/Detection2DArray", "/found", 10)
    return node


@pytest.mark.parametrize("name", ["threshold", "confidence_threshold", "detection__threshold"])
async def test_threshold_sets_parameter_of_detector_node(name):
    async with open_world(make_config("linkwright/Detections", ", Detections Topic: {Value: /found}")) as world:
        node = start_detector_node(world, **{name: 0.5})
        world.display("Detections").set_property(("Threshold",), 0.7)
        shown = name.replace("__", ".")
        assert await threshold_status(world) == ("ok", f"Parameter '{shown}' of /yolo/yolo_node")
        assert node.get_parameter(shown).value == pytest.approx(0.7)


@pytest.mark.parametrize(
    ("parameters", "level", "words"),
    [({}, "ok", "has no parameter 'threshold'"), ({"threshold": "much"}, "warn", "rejects 'threshold'")],
)
async def test_threshold_filters_in_page_without_detector_parameter(parameters, level, words):
    async with open_world(make_config("linkwright/Detections", ", Detections Topic: {Value: /found}")) as world:
        start_detector_node(world, **parameters)
        world.display("Detections").set_property(("Threshold",), 0.7)
        response, text = await threshold_status(world)
        assert (response, words in text) == (level, True)


async def test_rejected_threshold_and_missing_node_are_reported():
    async with open_world(make_config("linkwright/Detections", ", Detections Topic: {Value: /found}")) as world:
        display = world.display("Detections")
        display.set_property(("Threshold",), 0.7)
        assert "0 nodes publish /found" in (await threshold_status(world))[1]
        node = start_detector_node(world, threshold=0.5)
        node.add_on_set_parameters_callback(lambda _: SetParametersResult(False, "never"))
        display.set_property(("Threshold",), 0.6)
        await eventually(lambda: "rejects 'threshold': never" in world.status("Detections")["Threshold"][1])
        assert node.get_parameter("threshold").value == 0.5


async def test_last_of_many_thresholds_is_set():
    async with open_world(make_config("linkwright/Detections", ", Detections Topic: {Value: /found}")) as world:
        node = start_detector_node(world, threshold=0.5)
        values: list[float] = []
        node.add_post_set_parameters_callback(lambda given: values.append(given[0].value))
        for value in (0.1, 0.2, 0.3, 0.9):
            world.display("Detections").set_property(("Threshold",), value)
        assert (await threshold_status(world))[0] == "ok"
        assert values[-1] == pytest.approx(0.9)
        assert len(values) < 4
