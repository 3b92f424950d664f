"""Registers the messages of geometry_msgs with the buffers (``import tf2_geometry_msgs``)."""

from __future__ import annotations

from typing import Any

from linkwright.graph.transforms import geometry as transform_geometry
from linkwright.messages import get_message
from linkwright.standins.tf2_api.conversion import ConvertRegistration, TransformRegistration

_TRANSFORMATIONS = {
    "PointStamped": transform_geometry.do_transform_point,
    "PolygonStamped": transform_geometry.do_transform_polygon_stamped,
    "PoseStamped": transform_geometry.do_transform_pose_stamped,
    "PoseWithCovarianceStamped": transform_geometry.do_transform_pose_with_covariance_stamped,
    "Vector3Stamped": transform_geometry.do_transform_vector3,
    "WrenchStamped": transform_geometry.do_transform_wrench,
}


def to_msg_msg(msg: Any) -> Any:
    """Return the message unchanged; the conversion to a message for types that are messages."""
    return msg


from_msg_msg = to_msg_msg


def register() -> None:
    """Register the transformation of geometry_msgs messages in the registry that all buffers share."""
    for name, transformation in _TRANSFORMATIONS.items():
        kind = get_message(f"geometry_msgs/msg/{name}")
        TransformRegistration().add(kind, transformation)
        ConvertRegistration().add_to_msg(kind, to_msg_msg)
        ConvertRegistration().add_from_msg(kind, from_msg_msg)
