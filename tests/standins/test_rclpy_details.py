"""Details of rclpy on which its own tests and careful programs depend."""

from __future__ import annotations

import functools
import subprocess
import sys
from unittest import mock

import pytest
import rclpy
import rclpy.exceptions
import rclpy.executors
from rcl_interfaces.msg import ParameterEvent, SetParametersResult
from rclpy.action import ActionClient, ActionServer
from rclpy.clock import Clock, ClockChange, ClockType, JumpThreshold, ROSClock
from rclpy.context import Context
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, QoSPublisherEventType, SubscriptionEventCallbacks
from rclpy.exceptions import (
    InvalidParameterException,
    InvalidServiceNameException,
    InvalidTopicNameException,
    NotInitializedException,
)
from rclpy.lifecycle import LifecycleNode, TransitionCallbackReturn
from rclpy.parameter import Parameter, get_parameter_value
from rclpy.parameter_event_handler import ParameterEventHandler
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.qos_overriding_options import (
    InvalidQosOverridesError,
    QosCallbackResult,
    QoSOverridingOptions,
    _declare_qos_parameters,
)
from rclpy.service_introspection import ServiceIntrospectionState
from rclpy.subscription import Subscription
from rclpy.time import Time
from rclpy.time_source import CLOCK_TOPIC, TimeSource
from rclpy.timer import TimerInfo
from rclpy.topic_endpoint_info import TopicEndpointInfo, TopicEndpointTypeEnum
from rclpy.validate_parameter_name import validate_parameter_name
from rclpy.waitable import NumberOfEntities
from rosgraph_msgs.msg import Clock as ClockMessage
from std_msgs.msg import String
from std_srvs.srv import Empty
from test_msgs.action import Fibonacci

from linkwright.standins import process


