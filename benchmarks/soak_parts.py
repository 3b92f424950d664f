"""The processes of the soak, each a user's program over rclpy: ``python -m benchmarks.soak_parts ROLE``.

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

RATES = (1, 50, 1000)
FRAMES = 50
PHOENIX = "/soak/phoenix"
EVERYTHING = QoSProfile(depth=0, history=HistoryPolicy.KEEP_ALL)
WAIT = 10.0
"""Seconds after which an answer that does not come counts as a failure."""


def topic(rate: int) -> str:
    """Return the topic of a rate."""
    return f"/soak/rate_{rate}"


class Part(Node):
    """A node with counters in `seen`, and descriptions of its first failures."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.seen: Counter[str] = Counter()
        self.failures: list[str] = []
        self.create_timer(2.0, self.tell)

    def tell(self) -> None:
        """Print a line."""
        print(json.dumps({"seen": self.seen, "failures": self.failures[:5], **self.figures()}), flush=True)

    def figures(self) -> dict[str, Any]:
        """Return further figures to report."""
        return {}

    def failed(self, what: str) -> None:
        """Record a failure."""
        self.seen["failures"] += 1
        self.failures.append(what)


class Talker(Part):
    """Publishes numbered messages at several rates, and transforms."""

    def __init__(self) -> None:
        super().__init__("soak_talker")
        for rate in RATES:
            self.create_timer(1.0 / rate, self._counting(rate))
        self._broadcaster = TransformBroadcaster(self)
        self.create_timer(1.0 / 30.0, self._transforms)

    def _counting(self, rate: int) -> Callable[[], None]:
        name = topic(rate)
        publisher = self.create_publisher(Header, name, EVERYTHING)

        def publish() -> None:
            publisher.publish(Header(stamp=self.get_clock().now().to_msg(), frame_id=str(self.seen[name])))
            self.seen[name] += 1

        return publish

    def _transforms(self) -> None:
        stamp = self.get_clock().now().to_msg()
        sent = []
        for number in range(FRAMES):
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
        for rate in RATES:
            self.create_subscription(Header, topic(rate), self._counting(topic(rate)), EVERYTHING)
        self.create_subscription(String, PHOENIX, self._phoenix, 10)
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
                self.failed(f"{name}: {number - expected} lost before {number}")
            elif number < expected:
                self.failed(f"{name}: {number} came again, or late, instead of {expected}")
            self._next[name] = number + 1
            self.seen[name] = number + 1

        return receive

    def _phoenix(self, _message: String) -> None:
        self.seen[PHOENIX] += 1

    def _look_up(self) -> None:
        try:
            self._buffer.lookup_transform("soak_0", f"soak_{FRAMES}", Time())
            self.seen["transforms"] += 1
        except TransformException as error:
            if self.seen["transforms"]:
                self.failed(f"transform: {error}")


class Server(Part):
    """Provides a service, an action and parameters."""

    def __init__(self) -> None:
        super().__init__("soak_server")
        self.declare_parameter("speed", 0)
        self.create_service(AddTwoInts, "/soak/add", self._add)
        # Results are kept for a quarter of an hour unless said otherwise; then memory is flat only after that.
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
    """Asks, in a thread of its own, and checks each answer."""

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
                    self.failed(f"{type(error).__name__}: {error}")
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
        came = threading.Event()
        future.add_done_callback(lambda _: came.set())
        if not came.wait(WAIT):
            raise TimeoutError(f"no answer: {what}")
        return future.result()

    def _check_sum(self, a: int, b: int) -> None:
        answer = self._answer(self._add.call_async(AddTwoInts.Request(a=a, b=b)), "sum")
        if answer.sum != a + b:
            self.failed(f"{a} + {b} gave {answer.sum}")
        self.seen["sums"] += 1

    def _check_action(self) -> None:
        heard: list[Any] = []
        goal = self._answer(self._action.send_goal_async(Fibonacci.Goal(order=5), heard.append), "goal")
        result = self._answer(goal.get_result_async(), "result").result
        if list(result.sequence) != [0, 1, 1, 2, 3, 5, 8]:
            self.failed(f"the action gave {list(result.sequence)}")
        self.seen["goals"] += 1

    def _check_parameter(self, number: int) -> None:
        wanted = Parameter("speed", value=number)
        self._answer(self._parameters.set_parameters([wanted]), "set")
        values = self._answer(self._parameters.get_parameters(["speed"]), "get").values
        if values[0].integer_value != number:
            self.failed(f"parameter was set to {number} and is {values[0].integer_value}")
        self.seen["parameters"] += 1


class Guests(Part):
    """Makes nodes that come, speak, listen and go."""

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
    """Speaks and listens until it is killed."""

    def __init__(self) -> None:
        super().__init__("soak_victim")
        publisher = self.create_publisher(String, PHOENIX, 10)
        self.create_subscription(Header, topic(50), lambda _message: None, EVERYTHING)
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
        node.tell()
        executor.shutdown()
        node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
