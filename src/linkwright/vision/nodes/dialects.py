"""The names of nodes, parameters and topics in other packages' detectors.

Sources: yolo_ros 4 (mgonzs13): node, parameters, defaults, topics, yolo_msgs; openrobotics_darknet_ros; yolov5_ros;
yolov5_ros2 (fishros).
"""

from __future__ import annotations

from dataclasses import dataclass

VISION, YOLO = "vision_msgs/msg/Detection2DArray", "yolo_msgs/msg/DetectionArray"


@dataclass(frozen=True, slots=True)
class Dialect:
    """The topic and parameter names of a detector node; empty for parameters that it lacks.

    Attributes:
        model: the parameter with the ONNX file or the name of the detector.
        labels: the parameter with the label file.
        threshold: the parameter with the minimum score.
        least_score: the default of `threshold`.
        iou: the parameter with the maximum overlap of boxes of the same class.
        overlap: the default of `iou`.
        most: the parameter with the maximum number of detections in an image.
        largest_number: the default of `most`.
        image_topic: the parameter with the topic of images.
        images: the default of `image_topic`.
        output_topic: the parameter with the topic of detections.
        detections: the default of `output_topic`.
        debug_images: the topics of images with boxes.
        message: the type of detection messages.
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
