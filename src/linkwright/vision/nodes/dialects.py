"""The names of nodes, parameters and topics of other packages' detectors.

Sources: yolo_ros 4 (mgonzs13), with node, parameters, defaults, topics and yolo_msgs; openrobotics_darknet_ros;
yolov5_ros; yolov5_ros2 (fishros).
"""

from __future__ import annotations

from dataclasses import dataclass

VISION, YOLO = "vision_msgs/msg/Detection2DArray", "yolo_msgs/msg/DetectionArray"


@dataclass(frozen=True, slots=True)
class Dialect:
    """The parameters and topics of a detector node.

    The name of a parameter that the node lacks is empty.

    Attributes:
        model: the parameter with the ONNX file or the name of the detector.
        labels: the parameter with the label file.
        threshold: the parameter for the minimum score.
        default_threshold: the default of `threshold`.
        iou: the parameter for the maximum overlap of boxes of the same class.
        default_iou: the default of `iou`.
        max_detections_parameter: the parameter for the maximum number of detections in an image.
        default_max_detections: the default of `max_detections_parameter`.
        image_topic: the parameter for the topic of images.
        default_image_topic: the default of `image_topic`, or the fixed topic if there is no such parameter.
        output_topic: the parameter for the topic of detections.
        default_output_topic: the default of `output_topic`, or the fixed topic if there is no such parameter.
        debug_image_topics: the topics of images with boxes drawn into them.
        message_type: the type of detection messages.
    """

    model: str = "model"
    labels: str = "labels"
    threshold: str = "threshold"
    default_threshold: float = 0.5
    iou: str = "iou"
    default_iou: float = 0.5
    max_detections_parameter: str = "max_det"
    default_max_detections: int = 300
    image_topic: str = "input_image_topic"
    default_image_topic: str = "image_raw"
    output_topic: str = ""
    default_output_topic: str = "detections"
    debug_image_topics: tuple[str, ...] = ("debug_image",)
    message_type: str = VISION


LINKWRIGHT = Dialect()
YOLO_ROS = Dialect(debug_image_topics=("debug_image", "dbg_image"), message_type=YOLO)
YOLOV5_ROS = Dialect(
    model="weights",
    threshold="confidence_threshold",
    default_threshold=0.25,
    iou="iou_threshold",
    default_iou=0.45,
    max_detections_parameter="maximum_detections",
    default_max_detections=1000,
    output_topic="output_topic",
    debug_image_topics=("image_out",),
)
YOLOV5_ROS2 = Dialect(
    default_threshold=0.25,
    default_iou=0.45,
    image_topic="image_topic",
    default_image_topic="/image_raw",
    default_output_topic="yolo_result",
    debug_image_topics=("result_img",),
)
DARKNET_ROS = Dialect(
    model="network.weights",
    labels="network.class_names",
    threshold="detection.threshold",
    default_threshold=0.25,
    iou="detection.nms_threshold",
    default_iou=0.45,
    image_topic="",
    default_image_topic="~/images",
    default_output_topic="~/detections",
    debug_image_topics=("~/debug_image",),
)
