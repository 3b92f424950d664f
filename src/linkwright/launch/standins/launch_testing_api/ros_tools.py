"""Tools for topics in launch tests (``launch_testing_ros``)."""

from __future__ import annotations

import threading
import uuid
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from types import TracebackType
from typing import TYPE_CHECKING, Any

from linkwright.graph.faults import ExternalShutdownException
from linkwright.launch.standins.launch_testing_api import text
from linkwright.launch.standins.launch_testing_api.runner import LaunchTestRunner as _LaunchTestRunner
from linkwright.packages.ament_resources import get_resource, has_resource
from linkwright.standins.rclpy_api.context import Context
from linkwright.standins.rclpy_api.executors import SingleThreadedExecutor
from linkwright.standins.rclpy_api.node import Node

if TYPE_CHECKING:
    from typing_extensions import Self

_QUEUE_DEPTH = 10
_SPIN_S = 0.1
_STOP_TIMEOUT_S = 5.0


class LaunchTestRunner(_LaunchTestRunner):
    """A runner of launches and the tests of each launch."""


class WaitForTopics:
    """A wait for a message on each of several topics.

    An instance can be used as a context manager.

    Args:
        topic_tuples: names and types of the topics.
        timeout: the timeout in seconds.
        messages_received_buffer_length: the number of messages to store for each topic.
        trigger: a function that is called after the subscriptions are created.
        node_namespace: the namespace of the subscribing node.
    """

    def __init__(
        self,
        topic_tuples: Iterable[tuple[str, type]],
        timeout: float = 5.0,
        messages_received_buffer_length: int = 10,
        trigger: Callable[..., object] | None = None,
        node_namespace: str | None = None,
    ) -> None:
        self.topic_tuples = list(topic_tuples)
        self.timeout = timeout
        self.messages_received_buffer_length = messages_received_buffer_length
        self._trigger = trigger
        self._received: dict[str, deque[Any]] = {}
        self._arrival = threading.Condition()
        self._context = Context()
        self._context.init(args=[])
        name = f"_test_node_{uuid.uuid4().hex[:10]}"
        self._node = Node(name, context=self._context, namespace=node_namespace or "")
        self._executor = SingleThreadedExecutor(context=self._context)
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._spin, name="wait_for_topics", daemon=True)
        self._thread.start()

    def wait(self, *args: Any, **kwargs: Any) -> bool:
        """Wait for the messages, and return whether a message arrived on each topic in time.

        The arguments are passed to the trigger.
        """
        with self._arrival:
            for messages in self._received.values():
                messages.clear()
        for name, message_type in self.topic_tuples:
            if name not in self._received:
                self._received[name] = deque(maxlen=self.messages_received_buffer_length)
                self._node.create_subscription(message_type, name, self._create_listener(name), _QUEUE_DEPTH)
        if self._trigger is not None:
            self._trigger(self._node, *args, **kwargs)
        with self._arrival:
            return self._arrival.wait_for(lambda: not self.topics_not_received(), timeout=self.timeout)

    def shutdown(self) -> None:
        """Stop receiving messages, and destroy the node."""
        self._context.try_shutdown()
        self._thread.join()
        self._node.destroy_node()

    def topics_received(self) -> set[str]:
        """Return the topics on which a message arrived."""
        return {name for name, messages in self._received.items() if messages}

    def topics_not_received(self) -> set[str]:
        """Return the topics on which no message arrived."""
        return {name for name, _ in self.topic_tuples} - self.topics_received()

    def received_messages(self, topic_name: str) -> list[Any]:
        """Return the stored messages of a topic, oldest first.

        Raises:
            KeyError: no subscription to the topic was created.
        """
        if topic_name not in self._received:
            raise KeyError("No messages received for topic: " + topic_name)
        return list(self._received[topic_name])

    def __enter__(self) -> Self:
        if not self.wait():
            missing_topics = self.topics_not_received()
            self.shutdown()
            raise RuntimeError("Did not receive messages on these topics: ", missing_topics)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.shutdown()

    def _create_listener(self, name: str) -> Callable[[Any], None]:
        def on_message(message: Any) -> None:
            with self._arrival:
                self._received[name].append(message)
                self._arrival.notify_all()

        return on_message

    def _spin(self) -> None:
        with suppress(ExternalShutdownException):
            self._executor.spin()


