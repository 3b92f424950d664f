"""Stands in for ``tf2_ros.transform_listener``."""

from linkwright.standins.tf2_api.listener import TransformListener

DEFAULT_TF_TOPIC = "/tf"
DEFAULT_STATIC_TF_TOPIC = "/tf_static"

__all__ = ["DEFAULT_STATIC_TF_TOPIC", "DEFAULT_TF_TOPIC", "TransformListener"]
