"""The properties of the DepthCloud display besides those of all displays of points."""

from __future__ import annotations

from dataclasses import replace

from linkwright.viewer.config.schema import PropertySpec, Schema
from linkwright.viewer.displays.properties.cloud import POSITION_TRANSFORMER, STYLE_SPECS, TRANSFORMER_SPECS
from linkwright.viewer.images import RAW, TRANSPORTS

RELIABILITY = "Reliability Policy"
DEPTH_TOPIC, DEPTH_TRANSPORT = "Depth Map Topic", "Depth Map Transport Hint"
INFO_TOPIC = "CameraInfo Topic"
COLOUR_TOPIC, COLOUR_TRANSPORT = "Color Image Topic", "Color Transport Hint"
QUEUE_SIZE = "Queue Size"
AUTO_SIZE, SIZE_FACTOR = "Auto Size", "Auto Size Factor"
OCCLUSION, OCCLUSION_TIMEOUT = "Occlusion Compensation", "Occlusion Time-Out"
TOPIC_FILTER = "Topic Filter"
_IMAGE = "sensor_msgs/msg/Image"

SOURCES = frozenset((RELIABILITY, DEPTH_TOPIC, DEPTH_TRANSPORT, INFO_TOPIC, COLOUR_TOPIC, COLOUR_TRANSPORT, QUEUE_SIZE))
"""The properties that say where messages come from."""

DEPTH_SCHEMA: Schema = (
    PropertySpec(
        RELIABILITY,
        "enum",
        "Best effort",
        "Whether every message must arrive.",
        options=("System Default", "Reliable", "Best effort"),
    ),
    PropertySpec(TOPIC_FILTER, "bool", True, "Offer only topics whose names sound like depth and colour images."),
    PropertySpec(
        DEPTH_TOPIC,
        "topic",
        "",
        "sensor_msgs/msg/Image with depths: 16UC1 in millimetres or 32FC1 in metres.",
        messages=(_IMAGE,),
        words=("depth",),
    ),
    PropertySpec(DEPTH_TRANSPORT, "enum", RAW, "How the depths come: raw, or compressedDepth.", options=TRANSPORTS),
    PropertySpec(
        INFO_TOPIC,
        "topic",
        "",
        "sensor_msgs/msg/CameraInfo of the depths; without one, camera_info beside them.",
        messages=("sensor_msgs/msg/CameraInfo",),
    ),
    PropertySpec(
        COLOUR_TOPIC,
        "topic",
        "",
        "sensor_msgs/msg/Image with the colours of the points.",
        messages=(_IMAGE,),
        words=("color", "rgb", "bgr", "gray", "mono"),
    ),
    PropertySpec(COLOUR_TRANSPORT, "enum", RAW, "How the colours come: raw, or compressed.", options=TRANSPORTS),
    PropertySpec(QUEUE_SIZE, "int", 5, "How many messages may wait.", minimum=1, maximum=1000),
    PropertySpec(
        AUTO_SIZE,
        "bool",
        True,
        "Make each point as large as its pixel is at its depth.",
        expanded=True,
        children=(
            PropertySpec(
                SIZE_FACTOR,
                "float",
                1.0,
                "Times so much.",
                minimum=0.0001,
                when=((AUTO_SIZE,), True),
            ),
        ),
    ),
    PropertySpec(
        OCCLUSION,
        "bool",
        False,
        "Keep points that something nearer covers, until the camera moves.",
        expanded=True,
        children=(
            PropertySpec(
                OCCLUSION_TIMEOUT,
                "float",
                30.0,
                "Seconds until covered points are taken away.",
                when=((OCCLUSION,), True),
            ),
        ),
    ),
    *STYLE_SPECS,
    *(replace(spec, hidden=True) if spec.name == POSITION_TRANSFORMER else spec for spec in TRANSFORMER_SPECS),
)

DEPTH_SCHEMA_UNFILTERED: Schema = tuple(replace(spec, words=()) for spec in DEPTH_SCHEMA)
"""The same where the names of topics do not matter: ``Topic Filter`` is off."""
