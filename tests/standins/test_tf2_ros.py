"""Transforms as nodes use them.

The tests cover broadcasters, listeners, buffers, transformed messages, a buffer server's clients.
"""

from __future__ import annotations

import math
import subprocess
import threading

import pytest
import rclpy
import tf2_geometry_msgs
import tf2_py
import tf2_ros
from geometry_msgs.msg import PointStamped, PoseStamped, TransformStamped, Twist, Vector3Stamped
from rclpy.duration import Duration
from rclpy.exceptions import InvalidHandle
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from tf2_msgs.action import LookupTransform
from tf2_msgs.msg import TF2Error
from tf2_ros import Buffer, StaticTransformBroadcaster, TransformBroadcaster, TransformListener
from tf_transformations import euler_from_quaternion, quaternion_from_euler

from linkwright.standins import process
from tests.waiting import wait_until


@pytest.fixture(autouse=True)
def _ros(monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    rclpy.init(args=[])
    yield
    rclpy.try_shutdown()


@pytest.fixture
def node():
    return rclpy.create_node("tested")


def make_transform(parent, child, stamp, x=1.0, yaw=0.0):
    message = TransformStamped()
    message.header.frame_id, message.child_frame_id = parent, child
    message.header.stamp = stamp.to_msg()
    message.transform.translation.x = x
    rotation = message.transform.rotation
    rotation.x, rotation.y, rotation.z, rotation.w = quaternion_from_euler(0, 0, yaw)
    return message


def spin_node(node, times=6):
    for _ in range(times):
        rclpy.spin_once(node, timeout_sec=0.01)


class FramePublisher(Node):
    """Publishes the pose of a turtle as a transform."""

    def __init__(self):
        super().__init__("turtle_tf2_frame_publisher")
        self.turtlename = self.declare_parameter("turtlename", "turtle").get_parameter_value().string_value
        self.tf_broadcaster = TransformBroadcaster(self)
        self.timer = self.create_timer(0.01, self.handle_pose)

    def handle_pose(self):
        self.tf_broadcaster.sendTransform(
            make_transform("world", self.turtlename, self.get_clock().now(), 2.0, math.pi / 2)
        )


class FrameListener(Node):
    """Looks up the transforms of a turtle."""

    def __init__(self):
        super().__init__("turtle_tf2_frame_listener")
        self.target_frame = self.declare_parameter("target_frame", "turtle").get_parameter_value().string_value
        self.tf_buffer = Buffer()
        self.tf_listener = TransformListener(self.tf_buffer, self)
        self.commands, self.misses, self.finished = [], [], rclpy.task.Future()
        self.timer = self.create_timer(0.01, self.on_timer)

    def on_timer(self):
        try:
            transform = self.tf_buffer.lookup_transform("world", self.target_frame, rclpy.time.Time())
        except tf2_ros.TransformException as error:
            self.misses.append(str(error))
            return
        command = Twist()
        command.linear.x = math.hypot(transform.transform.translation.x, transform.transform.translation.y)
        rotation = transform.transform.rotation
        command.angular.z = euler_from_quaternion([rotation.x, rotation.y, rotation.z, rotation.w])[2]
        self.commands.append(command)
        self.finished.set_result(None)


class TestTopics:
    def test_turtle_tf2_example_runs(self):
        executor = SingleThreadedExecutor()
        listener, publisher = FrameListener(), FramePublisher()
        executor.add_node(listener)
        executor.add_node(publisher)
        executor.spin_until_future_complete(listener.finished, timeout_sec=60.0)
        assert listener.commands[0].linear.x == pytest.approx(2.0)
        assert listener.commands[0].angular.z == pytest.approx(math.pi / 2)
        assert all('"world" passed to lookupTransform' in miss for miss in listener.misses)

    def test_late_listener_receives_static_transforms(self, node):
        broadcaster = StaticTransformBroadcaster(node)
        broadcaster.sendTransform(make_transform("base", "laser", Time()))
        broadcaster.sendTransform(make_transform("base", "camera", Time()))
        buffer = Buffer()
        TransformListener(buffer, node)
        spin_node(node)
        for frame in ("laser", "camera"):
            assert buffer.lookup_transform("base", frame, Time()).transform.translation.x == 1.0

    def test_listener_with_own_thread_receives_transforms(self, node):
        buffer = Buffer()
        listener = TransformListener(buffer, node, spin_thread=True)
        TransformBroadcaster(rclpy.create_node("other")).sendTransform(make_transform("a", "b", Time(seconds=5)))
        assert buffer.can_transform("a", "b", Time(), timeout=Duration(seconds=2.0))
        before = threading.active_count()
        listener.unregister()
        assert threading.active_count() == before - 1

    def test_lookup_waits_in_callback_of_same_node(self, node):
        """The listener's callbacks are in a reentrant group.

        A second thread processes them during the wait.
        """
        buffer, transforms = Buffer(), []
        TransformListener(buffer, node)
        broadcaster = TransformBroadcaster(node)

        def look():
            timer.cancel()
            threading.Timer(0.05, broadcaster.sendTransform, [make_transform("a", "b", Time(seconds=5))]).start()
            transforms.append(buffer.lookup_transform("a", "b", Time(), timeout=Duration(seconds=2.0)))

        timer = node.create_timer(0.01, look)
        with MultiThreadedExecutor(2) as executor:
            executor.add_node(node)
            thread = threading.Thread(target=executor.spin, daemon=True)
            thread.start()
            wait_until(lambda: transforms)
            executor.shutdown()
            thread.join(60.0)
        assert transforms[0].transform.translation.x == 1.0

    def test_lookup_is_awaited_in_coroutine(self, node):
        buffer, transforms = Buffer(), []
        TransformListener(buffer, node)

        async def look():
            timer.cancel()
            transforms.append(await buffer.lookup_transform_async("a", "b", Time()))

        timer = node.create_timer(0.01, look)
        spin_node(node)
        assert transforms == []
        TransformBroadcaster(node).sendTransform(make_transform("a", "b", Time(seconds=5)))
        spin_node(node)
        assert transforms[0].child_frame_id == "b"


class TestBuffer:
    def test_lookup_errors_have_specific_exceptions(self):
        buffer = Buffer()
        buffer.set_transform(make_transform("a", "b", Time(seconds=5)), "test")
        buffer.set_transform(make_transform("x", "y", Time(seconds=5)), "test")
        with pytest.raises(tf2_ros.LookupException, match="does not exist"):
            buffer.lookup_transform("a", "nowhere", Time())
        with pytest.raises(tf2_ros.ConnectivityException, match="not part of the same tree"):
            buffer.lookup_transform("a", "y", Time())
        with pytest.raises(tf2_ros.ExtrapolationException):
            buffer.lookup_transform("a", "b", Time(seconds=100))
        with pytest.raises(tf2_ros.InvalidArgumentException):
            buffer.lookup_transform("/a", "b", Time())
        assert issubclass(tf2_py.LookupException, tf2_ros.TransformException)

    def test_message_stamp_is_accepted_as_time(self):
        buffer = Buffer()
        message = make_transform("a", "b", Time(seconds=5))
        assert buffer.set_transform(message, "test") is None
        assert buffer.lookup_transform("a", "b", message.header.stamp).header.stamp.sec == 5

    def test_messages_are_transformed_to_other_frames(self):
        assert tf2_geometry_msgs.do_transform_point is not None
        buffer = Buffer()
        buffer.set_transform(make_transform("map", "base", Time(seconds=5), 1.0, math.pi / 2), "test")
        point = PointStamped()
        point.header.frame_id, point.header.stamp = "base", Time(seconds=5).to_msg()
        point.point.x = 2.0
        moved = buffer.transform(point, "map")
        assert (moved.header.frame_id, moved.point.x, moved.point.y) == ("map", pytest.approx(1.0), pytest.approx(2.0))
        pose = PoseStamped(header=point.header)
        pose.pose.orientation.w = 1.0
        assert buffer.transform(pose, "map").pose.orientation.z == pytest.approx(math.sqrt(0.5))
        vector = Vector3Stamped(header=point.header)
        vector.vector.x = 1.0
        assert buffer.transform(vector, "map").vector.y == pytest.approx(1.0)
        assert buffer.transform(point, "map", new_type=PointStamped) == moved
        assert buffer.transform_full(point, "map", Time(seconds=5), "map") == moved

    def test_unregistered_types_are_rejected(self):
        with pytest.raises(tf2_ros.TypeException, match="not loaded or supported"):
            Buffer().transform(Twist(), "map")
        with pytest.raises(tf2_ros.NotImplementedException):
            tf2_ros.BufferInterface().lookup_transform("a", "b", Time())

    def test_convert_uses_registered_conversions(self):
        class Own:
            def __init__(self, x):
                self.x = x

        registration = tf2_ros.ConvertRegistration()
        registration.add_from_msg(Own, lambda message: Own(message.point.x))
        point = PointStamped()
        point.point.x = 3.0
        assert tf2_ros.convert(point, Own).x == 3.0
        registration.add_convert((PointStamped, Own), lambda _message: Own(7.0))
        assert tf2_ros.convert(point, Own).x == 7.0
        copied = tf2_ros.convert(point, PointStamped)
        assert copied == point
        assert copied is not point
        assert tf2_ros.Stamped(Own(1), Time(seconds=2).to_msg(), "map").header.frame_id == "map"


class TestClient:
    @pytest.fixture
    def client(self, node):
        """Return a client of a buffer server that knows one transform."""
        buffer = tf2_ros.BufferCore()
        buffer.set_transform_static(make_transform("a", "b", Time()), "test")

        def response(handle):
            result = LookupTransform.Result()
            goal = handle.request
            try:
                result.transform = buffer.lookup_transform_core(
                    goal.target_frame, goal.source_frame, Time.from_msg(goal.source_time)
                )
            except tf2_ros.LookupException as error:
                result.error.error, result.error.error_string = TF2Error.LOOKUP_ERROR, str(error)
            handle.succeed()
            return result

        rclpy.action.ActionServer(node, LookupTransform, "lookup", response)
        executor = MultiThreadedExecutor(2)
        executor.add_node(node)
        thread = threading.Thread(target=executor.spin, daemon=True)
        thread.start()
        yield tf2_ros.BufferClient(node, "lookup", timeout_padding=1.0)
        executor.shutdown()
        thread.join(60.0)

    def test_buffer_client_looks_up_transform(self, client):
        assert client.lookup_transform("a", "b", Time()).transform.translation.x == 1.0
        assert client.can_transform("a", "b", Time())

    def test_buffer_client_raises_lookup_error(self, client):
        with pytest.raises(tf2_ros.LookupException, match="does not exist"):
            client.lookup_transform("a", "nowhere", Time())
        assert not client.can_transform("a", "nowhere", Time())

    def test_buffer_client_times_out_without_server(self, node):
        with pytest.raises(tf2_ros.TimeoutException, match="not ready"):
            tf2_ros.BufferClient(node, "nowhere").lookup_transform("a", "b", Time())

    def test_destroyed_buffer_client_is_invalid(self, node):
        client = tf2_ros.BufferClient(node, "nowhere")
        client.destroy()
        with pytest.raises(InvalidHandle):
            client.can_transform("a", "b", Time())


@pytest.mark.parametrize(
    ("package", "type_name"),
    [
        ("tf2_geometry_msgs", "geometry_msgs.msg.PointStamped"),
        ("tf2_geometry_msgs.tf2_geometry_msgs", "geometry_msgs.msg.WrenchStamped"),
        ("tf2_sensor_msgs", "sensor_msgs.msg.PointCloud2"),
    ],
)
def test_importing_conversion_package_registers_types(package, type_name):
    """The import alone registers the types with all buffers."""
    module, _, name = type_name.rpartition(".")
    program = (
        f"import {package}, tf2_ros\nfrom {module} import {name}\nprint(tf2_ros.TransformRegistration().get({name}))"
    )
    command = process.python_command(["-c", program])
    result = subprocess.run(command, env=process.create_environment(), capture_output=True, text=True, check=True)
    assert "do_transform_" in result.stdout
