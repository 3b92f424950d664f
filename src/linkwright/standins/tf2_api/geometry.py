"""Register transformations of geometry_msgs messages (``import tf2_geometry_msgs``)."""

from __future__ import annotations

from typing import Any

from linkwright.graph.transforms import geometry as transform_geometry
from linkwright.messages import get_message
from linkwright.standins.tf2_api.conversion import ConvertRegistration, TransformRegistration

_TRANSFORM_FUNCTIONS = {
    "PointStamped": transform_geometry.do_transform_point,
    "PolygonStamped": transform_geometry.do_transform_polygon_stamped,
    "PoseStamped": transform_geometry.do_transform_pose_stamped,
    "PoseWithCovarianceStamped": transform_geometry.do_transform_pose_with_covariance_stamped,
    "Vector3Stamped": transform_geometry.do_transform_vector3,
    "WrenchStamped": transform_geometry.do_transform_wrench,
}


def to_msg_msg(msg: Any) -> Any:
    """Return a message unchanged, because it does not need to be converted to a message."""
    return msg


from_msg_msg = to_msg_msg


def register() -> None:
    """Register the transformations of geometry_msgs messages for all buffers."""
    for name, transformation in _TRANSFORM_FUNCTIONS.items():
        message_class = get_message(f"geometry_msgs/msg/{name}")
        TransformRegistration().add(message_class, transformation)
        ConvertRegistration().add_to_msg(message_class, to_msg_msg)
        ConvertRegistration().add_from_msg(message_class, from_msg_msg)
