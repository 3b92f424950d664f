"""Nodes as users write them: publishers, subscriptions, timers, services, parameters."""

from __future__ import annotations

import logging
import threading
import time
from contextlib import suppress

import pytest
import rclpy
from example_interfaces.srv import AddTwoInts
from rcl_interfaces.msg import ParameterDescriptor, SetParametersResult
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.exceptions import (
    InvalidHandle,
    InvalidNamespaceException,
    InvalidNodeNameException,
    InvalidServiceNameException,
    InvalidTopicNameException,
    NotInitializedException,
    ParameterAlreadyDeclaredException,
    ParameterNotDeclaredException,
)
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSDurabilityPolicy, QoSProfile, QoSReliabilityPolicy, qos_profile_sensor_data
from rclpy.task import Future
from std_msgs.msg import Int64, String
from std_srvs.srv import Trigger

from tests.waiting import TIMEOUT_S


class Counter(Node):
    """Publishes numbers, as the first node of every course does."""

    def __init__(self):
        super().__init__("counter")
        self.publisher_ = self.create_publisher(String, "topic", 10)
        self.timer = self.create_timer(0.01, self.timer_callback)
        self.i = 0
        # Attributes that other node classes use internally.
        self._publishers, self._timers, self._name, self._parameters, self._graph = {}, [], "mine", {}, None
        self._clock = self._logger = self._subscriptions = self._services = self._clients = None

    def timer_callback(self):
        msg = String()
        msg.data = f"Hello {self.i}"
        self.publisher_.publish(msg)
        self.get_logger().info(f'Publishing: "{msg.data}"')
        self.i += 1


class Listener(Node):
    def __init__(self, message_count):
        super().__init__("listener")
        self.heard, self.wanted, self.finished = [], message_count, Future()
        self.subscription = self.create_subscription(String, "topic", self.listener_callback, 10)

    def listener_callback(self, msg):
        self.heard.append(msg.data)
        if len(self.heard) == self.wanted:
            self.finished.set_result(None)