class MessagePump:
    """A thread that runs the callbacks of a node.

    Args:
        node: the node whose callbacks are run.
        context: the rclpy context of the node.
    """

    def __init__(self, node: Any, context: Any = None) -> None:
        self._node = node
        self._context = context
        self._stop_requested = threading.Event()
        self._thread = threading.Thread(target=self._pump, name="msg_pump_thread", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def stop(self) -> None:
        """Stop the thread.

        Raises:
            Exception: a callback does not return in time.
        """
        self._stop_requested.set()
        self._thread.join(timeout=_STOP_TIMEOUT_S)
        if self._thread.is_alive():
            raise Exception("Timed out waiting for message pump to stop")  # noqa: TRY002 - launch_testing_ros raises it

    def _pump(self) -> None:
        executor = SingleThreadedExecutor(context=self._context)
        executor.add_node(self._node)
        while not self._stop_requested.is_set():
            executor.spin_once(timeout_sec=_SPIN_S)


class DataRepublisher:
    """A republisher that publishes transformed messages of a topic on another topic.

    Args:
        node: the node that subscribes and publishes.
        listen_topic: the input topic.
        publish_topic: the output topic.
        msg_type: the message type of both topics.
        transform_fn: returns the output message for an input message, or None to publish nothing.
    """

    def __init__(
        self, node: Any, listen_topic: str, publish_topic: str, msg_type: type, transform_fn: Callable[[Any], Any]
    ) -> None:
        self._node = node
        self._transform = transform_fn
        self._count = 0
        self._republished: list[Any] = []
        self._publisher = node.create_publisher(msg_type, publish_topic, _QUEUE_DEPTH)
        self._subscription = node.create_subscription(msg_type, listen_topic, self._handle, _QUEUE_DEPTH)

    def shutdown(self) -> None:
        """Destroy the subscription and the publisher."""
        self._node.destroy_subscription(self._subscription)
        self._node.destroy_publisher(self._publisher)

    def get_num_received(self) -> int:
        """Return the number of received messages."""
        return self._count

    def get_num_republished(self) -> int:
        """Return the number of republished messages."""
        return len(self._republished)

    def get_republished(self) -> list[Any]:
        """Return the received messages that were republished."""
        return self._republished

    def _handle(self, message: Any) -> None:
        self._count += 1
        output = self._transform(message)
        if output:
            self._republished.append(message)
            self._publisher.publish(output)


def get_rmw_output_filter(rmw_implementation: str, filter_type: str) -> list[str]:
    """Return the prefixes or patterns of lines that tests ignore.

    The lines are output of an rmw implementation.

    Args:
        rmw_implementation: the package of the rmw implementation.
        filter_type: ``prefixes`` or ``patterns``.

    Raises:
        TypeError: there is no such filter type.
    """
    filter_types = ["prefixes", "patterns"]
    if filter_type not in filter_types:
        raise TypeError(f'Unsupported filter_type "{filter_type}". Supported types: {filter_types}')
    resource_type = f"rmw_output_{filter_type}"
    if not has_resource(resource_type, rmw_implementation):
        return []
    content, _ = get_resource(resource_type, rmw_implementation)
    return content.splitlines()


def basic_output_filter(
    filtered_prefixes: Sequence[str] | None = None,
    filtered_patterns: Sequence[str] | None = None,
    filtered_rmw_implementation: str | None = None,
) -> Callable[[str], str]:
    """Return a function that removes irrelevant lines from an output.

    Args:
        filtered_prefixes: the prefixes of lines to remove.
        filtered_patterns: regular expressions for the beginnings of lines to remove.
        filtered_rmw_implementation: an rmw implementation whose irrelevant lines are also removed, see
            `get_rmw_output_filter`.
    """
    prefixes = list(text.get_default_filtered_prefixes() if filtered_prefixes is None else filtered_prefixes)
    patterns = list(filtered_patterns or ())
    if filtered_rmw_implementation:
        prefixes += get_rmw_output_filter(filtered_rmw_implementation, "prefixes")
        patterns += get_rmw_output_filter(filtered_rmw_implementation, "patterns")
    return text.basic_output_filter(prefixes, patterns)
