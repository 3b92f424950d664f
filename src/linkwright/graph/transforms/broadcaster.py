"""Transform broadcasters for ``/tf`` and ``/tf_static``, as in ``tf2_ros``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linkwright.graph.qos.profile import STATIC_TF_PUBLISHER_QOS, TF_QOS, QoSProfile
from linkwright.messages import TFMessage, TransformStamped


class TransformBroadcaster:
    """A publisher of transforms that change, on ``/tf``.

    Args:
        node: the node that publishes.
        qos: the QoS of the publisher.
    """

    def __init__(self, node: Any, qos: QoSProfile | int = TF_QOS) -> None:
        self.pub_tf = node.create_publisher(TFMessage, "/tf", qos)

    def sendTransform(self, transform: TransformStamped | Sequence[TransformStamped]) -> None:  # noqa: N802
        """Publish one transform, or several in a single message."""
        self.pub_tf.publish(TFMessage(transforms=_to_list(transform)))


class StaticTransformBroadcaster:
    """A publisher of transforms that do not change, on ``/tf_static``.

    Each message contains all transforms that were sent so far, so that late joiners receive all of them.

    Args:
        node: the node that publishes.
        qos: the QoS of the publisher.
    """

    def __init__(self, node: Any, qos: QoSProfile | int = STATIC_TF_PUBLISHER_QOS) -> None:
        self.pub_tf = node.create_publisher(TFMessage, "/tf_static", qos)
        self._sent_transforms: dict[str, TransformStamped] = {}

    def sendTransform(self, transform: TransformStamped | Sequence[TransformStamped]) -> None:  # noqa: N802
        """Publish one or several transforms, together with all transforms sent earlier.

        A transform replaces an earlier transform with the same child frame.
        """
        for transform_stamped in _to_list(transform):
            self._sent_transforms[transform_stamped.child_frame_id] = transform_stamped
        self.pub_tf.publish(TFMessage(transforms=list(self._sent_transforms.values())))


def _to_list(transform: Any) -> list[TransformStamped]:
    return list(transform) if isinstance(transform, (list, tuple)) else [transform]
