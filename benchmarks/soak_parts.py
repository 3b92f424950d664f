"""The processes of the soak, which use rclpy as users' programs do.

Usage: ``python -m benchmarks.soak_parts ROLE``

Each prints a line of JSON every two seconds with what it has seen, and ends with status 0 when it is interrupted.
"""

from __future__ import annotations

import json
import random
import statistics
import sys
import threading
import time
from collections import Counter, deque
from collections.abc import Callable
from typing import Any

import rclpy
from example_interfaces.action import Fibonacci
from example_interfaces.srv import AddTwoInts
from geometry_msgs.msg import TransformStamped
from rclpy.action import ActionClient, ActionServer
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_client import AsyncParameterClient
from rclpy.qos import HistoryPolicy, QoSProfile
from rclpy.time import Time
from std_msgs.msg import Header, String
from tf2_ros import Buffer, TransformBroadcaster, TransformException, TransformListener

RATES_HZ = (1, 50, 1000)
FRAME_COUNT = 50
PHOENIX_TOPIC = "/soak/phoenix"
KEEP_ALL_QOS = QoSProfile(depth=0, history=HistoryPolicy.KEEP_ALL)
RESPONSE_TIMEOUT_S = 10.0
"""The seconds after which a missing response counts as a failure."""


def topic(rate: int) -> str:
    """Return the topic of a rate."""
    return f"/soak/rate_{rate}"