@pytest.fixture(autouse=True)
def _isolated(monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")


@pytest.fixture
def ros():
    before = threading.active_count()
    rclpy.init(args=[])
    yield
    rclpy.try_shutdown()
    assert threading.active_count() == before


@pytest.fixture
def node(ros):
    return rclpy.create_node("tested", namespace="/ns")


class TestMinimal:
    def test_talker_and_listener_exchange_messages(self, ros):
        executor = SingleThreadedExecutor()
        talker, listener = Counter(), Listener(5)
        executor.add_node(talker)
        executor.add_node(listener)
        executor.spin_until_future_complete(listener.finished, timeout_sec=TIMEOUT_S)
        assert listener.heard == [f"Hello {number}" for number in range(5)]
        executor.shutdown()
        talker.destroy_node()
        listener.destroy_node()

    def test_node_without_subclass_publishes_and_subscribes(self, ros):
        texts = []
        node = rclpy.create_node("minimal")
        publisher = node.create_publisher(String, "topic", 10)
        subscription = node.create_subscription(String, "topic", lambda msg: texts.append(msg.data), 10)
        assert subscription.topic_name == "/topic"
        while rclpy.ok() and len(texts) < 3:
            publisher.publish(String(data="hi"))
            rclpy.spin_once(node, timeout_sec=TIMEOUT_S)
        assert texts == ["hi"] * 3
        node.destroy_node()

    def test_timer_callback_can_be_a_closure(self, node):
        i, events = 0, []

        def timer_callback():
            nonlocal i
            i += 1
            events.append(i)
            if i == 3:
                rclpy.shutdown()

        node.create_timer(0.005, timer_callback)
        rclpy.spin(node)
        assert events == [1, 2, 3]
        assert not rclpy.ok()

    def test_service_returns_response_to_client(self, ros):
        class MinimalService(Node):
            def __init__(self):
                super().__init__("minimal_service")
                self.srv = self.create_service(AddTwoInts, "add_two_ints", self.add)

            def add(self, request, response):
                response.sum = request.a + request.b
                return response

        class MinimalClient(Node):
            def __init__(self):
                super().__init__("minimal_client")
                self.cli = self.create_client(AddTwoInts, "add_two_ints")
                while not self.cli.wait_for_service(timeout_sec=TIMEOUT_S):
                    self.get_logger().info("service not available, waiting again...")
                self.req = AddTwoInts.Request()

            def send_request(self):
                self.req.a, self.req.b = 41, 1
                self.future = self.cli.call_async(self.req)

        service, client = MinimalService(), MinimalClient()

        def serve():
            with suppress(ExternalShutdownException):  # raised in a waiting executor, as by rclpy
                rclpy.spin(service, executor=SingleThreadedExecutor())

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        client.send_request()
        rclpy.spin_until_future_complete(client, client.future)
        assert client.future.result().sum == 42
        rclpy.shutdown()
        thread.join(TIMEOUT_S)
        assert not thread.is_alive()

    def test_synchronous_call_works_beside_spinning_thread(self, node):
        node.create_service(AddTwoInts, "add", _add_two_ints)
        client = node.create_client(AddTwoInts, "add")
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        thread = threading.Thread(target=executor.spin, daemon=True)
        thread.start()
        assert client.call(AddTwoInts.Request(a=1, b=2), timeout_sec=TIMEOUT_S).sum == 3
        executor.shutdown()
        thread.join(TIMEOUT_S)

    def test_synchronous_call_works_in_callback_of_reentrant_group(self, node):
        responses = []
        node.create_service(AddTwoInts, "add", _add_two_ints)
        client = node.create_client(AddTwoInts, "add", callback_group=ReentrantCallbackGroup())

        def ask():
            responses.append(client.call(AddTwoInts.Request(a=2, b=3)).sum)
            timer.cancel()

        timer = node.create_timer(0.01, ask, callback_group=MutuallyExclusiveCallbackGroup())
        executor = MultiThreadedExecutor(3)
        executor.add_node(node)
        end = time.monotonic() + TIMEOUT_S
        while not responses and time.monotonic() < end:
            executor.spin_once(timeout_sec=0.1)
        executor.shutdown()
        assert responses == [5]

    def test_deadlocking_call_raises_runtime_error(self, node):
        node.create_service(AddTwoInts, "add", _add_two_ints)
        client = node.create_client(AddTwoInts, "add")
        node.create_timer(0.01, lambda: client.call(AddTwoInts.Request()))
        with pytest.raises(RuntimeError, match="call_async"):
            rclpy.spin_once(node, timeout_sec=TIMEOUT_S)

    def test_coroutine_awaits_service_call(self, node):
        responses = []
        node.create_service(AddTwoInts, "add", _add_two_ints)
        client = node.create_client(AddTwoInts, "add")

        async def ask():
            timer.cancel()
            response = await client.call_async(AddTwoInts.Request(a=3, b=4))
            responses.append(response.sum)

        timer = node.create_timer(0.01, ask, callback_group=ReentrantCallbackGroup())
        end = time.monotonic() + TIMEOUT_S
        while not responses and time.monotonic() < end:
            rclpy.spin_once(node, timeout_sec=0.1)
        assert responses == [7]

    def test_service_callback_can_be_a_coroutine(self, node):
        async def multiply(request, response):
            response.sum = request.a * request.b
            return response

        node.create_service(AddTwoInts, "multiply", multiply)
        future = node.create_client(AddTwoInts, "multiply").call_async(AddTwoInts.Request(a=6, b=7))
        rclpy.spin_until_future_complete(node, future, timeout_sec=TIMEOUT_S)
        assert future.result().sum == 42

    def test_done_callbacks_run_in_executor(self, node):
        events = []
        node.create_service(AddTwoInts, "add", _add_two_ints)
        future = node.create_client(AddTwoInts, "add").call_async(AddTwoInts.Request(a=1, b=1))
        future.add_done_callback(lambda future: events.append(future.result().sum))
        end = time.monotonic() + TIMEOUT_S
        while not events and time.monotonic() < end:
            rclpy.spin_once(node, timeout_sec=0.1)
        assert events == [2]

    def test_two_nodes_share_multithreaded_executor(self, ros):
        talker, listener = Counter(), Listener(3)
        with MultiThreadedExecutor(num_threads=4) as executor:
            executor.add_node(talker)
            executor.add_node(listener)
            executor.spin_until_future_complete(listener.finished, timeout_sec=TIMEOUT_S)
        assert len(listener.heard) >= 3

    def test_guard_condition_calls_callback(self, node):
        called = []
        guard_condition = node.create_guard_condition(lambda: called.append(1))
        guard_condition.trigger()
        rclpy.spin_once(node, timeout_sec=TIMEOUT_S)
        assert called == [1]
        assert node.destroy_guard_condition(guard_condition)

    def test_rate_sleeps_beside_spinning_thread(self, node):
        thread = threading.Thread(target=rclpy.spin, args=(node,), daemon=True)
        thread.start()
        rate = node.create_rate(50)
        start = time.monotonic()
        for _ in range(5):
            rate.sleep()
        assert time.monotonic() - start >= 0.08
        rclpy.shutdown()
        thread.join(TIMEOUT_S)
        assert not thread.is_alive()


class TestNode:
    def test_names_are_resolved_in_namespace(self, node):
        assert node.get_name() == "tested"
        assert node.get_namespace() == "/ns"
        assert node.get_fully_qualified_name() == "/ns/tested"
        assert node.get_logger().name == "ns.tested"
        assert node.resolve_topic_name("chatter") == "/ns/chatter"
        assert node.resolve_topic_name("~/chatter") == "/ns/tested/chatter"
        assert node.resolve_service_name("/add") == "/add"

    def test_invalid_node_names_are_rejected(self, ros):
        with pytest.raises(InvalidNodeNameException, match="must not contain characters"):
            rclpy.create_node("bad?")
        with pytest.raises(InvalidNamespaceException, match="must not contain characters"):
            rclpy.create_node("good", namespace="/bad?")

    def test_invalid_topic_and_service_names_are_rejected(self, node):
        with pytest.raises(InvalidTopicNameException, match="must not contain characters"):
            node.create_publisher(String, "chatter?", 1)
        with pytest.raises(InvalidTopicNameException, match="must not start with a number"):
            node.create_subscription(String, "/chatter/42", print, 1)
        with pytest.raises(InvalidServiceNameException, match="must not contain characters"):
            node.create_client(AddTwoInts, "add?")
        with pytest.raises(InvalidServiceNameException, match="must not start with a number"):
            node.create_service(AddTwoInts, "/add/2", print)

    def test_qos_must_be_profile_or_depth(self, node):
        node.create_publisher(String, "chatter", qos_profile_sensor_data)
        with pytest.raises(TypeError, match="Expected QoSProfile or int"):
            node.create_publisher(String, "chatter", "best")
        with pytest.raises(ValueError, match="greater than or equal to zero"):
            node.create_publisher(String, "chatter", -1)

    def test_invalid_message_types_are_rejected(self, node):
        with pytest.raises(AttributeError, match="not an interface class"):
            node.create_publisher(int, "chatter", 1)
        with pytest.raises(RuntimeError, match="might be a service"):
            node.create_publisher(AddTwoInts, "chatter", 1)

    def test_publishing_another_type_is_rejected(self, node):
        with pytest.raises(TypeError):
            node.create_publisher(String, "chatter", 1).publish(Int64())

    def test_node_requires_init(self):
        with pytest.raises(NotInitializedException, match=r"rclpy.init\(\) has not been called"):
            rclpy.create_node("early", context=rclpy.context.Context())

    def test_entities_are_listed_and_destroyed(self, node):
        publisher = node.create_publisher(String, "chatter", 1)
        assert publisher in list(node.publishers)
        assert len(list(node.publishers)) == 2  # the other one is for /parameter_events
        subscription = node.create_subscription(String, "chatter", print, 1)
        assert list(node.subscriptions) == [subscription]
        timer = node.create_timer(1.0, None)
        assert list(node.timers) == [timer]
        assert node.destroy_publisher(publisher) is True
        assert node.destroy_publisher(publisher) is False
        assert node.destroy_subscription(subscription) is True
        assert node.destroy_timer(timer) is True
        node.destroy_node()
        assert list(node.publishers) == []

    def test_subclass_attributes_may_shadow_internal_names(self, ros):
        class Planner(Node):
            def __init__(self):
                super().__init__("planner")
                self.graph, self.parameters, self.parts, self.bus, self.identity = {}, {}, [], None, 7
                self.dispatcher = self.entities = self.timebase = self.cleanups = self.parameter_names = None
                self._handle = self._dispatcher = self._parameters = self._entities = self._remappings = None

        class Router(Node):
            def graph(self):
                return "mine"

        assert Router("router").graph() == "mine"
        texts = []
        node = Planner()
        node.declare_parameter("speed", 1.0)
        node.create_subscription(String, "topic", texts.append, 10)
        publisher = node.create_publisher(String, "topic", 10)
        timer = node.create_timer(0.001, lambda: publisher.publish(String(data="hi")))
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        while not texts:
            executor.spin_once(timeout_sec=TIMEOUT_S)
        node.destroy_timer(timer)
        assert node.count_subscribers("topic") == 1
        assert node.get_parameter("speed").value == 1.0
        assert node.graph == {}
        node.destroy_node()
        executor.shutdown()

    def test_destroy_node_can_be_called_twice(self, node):
        node.destroy_node()
        node.destroy_node()

    @pytest.mark.parametrize(
        "make",
        [
            lambda node: node.create_publisher(String, "chatter", 1),
            lambda node: node.create_subscription(String, "chatter", print, 1),
            lambda node: node.create_client(Trigger, "trigger"),
            lambda node: node.create_service(Trigger, "trigger", print),
        ],
    )
    def test_destroyed_node_creates_nothing(self, node, make):
        node.destroy_node()
        with pytest.raises(InvalidHandle, match="destruction was requested"):
            make(node)

    def test_handle_of_destroyed_entity_is_invalid(self, node):
        subscription = node.create_subscription(String, "chatter", print, 1)
        with subscription.handle:
            pass
        node.destroy_subscription(subscription)
        with pytest.raises(InvalidHandle), subscription.handle:
            pass
        with node.handle:
            node.destroy_node()
            with node.handle:
                pass
        with pytest.raises(InvalidHandle), node.handle:
            pass

    def test_executor_attribute_can_be_set(self, node):
        first, second = SingleThreadedExecutor(), SingleThreadedExecutor()
        assert node.executor is None
        node.executor = first
        assert node.executor is first
        assert first.get_nodes() == [node]
        assert second.add_node(node)
        assert node.executor is second
        assert first.get_nodes() == []
        node.executor = None
        assert node.executor is None
        assert second.get_nodes() == []

    def test_graph_queries_return_names_types_and_endpoints(self, node):
        node.create_publisher(String, "chatter", QoSProfile(depth=3, reliability=QoSReliabilityPolicy.BEST_EFFORT))
        assert node.count_publishers("chatter") == 1
        assert ("/ns/chatter", ["std_msgs/msg/String"]) in node.get_topic_names_and_types()
        assert ("tested", "/ns") in node.get_node_names_and_namespaces()
        info = node.get_publishers_info_by_topic("/ns/chatter")[0]
        assert (info.node_name, info.topic_type) == ("tested", "std_msgs/msg/String")
        assert info.qos_profile.reliability == QoSReliabilityPolicy.BEST_EFFORT
        assert node.get_subscriptions_info_by_topic("/ns/chatter") == []
        services = [name for name, _ in node.get_service_names_and_types_by_node("tested", "/ns")]
        assert "/ns/tested/get_parameters" in services

    def test_callback_receives_message_info(self, node):
        deliveries = []
        node.create_subscription(String, "chatter", lambda msg, info: deliveries.append((msg.data, info)), 1)
        node.create_publisher(String, "chatter", 1).publish(String(data="x"))
        rclpy.spin_once(node, timeout_sec=TIMEOUT_S)
        assert deliveries[0][0] == "x"
        assert deliveries[0][1].source_timestamp > 0

    def test_raw_subscription_receives_bytes(self, node):
        payloads = []
        node.create_subscription(String, "chatter", payloads.append, 1, raw=True)
        node.create_publisher(String, "chatter", 1).publish(String(data="x"))
        rclpy.spin_once(node, timeout_sec=TIMEOUT_S)
        assert payloads == [b"\x00\x01\x00\x00\x02\x00\x00\x00x\x00"]

    def test_late_subscription_receives_latched_message(self, node):
        texts = []
        profile = QoSProfile(depth=1, durability=QoSDurabilityPolicy.TRANSIENT_LOCAL)
        node.create_publisher(String, "latched", profile).publish(String(data="kept"))
        node.create_subscription(String, "latched", lambda msg: texts.append(msg.data), profile)
        rclpy.spin_once(node, timeout_sec=TIMEOUT_S)
        assert texts == ["kept"]

    def test_nodes_and_publishers_are_context_managers(self, ros):
        with rclpy.create_node("managed") as node, node.create_publisher(String, "chatter", 1):
            assert node.count_publishers("chatter") == 1
        with pytest.raises(InvalidHandle), node.handle:
            pass

    def test_log_messages_are_published_on_rosout(self, node):
        from rcl_interfaces.msg import Log

        messages = []
        node.create_subscription(Log, "/rosout", messages.append, 10)
        node.get_logger().warning("careful")
        rclpy.spin_once(node, timeout_sec=TIMEOUT_S)
        assert (messages[0].name, messages[0].msg, messages[0].level) == ("ns.tested", "careful", logging.WARNING)
        assert messages[0].file == __file__

    def test_deprecated_policy_names_warn(self):
        with pytest.warns(UserWarning, match="Use ReliabilityPolicy.BEST_EFFORT instead"):
            assert QoSReliabilityPolicy.RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT is QoSReliabilityPolicy.BEST_EFFORT


class TestParameters:
    def test_parameter_is_declared_read_and_set(self, node):
        assert node.declare_parameter("speed", 1.5).value == 1.5
        assert node.get_parameter("speed").get_parameter_value().double_value == 1.5
        results = node.set_parameters([Parameter("speed", Parameter.Type.DOUBLE, 2.5)])
        assert isinstance(results[0], SetParametersResult)
        assert results[0].successful
        assert node.get_parameter("speed").value == 2.5
        with pytest.raises(ParameterAlreadyDeclaredException):
            node.declare_parameter("speed", 1.0)
        with pytest.raises(ParameterNotDeclaredException):
            node.get_parameter("height")
        assert node.get_parameter_or("height", Parameter("height", value=3)).value == 3

    def test_descriptor_makes_parameter_read_only(self, node):
        node.declare_parameter("speed", 1.5, ParameterDescriptor(description="how fast", read_only=True))
        assert node.describe_parameter("speed").description == "how fast"
        assert not node.set_parameters([Parameter("speed", value=2.5)])[0].successful

    def test_on_set_callback_can_reject(self, node):
        def check(parameters):
            return SetParametersResult(
                successful=all(parameter.value < 10 for parameter in parameters), reason="too fast"
            )

        node.declare_parameter("speed", 1)
        node.add_on_set_parameters_callback(check)
        result = node.set_parameters([Parameter("speed", value=20)])[0]
        assert (result.successful, result.reason) == (False, "too fast")
        node.remove_on_set_parameters_callback(check)
        assert node.set_parameters([Parameter("speed", value=20)])[0].successful

    def test_overrides_from_constructor_and_command_line_are_applied(self, ros):
        node = rclpy.create_node(
            "parametrized",
            namespace="/ns",
            parameter_overrides=[Parameter("mine", value=1)],
            cli_args=["--ros-args", "-p", "mine:=2", "-p", "theirs:=3", "-r", "__ns:=/other", "-r", "chatter:=news"],
        )
        assert node.declare_parameter("mine", 0).value == 1
        assert node.declare_parameter("theirs", 0).value == 3
        assert node.get_namespace() == "/other"
        assert node.resolve_topic_name("chatter") == "/other/news"

    def test_undeclared_parameters_can_be_allowed(self, ros):
        node = rclpy.create_node(
            "free",
            allow_undeclared_parameters=True,
            automatically_declare_parameters_from_overrides=True,
            parameter_overrides=[Parameter("known", value="x")],
        )
        assert node.get_parameter("known").value == "x"
        assert node.get_parameter("unknown").value is None
        node.set_parameters([Parameter("new", value=True)])
        assert node.get_parameter("new").value is True

    def test_qos_overrides_from_parameters_are_applied(self, ros):
        from rclpy.qos_overriding_options import QoSOverridingOptions

        node = rclpy.create_node(
            "overridden", parameter_overrides=[Parameter("qos_overrides./chatter.publisher.depth", value=7)]
        )
        publisher = node.create_publisher(
            String, "chatter", 1, qos_overriding_options=QoSOverridingOptions.with_default_policies()
        )
        assert publisher.qos_profile.depth == 7


def _add_two_ints(request, response):
    response.sum = request.a + request.b
    return response
