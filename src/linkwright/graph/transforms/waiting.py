"""The tf buffer of nodes, with lookups that block or return futures.

The methods are those of ``tf2_ros.Buffer``.
"""

from __future__ import annotations

import threading
import time as steady
from collections.abc import Callable
from typing import Any

from linkwright.graph.loop.future import Future
from linkwright.graph.time.clock import JumpThreshold
from linkwright.graph.time.values import Duration
from linkwright.graph.transforms.core import BufferCore

_CHECK_INTERVAL_S = 0.1
"""The interval, in seconds, at which a wait checks again, because a step of the clock may change the result."""

NO_TIME = Duration()


class Buffer(BufferCore):
    """A buffer of transforms, with lookups that can wait for a transform.

    Args:
        cache_time: how long transforms are stored; 10 seconds by default.
        node: a node that offers the service ``tf2_frames``, which reports all frames, and whose logger reports refused
            transforms. When the node's clock jumps back, the buffer is cleared. None for a buffer without a node.
    """

    def __init__(self, cache_time: Any = None, node: Any = None) -> None:
        super().__init__(cache_time, logger=None if node is None else node.get_logger().get_child("tf2"))
        self._new_data = threading.Condition(self._lock)
        self._new_data_callbacks: list[Callable[[], None]] = []
        self._node = node
        if node is not None:
            from linkwright.messages import get_service

            self.srv = node.create_service(get_service("tf2_msgs/srv/FrameGraph"), "tf2_frames", self._on_frames)
            self.jump_handle = node.get_clock().create_jump_callback(
                JumpThreshold(min_forward=None, min_backward=Duration(seconds=-1)), post_callback=self._on_time_jump
            )

    def set_transform(self, transform: Any, authority: str) -> None:
        """Store a transform, and complete the pending lookups that it satisfies. See `BufferCore`."""
        super().set_transform(transform, authority)
        self._call_new_data_callbacks()

    def set_transform_static(self, transform: Any, authority: str) -> None:
        """Store a static transform, and complete the pending lookups that it satisfies.

        See `BufferCore`.
        """
        super().set_transform_static(transform, authority)
        self._call_new_data_callbacks()

    def update(self, message: Any, *, static: bool, now_ns: int = 0, authority: str = "default_authority") -> None:
        """Store the transforms of a message, and complete the pending lookups that they satisfy.

        See `BufferCore`.
        """
        super().update(message, static=static, now_ns=now_ns, authority=authority)
        self._call_new_data_callbacks()

    def lookup_transform(self, target_frame: str, source_frame: str, time: Any, timeout: Any = NO_TIME) -> Any:
        """Return the pose of the source frame in the target frame.

        See `BufferCore.lookup_transform_core`.

        Args:
            target_frame: the frame to transform to.
            source_frame: the frame to transform from.
            time: the time; zero for the latest.
            timeout: how long to wait for the transform. Another thread must spin the node in the meantime.

        Raises:
            TransformException: the transform does not become available in time; the class indicates the reason.
        """
        self.can_transform(target_frame, source_frame, time, timeout)
        return self.lookup_transform_core(target_frame, source_frame, time)

    async def lookup_transform_async(self, target_frame: str, source_frame: str, time: Any) -> Any:
        """Wait in a coroutine until a transform is available, and return it.

        See `lookup_transform`.
        """
        await self.wait_for_transform_async(target_frame, source_frame, time)
        return self.lookup_transform_core(target_frame, source_frame, time)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Any = NO_TIME,
    ) -> Any:
        """Return the pose of the source frame at one time in the target frame at another time.

        See `BufferCore.lookup_transform_full_core`.
        """
        self.can_transform_full(target_frame, target_time, source_frame, source_time, fixed_frame, timeout)
        return self.lookup_transform_full_core(target_frame, target_time, source_frame, source_time, fixed_frame)

    async def lookup_transform_full_async(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Any:
        """Wait in a coroutine until the transform is available, and return it.

        See `lookup_transform_full`.
        """
        await self.wait_for_transform_full_async(target_frame, target_time, source_frame, source_time, fixed_frame)
        return self.lookup_transform_full_core(target_frame, target_time, source_frame, source_time, fixed_frame)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Any = NO_TIME,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Return whether a lookup succeeds within the timeout.

        With `return_debug_tuple`, return a tuple of this bool and the reason for a failure.
        """
        result = self._wait(lambda: self.can_transform_core(target_frame, source_frame, time), timeout)
        return result if return_debug_tuple else result[0]

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Any = NO_TIME,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Return whether a lookup with a fixed frame succeeds in time. See `can_transform`."""
        result = self._wait(
            lambda: self.can_transform_full_core(target_frame, target_time, source_frame, source_time, fixed_frame),
            timeout,
        )
        return result if return_debug_tuple else result[0]

    def wait_for_transform_async(self, target_frame: str, source_frame: str, time: Any) -> Future[Any]:
        """Return a future that gets the transform as soon as it is available."""
        return self._create_future(
            lambda: self.can_transform_core(target_frame, source_frame, time)[0],
            lambda: self.lookup_transform_core(target_frame, source_frame, time),
        )

    def wait_for_transform_full_async(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Future[Any]:
        """Return a future that gets a transform through a fixed frame as soon as it is available."""
        arguments = (target_frame, target_time, source_frame, source_time, fixed_frame)
        return self._create_future(
            lambda: self.can_transform_full_core(*arguments)[0], lambda: self.lookup_transform_full_core(*arguments)
        )

    def _wait(self, query: Callable[[], tuple[bool, str]], timeout: Any) -> tuple[bool, str]:
        deadline_s = steady.monotonic() + timeout.nanoseconds / 1e9
        with self._new_data:
            while True:
                result = query()
                remaining_s = deadline_s - steady.monotonic()
                if result[0] or remaining_s <= 0.0:
                    return result
                self._new_data.wait(min(remaining_s, _CHECK_INTERVAL_S))

    def _create_future(self, is_available: Callable[[], bool], look_up: Callable[[], Any]) -> Future[Any]:
        future: Future[Any] = Future()

        def on_new_data() -> None:
            if future.done():
                return
            try:
                if is_available():
                    future.set_result(look_up())
            except Exception as error:  # noqa: BLE001  # it belongs to the waiter
                future.set_exception(error)

        with self._lock:
            on_new_data()
            if not future.done():
                self._new_data_callbacks.append(on_new_data)
                future.add_waiter(lambda: self._remove_callback(on_new_data))
        return future

    def _remove_callback(self, callback: Callable[[], None]) -> None:
        with self._lock:
            if callback in self._new_data_callbacks:
                self._new_data_callbacks.remove(callback)

    def _call_new_data_callbacks(self) -> None:
        with self._new_data:
            self._new_data.notify_all()
            callbacks = list(self._new_data_callbacks)
        for callback in callbacks:
            callback()

    def _on_time_jump(self, _jump: Any) -> None:
        self._logger.warning("Detected jump back in time. Clearing tf buffer.")
        self.clear()

    def _on_frames(self, _request: Any, response: Any) -> Any:
        response.frame_yaml = self.all_frames_as_yaml()
        return response