@pytest.fixture(autouse=True)
def ros(monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    rclpy.init(args=[])
    yield
    rclpy.try_shutdown()


@pytest.fixture
def node():
    return rclpy.create_node("node", namespace="/ns")


class TestInvalidArguments:
    def test_invalid_names_raise_value_errors(self, node):
        with pytest.raises(ValueError, match="unknown substitution") as topic:
            node.create_publisher(String, "topic/{what}", 10)
        assert isinstance(topic.value, InvalidTopicNameException)
        with pytest.raises(ValueError, match="must not contain characters") as service:
            node.create_client(Empty, "what?")
        assert isinstance(service.value, InvalidServiceNameException)
        error = InvalidTopicNameException("42", error_msg="starts with a number", invalid_index=0)
        assert (error.name, error.error_msg, error.invalid_index) == ("42", "starts with a number", 0)

    @pytest.mark.parametrize(
        "question",
        [
            "count_publishers",
            "count_subscribers",
            "count_clients",
            "count_services",
            "get_publishers_info_by_topic",
            "get_subscriptions_info_by_topic",
        ],
    )
    def test_graph_queries_reject_invalid_names(self, node, question):
        with pytest.raises(TypeError, match="bad argument type for built-in operation"):
            getattr(node, question)(1)
        with pytest.raises(ValueError, match="is invalid"):
            getattr(node, question)("42")

    def test_invalid_declarations_are_rejected(self, node):
        with pytest.raises(TypeError, match="is not a str"):
            node.declare_parameter(1, "value")
        with pytest.raises(TypeError, match="is not a ParameterDescriptor"):
            node.declare_parameter("name", 1, "descriptor")
        assert node.declare_parameter("name", 1, None).value == 1

    def test_parameter_names_are_validated(self):
        assert validate_parameter_name("a.b") is True
        with pytest.raises(InvalidParameterException):
            validate_parameter_name("")


class TestParameters:
    def test_parameter_callbacks_are_added_and_removed(self, node):
        def callback(_):
            return SetParametersResult(successful=True)

        for kind in ("pre_set", "on_set", "post_set"):
            getattr(node, f"add_{kind}_parameters_callback")(callback)
            assert callback in getattr(node, f"_{kind}_parameters_callbacks")
            getattr(node, f"remove_{kind}_parameters_callback")(callback)
            assert callback not in getattr(node, f"_{kind}_parameters_callbacks")
        assert node._parameters_callbacks == node._on_set_parameters_callbacks

    def test_blank_strings_stay_unchanged(self):
        assert [get_parameter_value(text).string_value for text in ("", " ")] == ["", " "]

    def test_parameter_event_handler_calls_matching_callbacks(self, node):
        handler, received = ParameterEventHandler(node), []
        first = handler.add_parameter_callback("a", "", lambda parameter: received.append(("first", parameter.name)))
        handler.add_parameter_callback("a", "node", lambda parameter: received.append(("second", parameter.name)))
        event_handle = handler.add_parameter_event_callback(lambda event: received.append(("event", event.node)))
        assert set(handler._callbacks.parameter_callbacks) == {("a", "/ns/node")}
        event = ParameterEvent(node="/ns/node", new_parameters=[Parameter("a", value=1).to_parameter_msg()])
        handler._callbacks.event_callback(event)
        assert received == [("second", "a"), ("first", "a"), ("event", "/ns/node")]
        handler.remove_parameter_callback(first)
        handler.remove_parameter_event_callback(event_handle)
        with pytest.raises(RuntimeError, match="doesn't exist"):
            handler.remove_parameter_callback(first)
        with pytest.raises(RuntimeError, match="doesn't exist"):
            handler.remove_parameter_event_callback(event_handle)

    @pytest.mark.parametrize("accepts", [True, False])
    def test_qos_override_callback_can_reject(self, node, accepts):
        def verdict(_):
            result = QosCallbackResult()
            result.successful, result.reason = accepts, "too deep"
            return result

        options = QoSOverridingOptions.with_default_policies(callback=verdict)
        if accepts:
            node.create_publisher(String, "topic", 10, qos_overriding_options=options)
            return
        with pytest.raises(InvalidQosOverridesError, match="are not valid: too deep"):
            node.create_publisher(String, "topic", 10, qos_overriding_options=options)

    @pytest.mark.parametrize(("kind", "word"), [(Publisher, "publisher"), (Subscription, "subscription")])
    def test_qos_override_parameters_are_declared(self, kind, word):
        node = rclpy.create_node("n", parameter_overrides=[Parameter(f"qos_overrides./topic.{word}.depth", value=3)])
        profile = QoSProfile(depth=10)
        _declare_qos_parameters(kind, node, "/topic", profile, QoSOverridingOptions.with_default_policies())
        declared = node.get_parameters_by_prefix("qos_overrides")
        assert {name: parameter.value for name, parameter in declared.items()} == {
            f"/topic.{word}.depth": 3,
            f"/topic.{word}.history": "keep_last",
            f"/topic.{word}.reliability": "reliable",
        }
        assert profile.depth == 3


class TestTime:
    def test_timer_info_has_call_times(self):
        info = TimerInfo()
        assert (info.expected_call_time.nanoseconds, info.actual_call_time.clock_type) == (0, ClockType.SYSTEM_TIME)
        info = TimerInfo(expected_call_time=1, actual_call_time=2, clock_type=ClockType.STEADY_TIME)
        assert info.actual_call_time == Time(nanoseconds=2, clock_type=ClockType.STEADY_TIME)
        with pytest.raises(AttributeError):
            info.expected_call_time = Time()

    @pytest.mark.parametrize("wrapped", [lambda callback: callback, functools.partial])
    def test_timer_callback_receives_timer_info(self, node, wrapped):
        messages = []

        def callback(info: TimerInfo) -> None:
            messages.append(info)

        with node.create_timer(0.001, wrapped(callback)) as timer:
            rclpy.spin_once(node, timeout_sec=60)
            assert messages[0].expected_call_time.clock_type == timer.clock.clock_type
        assert timer not in node.timers

    def test_sleep_for_requires_initialized_context(self, node):
        with pytest.raises(NotInitializedException):
            Clock().sleep_for(Duration(seconds=60), context=Context())
        clock = node.get_clock()
        rclpy.shutdown()
        with pytest.raises(NotInitializedException):
            clock.sleep_for(Duration(seconds=60))

    def test_time_source_sets_attached_clocks(self, node):
        source, clock = TimeSource(node=node), ROSClock()
        source.attach_clock(clock)
        assert not clock.ros_time_is_active
        node.set_parameters([Parameter("use_sim_time", value=True)])
        assert source.ros_time_is_active
        assert clock.ros_time_is_active
        jumps = []
        threshold = JumpThreshold(min_forward=None, min_backward=None, on_clock_change=True)
        clock.create_jump_callback(threshold, post_callback=jumps.append)
        publisher = node.create_publisher(ClockMessage, CLOCK_TOPIC, 1)
        publisher.publish(ClockMessage(clock=Time(seconds=3).to_msg()))
        rclpy.spin_once(node, timeout_sec=60)
        late_clock = ROSClock()
        late_clock._set_ros_time_is_active(False)
        source.attach_clock(late_clock)
        assert clock.now() == late_clock.now() == Time(seconds=3, clock_type=ClockType.ROS_TIME)
        node.set_parameters([Parameter("use_sim_time", value=False)])
        assert not late_clock.ros_time_is_active
        assert [jump.clock_change for jump in jumps] == [ClockChange.ROS_TIME_DEACTIVATED]
        assert source._clock_sub is None

    def test_time_source_can_be_attached_to_another_node(self, node):
        source = TimeSource()
        simulated = rclpy.create_node("simulated", parameter_overrides=[Parameter("use_sim_time", value=True)])
        source.attach_node(simulated)
        assert source.ros_time_is_active
        source.attach_node(node)
        assert not source.ros_time_is_active
        assert source._get_node() is node
        simulated.set_parameters([Parameter("use_sim_time", value=False)])
        with pytest.raises(ValueError, match="ROS_TIME"):
            source.attach_clock(Clock(clock_type=ClockType.STEADY_TIME))


class TestLifecycle:
    def test_state_machine_services_follow_communication_interface(self):
        silent = LifecycleNode("silent", enable_communication_interface=False)
        assert silent._state_machine.service_get_state is None
        assert silent._state_machine.current_state == (1, "unconfigured")
        driven = LifecycleNode("driven")
        assert driven._state_machine.service_get_state in driven.services

    def test_lifecycle_publisher_delegates_to_publisher(self):
        node = LifecycleNode("node")
        with mock.patch.object(Publisher, "publish") as publish:
            publisher = node.create_lifecycle_publisher(String, "topic", 10)
            publisher.publish(String())
            publish.assert_not_called()
            assert node.trigger_configure() == TransitionCallbackReturn.SUCCESS
            node.trigger_activate()
            message = String(data="now")
            publisher.publish(message)
            publish.assert_called_with(publisher, message)


def test_action_entities_are_counted(node):
    server = ActionServer(node, Fibonacci, "fibonacci", lambda _: Fibonacci.Result())
    client = ActionClient(node, Fibonacci, "fibonacci")
    assert server.get_num_entities() == NumberOfEntities(num_timers=1, num_services=3)
    assert client.get_num_entities() == NumberOfEntities(2, 0, 0, 3, 0)
    total = server.get_num_entities()
    total += client.get_num_entities()
    assert total == NumberOfEntities(2, 0, 1, 3, 3)


def test_feedback_arrives_before_goal_response(node):
    """With a single thread, rclpy executes the goal and sends feedback first."""
    order = []

    def execute(goal):
        goal.publish_feedback(Fibonacci.Feedback())
        goal.succeed()
        return Fibonacci.Result()

    ActionServer(node, Fibonacci, "fibonacci", execute)
    client = ActionClient(node, Fibonacci, "fibonacci")
    response = client.send_goal_async(Fibonacci.Goal(), feedback_callback=lambda _: order.append("feedback"))
    response.add_done_callback(lambda _: order.append("answer"))
    result = None
    while result is None or not result.done():
        rclpy.spin_once(node, timeout_sec=60)
        if response.done() and result is None:
            result = response.result().get_result_async()
    assert order == ["feedback", "answer"]


def test_topic_endpoint_info_is_printed(node):
    assert str(TopicEndpointInfo()).splitlines()[:5] == [
        "Node name: ",
        "Node namespace: ",
        "Topic type: ",
        "Endpoint type: INVALID",
        "GID: ",
    ]
    node.create_publisher(String, "topic", QoSProfile(depth=7))
    (info,) = node.get_publishers_info_by_topic("topic")
    assert "Endpoint type: PUBLISHER" in str(info)
    assert "  History (Depth): KEEP_LAST (7)" in str(info)
    assert "  Lifespan: Infinite" in str(info)
    described = TopicEndpointInfo(node_name="node", endpoint_type=TopicEndpointTypeEnum.SUBSCRIPTION)
    assert described != TopicEndpointInfo()
    described.node_name, described.endpoint_type = "", TopicEndpointTypeEnum.INVALID
    assert described == TopicEndpointInfo()


def test_first_node_waits_for_network_once(monkeypatch):
    context, waits = Context(), []

    class Joining:
        def wait_until_ready(self, timeout):
            waits.append(timeout)

    monkeypatch.setattr("linkwright.wire.joining.join", lambda *_, **__: Joining())
    rclpy.init(context=context, args=[])
    for _ in range(2):
        rclpy.create_node("node", context=context)
    assert len(waits) == 1
    context.shutdown()


class TestEventHandlers:
    def test_default_event_handler_is_installed_without_callbacks(self, node):
        for endpoint in (node.create_publisher(String, "t", 1), node.create_subscription(String, "t", print, 1)):
            assert [handler.callback for handler in endpoint.event_handlers] == [None]

    def test_event_callbacks_have_one_handler_each(self, node):
        callbacks = PublisherEventCallbacks(deadline=print, matched=print)
        publisher = node.create_publisher(String, "t", 1, event_callbacks=callbacks)
        assert [handler.event_type for handler in publisher.event_handlers] == [
            QoSPublisherEventType.RCL_PUBLISHER_OFFERED_DEADLINE_MISSED,
            QoSPublisherEventType.RCL_PUBLISHER_OFFERED_INCOMPATIBLE_QOS,
            QoSPublisherEventType.RCL_PUBLISHER_MATCHED,
        ]

    def test_default_event_callbacks_can_be_disabled(self, node):
        callbacks = SubscriptionEventCallbacks(use_default_callbacks=False)
        assert node.create_subscription(String, "t", print, 1, event_callbacks=callbacks).event_handlers == []


class TestServiceIntrospection:
    def test_service_events_are_published_by_client_and_service(self, node):
        events = []
        service = node.create_service(Empty, "empty", lambda _request, response: response)
        client = node.create_client(Empty, "empty")
        node.create_subscription(Empty.Event, "empty/_service_event", events.append, 10)
        for endpoint in (service, client):
            endpoint.configure_introspection(node.get_clock(), QoSProfile(depth=10), ServiceIntrospectionState.CONTENTS)
        rclpy.spin_until_future_complete(node, client.call_async(Empty.Request()), timeout_sec=60.0)
        while len(events) < 4:
            rclpy.spin_once(node, timeout_sec=60.0)
        assert {event.info.event_type for event in events} == {0, 1, 2, 3}
        assert [len(event.request) + len(event.response) for event in events] == [1] * 4

    def test_service_event_publisher_is_not_listed_by_node(self, node):
        before = len(list(node.publishers))
        service = node.create_service(Empty, "empty", lambda _request, response: response)
        service.configure_introspection(node.get_clock(), QoSProfile(depth=10), ServiceIntrospectionState.METADATA)
        assert len(list(node.publishers)) == before


def test_exceptions_are_printed_with_rclpy_names():
    output = subprocess.run(
        [sys.executable, "-c", "import rclpy\nrclpy.init()\nrclpy.create_node('a b')"],
        env=process.create_environment() | {"ROS_DOMAIN_ID": "142"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert output.stderr.splitlines()[-1].startswith("rclpy.exceptions.InvalidNodeNameException: 'a b' is not a valid")
    assert repr(rclpy.executors.ExternalShutdownException) == "<class 'rclpy.executors.ExternalShutdownException'>"
    assert repr(rclpy.exceptions.InvalidHandle) == "<class 'rclpy._rclpy_pybind11.InvalidHandle'>"
