"""The advanced public examples.

The tests cover custom executors and groups, asyncio, events, reused messages.
"""

from __future__ import annotations

import asyncio
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest
import rclpy
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from rclpy.action import ActionClient, ActionServer
from rclpy.callback_groups import CallbackGroup, MutuallyExclusiveCallbackGroup
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.executors import Executor, SingleThreadedExecutor, TimeoutException
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.subscription_content_filter_options import ContentFilterOptions
from std_msgs.msg import Int64MultiArray, String

from tests.waiting import TIMEOUT_S


@pytest.fixture(autouse=True)
def ros(monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    rclpy.init(args=[])
    yield
    rclpy.try_shutdown()


@pytest.fixture
def node():
    return rclpy.create_node("node")


class TestMessageSnapshots:
    """Changes of a message after it was sent or received do not affect others."""

    def test_reused_message_is_published_as_snapshot(self, node):
        texts, message = [], String()
        node.create_subscription(String, "topic", lambda message: texts.append(message.data), 10)
        publisher = node.create_publisher(String, "topic", 10)
        for word in ("one", "two", "three"):
            message.data = word
            publisher.publish(message)
        for _ in range(3):
            rclpy.spin_once(node, timeout_sec=TIMEOUT_S)
        assert texts == ["one", "two", "three"]

    def test_subscription_callbacks_receive_separate_copies(self, node):
        sequences = []

        def callback(message):
            message.data.append(len(message.data))
            sequences.append(message.data.tolist())

        for _ in range(2):
            node.create_subscription(Int64MultiArray, "topic", callback, 10)
        sent = Int64MultiArray(data=[7])
        node.create_publisher(Int64MultiArray, "topic", 10).publish(sent)
        for _ in range(2):
            rclpy.spin_once(node, timeout_sec=TIMEOUT_S)
        assert sequences == [[7, 1], [7, 1]]
        assert sent.data.tolist() == [7]

    def test_reused_request_is_sent_as_snapshot(self, node):
        def add(request, response):
            response.sum = request.a + request.b
            return response

        node.create_service(AddTwoInts, "add", add)
        client = node.create_client(AddTwoInts, "add")
        request, futures = AddTwoInts.Request(), []
        for number in range(3):
            request.a = number
            futures.append(client.call_async(request))
        for future in futures:
            rclpy.spin_until_future_complete(node, future, timeout_sec=TIMEOUT_S)
        assert [future.result().sum for future in futures] == [0, 1, 2]

    def test_growing_feedback_is_sent_as_snapshot(self, node):
        sequences = []

        def execute(goal_handle):
            feedback = Fibonacci.Feedback()
            feedback.sequence = [0, 1]
            for length in range(1, 4):
                feedback.sequence.append(feedback.sequence[length] + feedback.sequence[length - 1])
                goal_handle.publish_feedback(feedback)
            goal_handle.succeed()
            return Fibonacci.Result(sequence=feedback.sequence)

        ActionServer(node, Fibonacci, "fibonacci", execute)
        client = ActionClient(node, Fibonacci, "fibonacci")
        sent = client.send_goal_async(
            Fibonacci.Goal(order=4),
            feedback_callback=lambda message: sequences.append(message.feedback.sequence.tolist()),
        )
        rclpy.spin_until_future_complete(node, sent, timeout_sec=60)
        result = sent.result().get_result_async()
        rclpy.spin_until_future_complete(node, result, timeout_sec=60)
        assert result.result().result.sequence.tolist() == [0, 1, 1, 2, 3]
        assert sequences == [[0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3]]


class PriorityExecutor(Executor):
    """An executor in which nodes of high priority never wait for the others."""

    def __init__(self):
        super().__init__()
        self.high_priority_nodes = set()
        self.high = ThreadPoolExecutor(max_workers=4)
        self.low = ThreadPoolExecutor(max_workers=1)

    def add_high_priority_node(self, node):
        self.high_priority_nodes.add(node)
        self.add_node(node)

    def spin_once(self, timeout_sec=None):
        try:
            handler, _group, node = self.wait_for_ready_callbacks(timeout_sec=timeout_sec)
        except TimeoutException:
            pass
        else:
            (self.high if node in self.high_priority_nodes else self.low).submit(handler)


class ThrottledCallbackGroup(CallbackGroup):
    """A group that lets two callbacks start, and more after a timer's call."""

    def __init__(self, node):
        super().__init__()
        self.left = 2
        self.refills = 0
        self.lock = threading.Lock()
        self.timer = node.create_timer(0.05, self.refill, callback_group=MutuallyExclusiveCallbackGroup())

    def refill(self):
        with self.lock:
            self.left = 2
            self.refills += 1

    def can_execute(self, entity):
        return self.left > 0

    def beginning_execution(self, entity):
        with self.lock:
            if self.left <= 0:
                return False
            self.left -= 1
            return True

    def ending_execution(self, entity):
        pass


class TestOwnParts:
    def test_custom_executor_runs_by_priority(self, node):
        order, slow = [], threading.Event()
        urgent = rclpy.create_node("urgent")

        def block(_message):
            slow.wait(TIMEOUT_S)
            order.append("slow")

        node.create_subscription(String, "slow", block, 10)
        urgent.create_subscription(String, "urgent", lambda _message: (order.append("urgent"), slow.set()), 10)
        executor = PriorityExecutor()
        executor.add_high_priority_node(urgent)
        executor.add_node(node)
        for topic in ("slow", "urgent"):
            node.create_publisher(String, topic, 10).publish(String())
        deadline = time.monotonic() + TIMEOUT_S
        while len(order) < 2 and time.monotonic() < deadline:
            executor.spin_once(timeout_sec=0.1)
        for pool in (executor.high, executor.low):
            pool.shutdown()
        assert order == ["urgent", "slow"]

    def test_custom_callback_group_throttles_timer(self, node):
        group, start_times = ThrottledCallbackGroup(node), []
        node.create_timer(0.001, lambda: start_times.append(time.monotonic()), callback_group=group)
        end = rclpy.create_node("end").create_timer(0.28, lambda: None)
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        while group.refills < 4 or len(start_times) < 4:
            executor.spin_once(timeout_sec=0.02)
        assert end.timer_period_ns == 280_000_000
        assert len(start_times) <= 2 * (group.refills + 1)

    def test_events_executor_completes_task(self, node):
        executor = EventsExecutor()
        executor.add_node(node)
        future = executor.create_task(lambda: "done")
        executor.spin_until_future_complete(future, timeout_sec=TIMEOUT_S)
        assert future.result() == "done"


class TestEvents:
    def test_matched_events_report_endpoint_counts(self, node):
        event_counts = []
        node.create_publisher(
            String,
            "topic",
            10,
            event_callbacks=PublisherEventCallbacks(
                matched=lambda info: event_counts.append(("out", info.current_count))
            ),
        )
        subscription = node.create_subscription(
            String,
            "topic",
            lambda _message: None,
            10,
            event_callbacks=SubscriptionEventCallbacks(
                matched=lambda info: event_counts.append(("in", info.current_count))
            ),
        )
        for _ in range(2):
            rclpy.spin_once(node, timeout_sec=TIMEOUT_S)
        assert sorted(event_counts) == [("in", 1), ("out", 1)]
        node.destroy_subscription(subscription)
        rclpy.spin_once(node, timeout_sec=TIMEOUT_S)
        assert event_counts[-1] == ("out", 0)


class TestAsyncio:
    def test_action_goal_is_awaited_in_asyncio(self, node):
        """As in the asyncio client of the examples, the loop spins the node between its own steps."""

        def execute(goal_handle):
            goal_handle.succeed()
            return Fibonacci.Result(sequence=[goal_handle.request.order])

        ActionServer(node, Fibonacci, "fibonacci", execute)
        client = ActionClient(node, Fibonacci, "fibonacci")

        async def spinning():
            while rclpy.ok():
                rclpy.spin_once(node, timeout_sec=0)
                await asyncio.sleep(1e-4)

        async def ask():
            handle = await client.send_goal_async(Fibonacci.Goal(order=5))
            return await handle.get_result_async()

        async def run():
            spinner = asyncio.ensure_future(spinning())
            result = await asyncio.wait_for(ask(), 5)
            spinner.cancel()
            return result

        assert asyncio.run(run()).result.sequence.tolist() == [5]


class TestNodeBasics:
    def test_node_can_be_spun_in_its_own_callback(self, node):
        calls = []

        def callback():
            calls.append(len(calls))
            if len(calls) == 1:
                rclpy.spin_once(node, timeout_sec=0)

        node.create_timer(0.005, callback)
        rclpy.spin_until_future_complete(node, rclpy.task.Future(), timeout_sec=0.1)
        assert len(calls) > 3

    def test_destroy_timer_returns_false_if_missing(self, node):
        assert node.destroy_timer(None) is False
        timer = node.create_timer(1, None)
        assert (node.destroy_timer(timer), node.destroy_timer(timer)) == (True, False)

    def test_subscription_has_logger_name_and_callback_type(self, node):
        subscription = node.create_subscription(String, "topic", lambda _message, _info: None, 10)
        assert subscription.logger_name == "node"
        assert subscription._callback_type is rclpy.subscription.Subscription.CallbackType.WithMessageInfo

    def test_classes_are_subscriptable_in_annotations(self):
        assert ActionClient[Fibonacci].__origin__ is ActionClient
        assert Parameter[bool].__args__ == (bool,)

    def test_content_filter_selects_messages(self, node):
        texts = []
        options = ContentFilterOptions(filter_expression="data = %0", expression_parameters=["'yes'"])
        subscription = node.create_subscription(
            String, "topic", lambda message: texts.append(message.data), 10, content_filter_options=options
        )
        publisher = node.create_publisher(String, "topic", 10)
        assert subscription.is_cft_enabled
        assert subscription.get_content_filter() == options
        for text in ("no", "yes"):
            publisher.publish(String(data=text))
        subscription.set_content_filter("", [])
        publisher.publish(String(data="all"))
        while len(texts) < 2:
            rclpy.spin_once(node, timeout_sec=60.0)
        assert texts == ["yes", "all"]
        assert not subscription.is_cft_enabled

    def test_context_manager_initializes_context(self):
        with rclpy.context.Context() as context:
            assert context.ok()
            assert Node("other", context=context).context is context
        assert not context.ok()
