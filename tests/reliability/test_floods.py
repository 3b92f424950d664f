"""A busy or slow part does not disturb the others."""

from __future__ import annotations

import signal

import pytest

from tests.reliability.running import Machine
from tests.waiting import wait_until

FLOOD = """
class Program(Node):
    '''Floods one topic, and speaks twenty times a second on another.'''

    def __init__(self):
        super().__init__("flood")
        self.flood = self.create_publisher(String, "flood", 10)
        self.calm = self.create_publisher(Int32, "calm", 10)
        self.number = 0
        self.create_timer(0.0005, self.rush)
        self.create_timer(0.05, self.speak)

    def rush(self):
        for _ in range(20):
            self.flood.publish(String(data="x" * 200))

    def speak(self):
        self.number += 1
        self.calm.publish(Int32(data=self.number))
"""
TWO_TOPIC_LISTENER = """
class Program(Node):
    def __init__(self):
        super().__init__("both")
        self.flooded = 0
        self.create_subscription(String, "flood", self.swallow, 10)
        self.create_subscription(Int32, "calm", lambda message: say("calm", message.data), 10)

    def swallow(self, _message):
        self.flooded += 1
        if self.flooded % 1000 == 0:
            say("flooded", self.flooded)
"""


def test_flooded_topic_does_not_starve_another(machine: Machine) -> None:
    listener = machine.program(TWO_TOPIC_LISTENER)
    flood = machine.program(FLOOD)
    listener.wait_for("flooded")
    before = listener.count("calm")
    listener.wait_for("calm", times=before + 60)
    numbers = [int(line.split()[1]) for line in tuple(listener.lines) if line.startswith("calm ")][before:]
    assert numbers == list(range(numbers[0], numbers[-1] + 1))
    flooded = listener.last_number("flooded")
    wait_until(lambda: listener.last_number("flooded") > flooded)  # the flood continues
    statuses = listener.interrupt(), flood.interrupt()
    assert statuses == (0, 0), f"{listener.text[-2000:]}\n{flood.text}"


def test_blocking_subscriber_does_not_delay_others(machine: Machine) -> None:
    """Only its own process sleeps; other subscribers and topics continue."""
    sleeper = machine.program(
        """
        class Program(Node):
            def __init__(self):
                super().__init__("sleeper")
                self.create_subscription(Int32, "numbers", self.hear, 10)

            def hear(self, message):
                say("asleep")
                time.sleep(60)
        """
    )
    awake = machine.program(
        """
        class Program(Node):
            def __init__(self):
                super().__init__("awake")
                self.create_subscription(Int32, "numbers", lambda message: say("number", message.data), 100)
                self.create_subscription(Int32, "others", lambda message: say("other", message.data), 100)
        """
    )
    talker = machine.program(
        """
        class Program(Node):
            def __init__(self):
                super().__init__("talker")
                self.publishers_ = [self.create_publisher(Int32, name, 100) for name in ("numbers", "others")]
                self.number = 0
                self.create_timer(0.005, self.tick)

            def tick(self):
                self.number += 1
                before = time.monotonic()
                for publisher in self.publishers_:
                    publisher.publish(Int32(data=self.number))
                if time.monotonic() - before > 5.0:
                    say("held up")
        """
    )
    sleeper.wait_for("asleep")
    first = awake.count("number"), awake.count("other")
    awake.wait_for("number", times=first[0] + 400)
    awake.wait_for("other", times=first[1] + 400)
    for word in ("number", "other"):
        numbers = [int(line.split()[1]) for line in tuple(awake.lines) if line.startswith(word + " ")]
        assert numbers == list(range(numbers[0], numbers[0] + len(numbers)))
    assert not talker.count("held up")
    assert sleeper.count("asleep") == 1


