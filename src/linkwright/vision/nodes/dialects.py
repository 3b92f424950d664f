"""Names of nodes, parameters and topics of the detectors of other packages.

Sources: yolo_ros 4 (mgonzs13): node, parameters, defaults, topics, yolo_msgs; openrobotics_darknet_ros; yolov5_ros;
yolov5_ros2 (fishros).
"""

from __future__ import annotations

from dataclasses import dataclass

VISION, YOLO = "vision_msgs/msg/Detection2DArray", "yolo_msgs/msg/DetectionArray"


@dataclass(frozen=True, slots=True)
class Dialect:
    """The names of topics, and of parameters; empty for parameters that a node lacks.

    Attributes:
        model: the parameter with the ONNX file or the detector.
        labels: the parameter with the file of labels.
        threshold: the parameter with the least score.
        least_score: its default.
        iou: the parameter with the largest overlap of boxes of a class.
        overlap: its default.
        most: the parameter with the largest number of detections in an image.
        largest_number: its default.
        image_topic: the parameter with the topic of images.
        images: its default.
        output_topic: the parameter with the topic of detections.
        detections: its default.
        debug_images: the topics of images with boxes.
        message: the type of detections.
    """

    model: str = "model"
    labels: str = "labels"
    threshold: str = "threshold"
    least_score: float = 0.5
    iou: str = "iou"
    overlap: float = 0.5
    most: str = "max_det"
    largest_number: int = 300
    image_topic: str = "input_image_topic"
    images: str = "image_raw"
    output_topic: str = ""
    detections: str = "detections"
    debug_images: tuple[str, ...] = ("debug_image",)
    message: str = VISION


OURS = Dialect()
YOLO_ROS = Dialect(debug_images=("debug_image", "dbg_image"), message=YOLO)
YOLOV5_ROS = Dialect(
    model="weights",
    threshold="confidence_threshold",
    least_score=0.25,
    iou="iou_threshold",
    overlap=0.45,
    most="maximum_detections",
    largest_number=1000,
    output_topic="output_topic",
    debug_images=("image_out",),
)
YOLOV5_ROS2 = Dialect(
    least_score=0.25,
    overlap=0.45,
    image_topic="image_topic",
    images="/image_raw",
    detections="yolo_result",
    debug_images=("result_img",),
)
DARKNET_ROS = Dialect(
    model="network.weights",
    labels="network.class_names",
    threshold="detection.threshold",
    least_score=0.25,
    iou="detection.nms_threshold",
    overlap=0.45,
    image_topic="",
    images="~/images",
    detections="~/detections",
    debug_images=("~/debug_image",),
)
