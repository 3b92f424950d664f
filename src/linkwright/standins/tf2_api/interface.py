"""The common interface of tf2_ros buffers (tf2_ros ``BufferInterface``)."""

from __future__ import annotations

from typing import Any

from linkwright.graph.time.values import Duration, Time
from linkwright.standins.tf2_api.conversion import NotImplementedException, TransformRegistration, convert

NO_TIME = Duration()


class BufferInterface:
    """The base class of buffers.

    This class applies transforms to messages. Subclasses look up the transforms.
    """

    def __init__(self) -> None:
        self.registration = TransformRegistration()

    def transform(
        self, object_stamped: Any, target_frame: str, timeout: Duration = NO_TIME, new_type: Any = None
    ) -> Any:
        """Transform a stamped object into another frame.

        Args:
            object_stamped: the object to transform. Its type must be registered; ``import tf2_geometry_msgs`` registers
                the types of geometry_msgs.
            target_frame: the frame into which the object is transformed.
            timeout: the maximum time to wait for the transform.
            new_type: the type to convert the result to; None for no conversion.

        Raises:
            TypeException: the type is not registered.
            TransformException: there is no transform.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        stamped_transform = self.lookup_transform(target_frame, header.frame_id, Time.from_msg(header.stamp), timeout)
        result = do_transform(object_stamped, stamped_transform)
        return result if new_type is None else convert(result, new_type)

    def transform_full(
        self,
        object_stamped: Any,
        target_frame: str,
        target_time: Any,
        fixed_frame: str,
        timeout: Duration = NO_TIME,
        new_type: Any = None,
    ) -> Any:
        """Transform a stamped object into another frame at another time, through a fixed frame.

        Raises:
            TypeException: the type is not registered.
            TransformException: there is no transform.
        """
        do_transform = self.registration.get(type(object_stamped))
        header = object_stamped.header
        stamped_transform = self.lookup_transform_full(
            target_frame, target_time, header.frame_id, Time.from_msg(header.stamp), fixed_frame, timeout
        )
        result = do_transform(object_stamped, stamped_transform)
        return result if new_type is None else convert(result, new_type)

    def lookup_transform(self, *_frames_and_times: Any, **_options: Any) -> Any:
        """Return the transform from the source frame to the target frame at a time."""
        raise NotImplementedException

    def lookup_transform_full(self, *_frames_and_times: Any, **_options: Any) -> Any:
        """Return the transform between two frames at different times, through a fixed frame."""
        raise NotImplementedException

    def can_transform(self, *_frames_and_times: Any, **_options: Any) -> Any:
        """Return whether `lookup_transform` would return a transform."""
        raise NotImplementedException

    def can_transform_full(self, *_frames_and_times: Any, **_options: Any) -> Any:
        """Return whether `lookup_transform_full` would return a transform."""
        raise NotImplementedException