@pytest.mark.parametrize("size", [10, 20_000])
def test_reliable_messages_are_not_lost_with_slow_subscriber(machine: Machine, size: int) -> None:
    """Reliable messages are not lost if the queue is unlimited.

    The flood ends long before the subscriber has read all messages.
    """
    listener = machine.program(
        """
        class Program(Node):
            def __init__(self):
                super().__init__("slow")
                self.expected = 0
                self.create_subscription(String, "numbers", self.hear, EVERYTHING)

            def hear(self, message):
                number = int(message.data.split()[0])
                if number != self.expected:
                    say("lost", self.expected, number)
                self.expected = number + 1
                time.sleep(0.001)
                if number == 1999:
                    say("all")
        """
    )
    talker = machine.program(
        f"""
        class Program(Node):
            def __init__(self):
                super().__init__("fast")
                publisher = self.create_publisher(String, "numbers", EVERYTHING)
                while not publisher.get_subscription_count():
                    time.sleep(0.01)
                for number in range(2000):
                    publisher.publish(String(data=f"{{number}} " + "x" * {size}))
                say("sent")
        """
    )
    talker.wait_for("sent")
    listener.wait_for("all")
    assert not listener.count("lost"), listener.text


def test_queue_of_depth_ten_keeps_last_ten(machine: Machine) -> None:
    listener = machine.program(
        """
        from pathlib import Path

        class Program(Node):
            def __init__(self):
                super().__init__("late")
                self.create_subscription(Int32, "numbers", lambda message: say("number", message.data), 10)
                self.create_timer(0.1, self.sleep_once)
                self.slept = False

            def sleep_once(self):
                if not self.slept and self.count_publishers("numbers"):
                    self.slept = True
                    Path("sleeping").touch()
                    while not Path("sent").exists():
                        time.sleep(0.01)
        """
    )
    machine.program(
        """
        from pathlib import Path
        from rclpy.duration import Duration

        class Program(Node):
            def __init__(self):
                super().__init__("fast")
                publisher = self.create_publisher(Int32, "numbers", 10)
                while not (publisher.get_subscription_count() and Path("sleeping").exists()):
                    time.sleep(0.01)
                for number in range(500):
                    publisher.publish(Int32(data=number))
                assert publisher.wait_for_all_acked(Duration(seconds=60))
                Path("sent").touch()
        """
    )
    listener.wait_for("number 499")
    numbers = [int(line.split()[1]) for line in listener.lines if line.startswith("number")]
    assert numbers == list(range(490, 500))


@pytest.mark.slow
def test_service_answers_while_process_is_flooded(machine: Machine) -> None:
    machine.program(FLOOD)
    server = machine.program(
        """
        from std_srvs.srv import Trigger

        class Program(Node):
            def __init__(self):
                super().__init__("server")
                self.count = 0
                self.create_subscription(String, "flood", self.swallow, 10)
                self.create_service(Trigger, "ask", lambda request, response: response)

            def swallow(self, message):
                self.count += 1
                if self.count == 500:
                    say("flooded")
        """
    )
    server.wait_for("flooded")
    wait_until(lambda: "/ask" in machine.verb("service", "list"))
    for _ in range(3):
        assert "response" in machine.verb("service", "call", "/ask", "std_srvs/srv/Trigger")


def test_stopped_process_does_not_block_publisher(machine: Machine) -> None:
    """While a process is stopped as by a debugger, the publisher continues.

    The resumed process gets new messages.
    """
    talker = machine.program(
        """
        class Program(Node):
            def __init__(self):
                super().__init__("talker")
                self.publisher = self.create_publisher(String, "words", 10)
                self.number = 0
                self.create_timer(0.005, self.tick)

            def tick(self):
                self.number += 1
                before = time.monotonic()
                self.publisher.publish(String(data=f"{self.number} " + "x" * 100_000))
                if time.monotonic() - before > 5.0:
                    say("held up")
                if self.number % 50 == 0:
                    say("spoke", self.number)
        """
    )
    listener, other = (
        machine.program(
            f"""
            class Program(Node):
                def __init__(self):
                    super().__init__("{name}")
                    self.create_subscription(String, "words", self.hear, 10)

                def hear(self, message):
                    say("heard", int(message.data.split()[0]))
            """
        )
        for name in ("listener", "other")
    )
    listener.wait_for("heard", times=20)
    other.wait_for("heard", times=20)
    listener.process.send_signal(signal.SIGSTOP)
    spoken, heard = talker.last_number("spoke"), other.count("heard")
    wait_until(lambda: talker.last_number("spoke") >= spoken + 400, what=lambda: talker.text)
    other.wait_for("heard", times=heard + 300)
    assert not talker.count("held up")
    listener.process.send_signal(signal.SIGCONT)
    now = talker.last_number("spoke")
    wait_until(lambda: listener.last_number("heard") > now)
