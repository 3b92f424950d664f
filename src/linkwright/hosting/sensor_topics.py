"""The topics of laser scanners and cameras of a simulated robot, read from its description."""

from __future__ import annotations

import re
from collections.abc import Iterable

_LIDAR = re.compile(r"""<sensor\b[^>]*\btype=["'](?:gpu_)?(?:ray|lidar)["'].*?</sensor>""", re.DOTALL)
_SCAN_TOPIC = re.compile(r"~/out:=\s*([\w/]+)|<topic>\s*([\w/]+)\s*</topic>")
_CAMERA = re.compile(
    r"""<sensor\b(?=[^>]*\btype=["'](camera|wideanglecamera|depth|depth_camera|rgbd|rgbd_camera)["'])[^>]*?\bname=["']([\w/]+)["'].*?</sensor>""",
    re.DOTALL,
)
_CLASSIC_PLUGIN = re.compile(r"""\bfilename=["'](?:lib)?gazebo_ros""")
_NAMESPACE = re.compile(r"<namespace>\s*([\w/]+)\s*</namespace>")
_CAMERA_NAME = re.compile(r"<camera_?[nN]ame>\s*([\w/]+)\s*<")
_IMAGE_NAME = re.compile(r"<image_?[tT]opic_?[nN]ame>\s*([\w/]+)\s*<")
_REMAPPING = re.compile(r"<remapping>\s*([\w/]+)\s*:=\s*([\w/]+)\s*</remapping>")
_TOPIC = re.compile(r"<topic>\s*([\w/]+)\s*</topic>")


def find_scan_topics(text: str) -> list[str]:
    """Return the topics of the laser scanners in a description, in document order."""
    matches = (_SCAN_TOPIC.search(match[0]) for match in _LIDAR.finditer(text))
    return _to_absolute_topics(match[1] or match[2] for match in matches if match)


def find_image_topics(text: str) -> list[str]:
    """Return the topics of the cameras in a description, in document order.

    Cameras of gz without a topic name have the default topics ``/image`` and ``/depth_image``, as in
    ``linkwright sim``.
    """
    return _to_absolute_topics(_compute_image_topic(match[0], match[1], match[2]) for match in _CAMERA.finditer(text))


def _compute_image_topic(sensor: str, kind: str, name: str) -> str:
    if not _CLASSIC_PLUGIN.search(sensor):
        topic_match = _TOPIC.search(sensor)
        if topic_match is None:
            return "depth_image" if kind.startswith("depth") else "image"
        return f"{topic_match[1]}/image" if kind.startswith("rgbd") else topic_match[1]
    image_topic = _find_first_match(_IMAGE_NAME, sensor, "image_raw")
    topic_name = (
        image_topic if image_topic.startswith("/") else f"{_find_first_match(_CAMERA_NAME, sensor, name)}/{image_topic}"
    )
    topic_name = dict(_REMAPPING.findall(sensor)).get(topic_name, topic_name)
    return topic_name if topic_name.startswith("/") else f"{_find_first_match(_NAMESPACE, sensor, '')}/{topic_name}"


def _find_first_match(pattern: re.Pattern[str], text: str, default: str) -> str:
    match = pattern.search(text)
    return match[1] if match else default


def _to_absolute_topics(topics: Iterable[str]) -> list[str]:
    """Return the topics as absolute names, without duplicates."""
    return list(dict.fromkeys(f"/{topic.strip('/')}" for topic in topics))
