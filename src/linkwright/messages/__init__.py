"""ROS 2 messages as plain Python classes, with the field names and defaults of their ``.msg`` files."""

from linkwright.messages.geometry import Point, Pose, Quaternion, Transform, TransformStamped, Vector3
from linkwright.messages.message import Message
from linkwright.messages.sensor import FloatSequence, JointState
from linkwright.messages.standard import Header, String
from linkwright.messages.time import Duration, Time
from linkwright.messages.transforms import TFMessage, TransformBatch

__all__ = [
    "Duration",
    "FloatSequence",
    "Header",
    "JointState",
    "Message",
    "Point",
    "Pose",
    "Quaternion",
    "String",
    "TFMessage",
    "Time",
    "Transform",
    "TransformBatch",
    "TransformStamped",
    "Vector3",
]