class Part(Node):
    """A node with counters in `seen`, and descriptions of its first failures."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.seen: Counter[str] = Counter()
        self.failures: list[str] = []
        self.create_timer(2.0, self.print_report)

    def print_report(self) -> None:
        """Print a line."""
        print(json.dumps({"seen": self.seen, "failures": self.failures[:5], **self.figures()}), flush=True)

    def figures(self) -> dict[str, Any]:
        """Return further figures to report."""
        return {}

    def record_failure(self, what: str) -> None:
        """Record a failure."""
        self.seen["failures"] += 1
        self.failures.append(what)


class Talker(Part):
    """Publishes numbered messages at several rates, and transforms."""

    def __init__(self) -> None:
        super().__init__("soak_talker")
        for rate in RATES_HZ:
            self.create_timer(1.0 / rate, self._counting(rate))
        self._broadcaster = TransformBroadcaster(self)
        self.create_timer(1.0 / 30.0, self._transforms)

    def _counting(self, rate: int) -> Callable[[], None]:
        name = topic(rate)
        publisher = self.create_publisher(Header, name, KEEP_ALL_QOS)

        def publish() -> None:
            publisher.publish(Header(stamp=self.get_clock().now().to_msg(), frame_id=str(self.seen[name])))
            self.seen[name] += 1

        return publish

    def _transforms(self) -> None:
        stamp = self.get_clock().now().to_msg()
        sent = []
        for number in range(FRAME_COUNT):
            transform = TransformStamped()
            transform.header.stamp, transform.header.frame_id = stamp, f"soak_{number}"
            transform.child_frame_id = f"soak_{number + 1}"
            sent.append(transform)
        self._broadcaster.sendTransform(sent)


class Listener(Part):
    """Subscribes to the topics of the publishers, and looks up transforms."""

    def __init__(self) -> None:
        super().__init__("soak_listener")
        self._next: dict[str, int] = {}
        self._delays: deque[float] = deque(maxlen=2000)
        for rate in RATES_HZ:
            self.create_subscription(Header, topic(rate), self._counting(topic(rate)), KEEP_ALL_QOS)
        self.create_subscription(String, PHOENIX_TOPIC, self._phoenix, 10)
        self._buffer = Buffer()
        self._listener = TransformListener(self._buffer, self)
        self.create_timer(0.1, self._look_up)

    def figures(self) -> dict[str, Any]:
        """Return the latencies since the last call, in milliseconds."""
        delays = sorted(self._delays)
        self._delays.clear()
        if not delays:
            return {}
        return {"median_ms": statistics.median(delays), "p99_ms": delays[int(0.99 * (len(delays) - 1))]}

    def _counting(self, name: str) -> Callable[[Header], None]:
        def receive(message: Header) -> None:
            stamp = message.stamp
            self._delays.append((time.time() - stamp.sec - stamp.nanosec * 1e-9) * 1e3)
            number = int(message.frame_id)
            expected = self._next.get(name, number)
            if number > expected:
                self.seen["lost"] += number - expected
                self.record_failure(f"{name}: {number - expected} lost before {number}")
            elif number < expected:
                self.record_failure(f"{name}: {number} came again, or late, instead of {expected}")
            self._next[name] = number + 1
            self.seen[name] = number + 1

        return receive

    def _phoenix(self, _message: String) -> None:
        self.seen[PHOENIX_TOPIC] += 1

    def _look_up(self) -> None:
        try:
            self._buffer.lookup_transform("soak_0", f"soak_{FRAME_COUNT}", Time())
            self.seen["transforms"] += 1
        except TransformException as error:
            if self.seen["transforms"]:
                self.record_failure(f"transform: {error}")


class Server(Part):
    """Provides a service, an action and parameters."""

    def __init__(self) -> None:
        super().__init__("soak_server")
        self.declare_parameter("speed", 0)
        self.create_service(AddTwoInts, "/soak/add", self._add)
        # By default, results are kept for a quarter of an hour, so memory would be constant only after that time.
        self._action = ActionServer(self, Fibonacci, "/soak/fibonacci", self._execute, result_timeout=10)

    def _add(self, request: Any, response: Any) -> Any:
        response.sum = request.a + request.b
        self.seen["requests"] += 1
        return response

    def _execute(self, goal: Any) -> Any:
        sequence = [0, 1]
        for _ in range(goal.request.order):
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        goal.succeed()
        self.seen["goals"] += 1
        return Fibonacci.Result(sequence=sequence)


class Client(Part):
    """Sends requests in its own thread, and checks each response."""

    def __init__(self) -> None:
        super().__init__("soak_client")
        group = ReentrantCallbackGroup()
        self._add = self.create_client(AddTwoInts, "/soak/add", callback_group=group)
        self._action = ActionClient(self, Fibonacci, "/soak/fibonacci", callback_group=group)
        self._parameters = AsyncParameterClient(self, "soak_server", callback_group=group)
        threading.Thread(target=self._ask, daemon=True).start()

    def _ask(self) -> None:
        while rclpy.ok():
            try:
                self._round()
            except Exception as error:  # noqa: BLE001, PERF203 - any at all is a failure to be told
                if rclpy.ok():
                    self.record_failure(f"{type(error).__name__}: {error}")
                    time.sleep(0.5)

    def _round(self) -> None:
        assert self._add.wait_for_service(60.0)
        assert self._action.wait_for_server(60.0)
        assert self._parameters.wait_for_services(60.0)
        for _ in range(10):
            self._check_sum(random.randrange(1000), random.randrange(1000))
            time.sleep(0.05)
        self._check_action()
        self._check_parameter(self.seen["parameters"])

    @staticmethod
    def _answer(future: Any, what: str) -> Any:
        has_response = threading.Event()
        future.add_done_callback(lambda _: has_response.set())
        if not has_response.wait(RESPONSE_TIMEOUT_S):
            raise TimeoutError(f"no answer: {what}")
        return future.result()

    def _check_sum(self, a: int, b: int) -> None:
        answer = self._answer(self._add.call_async(AddTwoInts.Request(a=a, b=b)), "sum")
        if answer.sum != a + b:
            self.record_failure(f"{a} + {b} gave {answer.sum}")
        self.seen["sums"] += 1

    def _check_action(self) -> None:
        heard: list[Any] = []
        goal = self._answer(self._action.send_goal_async(Fibonacci.Goal(order=5), heard.append), "goal")
        result = self._answer(goal.get_result_async(), "result").result
        if list(result.sequence) != [0, 1, 1, 2, 3, 5, 8]:
            self.record_failure(f"the action gave {list(result.sequence)}")
        self.seen["goals"] += 1

    def _check_parameter(self, number: int) -> None:
        parameter = Parameter("speed", value=number)
        self._answer(self._parameters.set_parameters([parameter]), "set")
        values = self._answer(self._parameters.get_parameters(["speed"]), "get").values
        if values[0].integer_value != number:
            self.record_failure(f"parameter was set to {number} and is {values[0].integer_value}")
        self.seen["parameters"] += 1


class Guests(Part):
    """Creates and destroys nodes that publish and subscribe."""

    def __init__(self) -> None:
        super().__init__("soak_guests")
        self._guests: deque[Node] = deque()
        self.create_timer(2.0, self._come_and_go)

    def _come_and_go(self) -> None:
        guest = rclpy.create_node(f"soak_guest_{self.seen['guests'] % 20}")
        guest.create_subscription(Header, topic(50), lambda _message: None, 10)
        guest.create_publisher(String, "/soak/guests", 10).publish(String(data="hello"))
        guest.create_service(AddTwoInts, f"/soak/guest_{self.seen['guests'] % 20}", lambda _request, response: response)
        self.executor.add_node(guest)
        self._guests.append(guest)
        self.seen["guests"] += 1
        if len(self._guests) > 4:
            leaving = self._guests.popleft()
            self.executor.remove_node(leaving)
            leaving.destroy_node()


class Victim(Part):
    """Publishes and subscribes until it is killed."""

    def __init__(self) -> None:
        super().__init__("soak_victim")
        publisher = self.create_publisher(String, PHOENIX_TOPIC, 10)
        self.create_subscription(Header, topic(50), lambda _message: None, KEEP_ALL_QOS)
        self.create_timer(0.05, lambda: publisher.publish(String(data="here")))


ROLES: dict[str, Callable[[], Part]] = {
    "talker": Talker,
    "listener": Listener,
    "server": Server,
    "client": Client,
    "guests": Guests,
    "victim": Victim,
}


def main() -> int:
    """Play a role until interrupted."""
    rclpy.init()
    node = ROLES[sys.argv[1]]()
    executor = MultiThreadedExecutor(2)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.print_report()
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
