"""Programs with a ``main`` that run in lockstep with a stepped graph."""

import random
import threading
import time
import traceback
from pathlib import Path
from textwrap import dedent

import pytest

from linkwright.messages import String, get_service
from linkwright.testing import BudgetExceededError, SteppedGraph, SteppedSimulation
from linkwright.testing.programs import threads

ROBOT = Path(__file__).parents[2] / "robots/my_robot_description/urdf/mbot_gazebo.xacro"
DRIVE_SQUARE = Path(__file__).parents[2] / "robots/my_robot_control/my_robot_control/drive_square.py"
AddTwoInts = get_service("example_interfaces/srv/AddTwoInts")

HEAD = """
import random
import sys
import threading
import time

import rclpy
import rclpy.executors
from rclpy.node import Node
from std_msgs.msg import String

"""


@pytest.fixture
def write(tmp_path):
    def write_program(text: str, name: str = "program.py") -> Path:
        path = tmp_path / name
        path.write_text(HEAD + dedent(text), encoding="utf-8")
        return path

    return write_program


def run_program(path, seconds=2.0, args=(), topic="/chatter"):
    """Return the messages that a program publishes in simulated seconds, and the program."""
    with SteppedGraph() as test:
        chatter = test.record(topic, String)
        program = test.start_program(path, args)
        test.advance(seconds)
        messages = [message.data for message in chatter]
    return messages, program


def test_spinning_node_runs_in_simulated_time(write):
    program = write("""
        def main():
            rclpy.init()
            node = Node("talker")
            publisher = node.create_publisher(String, "chatter", 10)
            node.create_timer(0.5, lambda: publisher.publish(String(data=f"{time.monotonic()} {time.time()}")))
            rclpy.spin(node)

        if __name__ == "__main__":
            main()
    """)
    messages, ended = run_program(program)
    assert messages == [f"{seconds} {1_700_000_000 + seconds}" for seconds in (0.5, 1.0, 1.5, 2.0)]
    assert ended.error is None
    assert not ended.is_running


def test_loop_with_spin_once_and_sleep_runs_in_simulated_time(write):
    program = write("""
        rclpy.init()
        node = Node("talker")
        publisher = node.create_publisher(String, "chatter", 10)
        while rclpy.ok():
            rclpy.spin_once(node, timeout_sec=0.1)
            publisher.publish(String(data=f"{time.monotonic():.3f}"))
            time.sleep(0.4)
    """)
    assert run_program(program)[0] == ["0.100", "0.600", "1.100", "1.600"]


def test_busy_loop_sees_time_advance(write):
    program = write("""
        rclpy.init()
        node = Node("talker")
        publisher = node.create_publisher(String, "chatter", 10)
        node.create_timer(0.5, lambda: publisher.publish(String(data="tick")))
        while rclpy.ok() and time.time() < 1_700_000_001.6:
            rclpy.spin_once(node, timeout_sec=0)
        end = node.get_clock().now().nanoseconds + 200_000_000
        while node.get_clock().now().nanoseconds < end:
            pass
        publisher.publish(String(data="end"))
    """)
    assert run_program(program)[0] == ["tick", "tick", "tick", "end"]


def test_rate_works_with_spinning_thread(write):
    program = write("""
        def spin(node):
            try:
                rclpy.spin(node)
            except rclpy.executors.ExternalShutdownException:
                pass

        def main(args=None):
            rclpy.init(args=args)
            node = Node("talker")
            thread = threading.Thread(target=spin, args=(node,), daemon=True)
            thread.start()
            publisher = node.create_publisher(String, "chatter", 10)
            rate = node.create_rate(2)
            try:
                while rclpy.ok():
                    rate.sleep()
                    publisher.publish(String(data=str(node.get_clock().now().nanoseconds / 1e9 - 1.7e9)))
            except KeyboardInterrupt:
                pass
            rclpy.try_shutdown()
            thread.join()
    """)
    assert run_program(program)[0] == ["0.5", "1.0", "1.5", "2.0"]


def test_client_waits_for_service_of_graph(write):
    program = write("""
        from example_interfaces.srv import AddTwoInts

        rclpy.init()
        node = Node("client")
        publisher = node.create_publisher(String, "chatter", 10)
        client = node.create_client(AddTwoInts, "add")
        while not client.wait_for_service(timeout_sec=1.0):
            publisher.publish(String(data=f"waiting at {time.monotonic()}"))
        future = client.call_async(AddTwoInts.Request(a=1, b=2))
        rclpy.spin_until_future_complete(node, future)
        publisher.publish(String(data=str(future.result().sum)))
    """)
    with SteppedGraph() as test:
        chatter = test.record("/chatter", String)
        test.start_program(program)
        test.advance(2.5)

        def add(request, response):
            response.sum = request.a + request.b
            return response

        test.create_node("server").create_service(AddTwoInts, "add", add)
        test.advance(1.0)
    assert [message.data for message in chatter] == ["waiting at 1.0", "waiting at 2.0", "3"]


ACTION = """
    from rclpy.action import ActionClient, ActionServer
    from rclpy.executors import MultiThreadedExecutor
    from example_interfaces.action import Fibonacci

    def execute(goal):
        sequence = [0, 1]
        for _ in range(goal.request.order - 1):
            time.sleep(0.2)
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        goal.succeed()
        return Fibonacci.Result(sequence=sequence)

    rclpy.init()
    node = Node("fibonacci")
    publisher = node.create_publisher(String, "chatter", 10)
    server = ActionServer(node, Fibonacci, "fibonacci", execute)
    executor = MultiThreadedExecutor(4)
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()
    client = ActionClient(node, Fibonacci, "fibonacci")
    client.wait_for_server()
    finished = threading.Event()

    def say(text):
        publisher.publish(String(data=f"{time.monotonic():.1f} {text}"))

    def on_goal(future):
        future.result().get_result_async().add_done_callback(on_result)

    def on_result(future):
        say(list(future.result().result.sequence))
        finished.set()

    client.send_goal_async(
        Fibonacci.Goal(order=4), feedback_callback=lambda feedback: say(len(feedback.feedback.sequence))
    ).add_done_callback(on_goal)
    finished.wait()
    say("end")
"""


def test_action_runs_in_multi_threaded_executor(write):
    program = write(ACTION)
    messages, _ = run_program(program)
    assert messages == ["0.2 3", "0.4 4", "0.6 5", "0.6 [0, 1, 1, 2, 3]", "0.6 end"]
    assert run_program(program)[0] == messages


def test_threads_queues_pools_and_conditions_run_in_simulated_time(write):
    program = write("""
        import queue
        from concurrent.futures import ThreadPoolExecutor

        rclpy.init()
        node = Node("talker")
        publisher = node.create_publisher(String, "chatter", 10)
        work = queue.Queue()
        lock = threading.Lock()

        def produce():
            for number in range(3):
                time.sleep(0.2)
                with lock:
                    time.sleep(0.1)
                    work.put(number)

        thread = threading.Thread(target=produce)
        thread.start()
        while thread.is_alive() or not work.empty():
            try:
                item = work.get(timeout=0.25)
            except queue.Empty:
                item = "empty"
            with lock:
                publisher.publish(String(data=f"{time.monotonic():.2f} {item}"))
        thread.join()
        with ThreadPoolExecutor(2) as pool:
            results = list(pool.map(lambda seconds: (time.sleep(seconds), time.monotonic())[1], [0.2, 0.1, 0.1]))
        publisher.publish(String(data=" ".join(f"{result:.2f}" for result in results)))
    """)
    messages, ended = run_program(program)
    assert messages[0] == "0.30 empty"
    assert [message.split()[1] for message in messages if "empty" not in message][:3] == ["0", "1", "2"]
    start = float(messages[-2].split()[0])
    assert messages[-1] == " ".join(f"{start + seconds:.2f}" for seconds in (0.2, 0.1, 0.2))
    assert ended.exit_code == 0
    assert run_program(program)[0] == messages


def test_asyncio_runs_in_simulated_time(write):
    program = write("""
        import asyncio

        rclpy.init()
        publisher = Node("talker").create_publisher(String, "chatter", 10)

        async def main():
            await asyncio.gather(*(say(seconds) for seconds in (0.5, 0.2)))
            await asyncio.to_thread(time.sleep, 0.5)
            await say(0.1)

        async def say(seconds):
            await asyncio.sleep(seconds)
            publisher.publish(String(data=f"{time.monotonic():.1f}"))

        asyncio.run(main())
    """)
    assert run_program(program)[0] == ["0.2", "0.5", "1.1"]


def test_program_follows_clock_topic(write):
    program = write("""
        rclpy.init()
        node = Node("talker")
        publisher = node.create_publisher(String, "chatter", 10)
        node.create_timer(0.5, lambda: publisher.publish(String(data=str(node.get_clock().now().nanoseconds / 1e9))))
        rclpy.spin(node)
    """)
    with SteppedSimulation() as test:
        chatter = test.record("/chatter", String)
        test.start_program(program, ["--ros-args", "-p", "use_sim_time:=true"])
        test.advance(1.6)
        assert [message.data for message in chatter] == ["0.5", "1.0", "1.5"]


def test_two_programs_have_separate_contexts_and_arguments(write):
    program = write("""
        rclpy.init()
        node = Node("talker")
        publisher = node.create_publisher(String, "/chatter", 10)
        for _ in range(2):
            time.sleep(0.5)
            publisher.publish(String(data=f"{node.get_namespace()} {sys.argv[1]} {__name__}"))
        rclpy.shutdown()
    """)
    with SteppedGraph() as test:
        chatter = test.record("/chatter", String)
        for name in ("red", "blue"):
            test.start_program(program, [name, "--ros-args", "-r", f"__ns:=/{name}"])
        test.advance(0.7)
        assert [node.identity.name for node in test.graph.nodes()].count("talker") == 2
        test.advance(1.0)
        names = [node.identity.name for node in test.graph.nodes()]
        assert "talker" not in names, "the nodes of an ended program leave the graph"
    assert [message.data for message in chatter] == [f"/{name} {name} __main__" for name in ("red", "blue") * 2]


def test_exception_of_program_is_raised_in_test_with_location(write):
    program = write("""
        rclpy.init()
        time.sleep(0.5)
        unknown_name
    """)
    with SteppedGraph() as test:
        started = test.start_program(program)
        test.advance(0.4)
        with pytest.raises(NameError, match="unknown_name") as caught:
            test.advance(0.2)
        assert str(program) in "".join(traceback.format_exception(caught.value))
        assert started.exit_code == 1
        test.advance(1.0)


def test_sys_exit_ends_program(write):
    assert run_program(write("sys.exit(3)"))[1].exit_code == 3
    assert run_program(write("sys.exit('no robot')"))[1].exit_code == 1


STOPS_AT_CTRL_C = """
    from rclpy.signals import SignalHandlerOptions

    rclpy.init({options})
    node = Node("talker")
    publisher = node.create_publisher(String, "chatter", 10)
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        publisher.publish(String(data="stop"))
        time.sleep(0.5)
        publisher.publish(String(data="stopped"))
"""


def run_until_ctrl_c(program):
    with SteppedGraph() as test:
        chatter = test.record("/chatter", String)
        ended = test.start_program(program)
        test.advance(1.0)
    return [message.data for message in chatter], ended


def test_program_with_own_ctrl_c_handling_can_stop_robot(write):
    program = write(STOPS_AT_CTRL_C.format(options="signal_handler_options=SignalHandlerOptions.NO"))
    messages, ended = run_until_ctrl_c(program)
    assert messages == ["stop", "stopped"]
    assert ended.exit_code == 0


def test_after_ctrl_c_rclpy_publishes_nothing(write, capsys):
    """The program fails as under ROS 2.

    The test does not fail, because it ends the program itself.
    """
    messages, ended = run_until_ctrl_c(write(STOPS_AT_CTRL_C.format(options="")))
    assert messages == []
    assert ended.exit_code == 1
    assert "RCLError: the context is invalid" in capsys.readouterr().err


def test_signal_handler_of_program_receives_ctrl_c(write):
    program = write("""
        import signal

        stopping = threading.Event()
        signal.signal(signal.SIGINT, lambda number, frame: stopping.set())
        stopping.wait()
        sys.exit(4)
    """)
    assert run_program(program)[1].exit_code == 4


def test_program_that_ignores_ctrl_c_is_ended(write):
    program = write("""
        while True:
            try:
                time.sleep(1.0)
            except KeyboardInterrupt:
                pass
    """)
    before = threading.active_count()
    _, ended = run_program(program)
    assert not ended.is_running
    assert ended.exit_code != 0
    assert threading.active_count() <= before + 1


def test_endless_loop_is_ended_with_location(write):
    program = write("""
        def work():
            count = 0
            while True:
                count += 1

        time.sleep(0.1)
        work()
    """)
    with SteppedGraph() as test:
        test.start_program(program, budget=0.5)
        with pytest.raises(BudgetExceededError, match=r"program.py:1[456], in work"):
            test.advance(1.0)


def test_program_that_waits_for_processor_is_not_ended(write, monkeypatch):
    class StandingClock:
        def read(self):
            return 0.0

    monkeypatch.setattr(threads, "PatientClock", StandingClock)
    program = write("""
        rclpy.init()
        used = time.thread_time()
        while time.thread_time() < used + 1.0:
            pass
        print("has computed")
    """)
    with SteppedGraph() as test:
        started = test.start_program(program, budget=0.3)
        test.advance(1.0)
        assert started.exit_code == 0


def test_random_numbers_are_equal_in_each_run(write):
    program = write("""
        rclpy.init()
        publisher = Node("talker").create_publisher(String, "chatter", 10)
        time.sleep(0.1)
        import numpy as np
        publisher.publish(String(data=f"{random.random()} {np.random.random()}"))
    """)
    random.seed()
    first = run_program(program)[0]
    random.seed()
    assert run_program(program)[0] == first


def test_file_that_only_defines_main_is_run(write):
    program = write("""
        def main():
            rclpy.init()
            Node("talker").create_publisher(String, "chatter", 10).publish(String(data="once"))
    """)
    assert run_program(program)[0] == ["once"]
    assert run_program(write(program.read_text()[len(HEAD) :] + "\nmain()", "calls_main.py"))[0] == ["once"]


def test_functions_and_modules_can_be_run_as_programs(write, monkeypatch, tmp_path):
    texts = []

    def main():
        time.sleep(0.5)
        texts.append(time.monotonic())

    run_program(main)
    assert texts == [0.5]
    write("def main(): sys.exit(7)", "my_program_module.py")
    monkeypatch.syspath_prepend(tmp_path)
    assert run_program("my_program_module")[1].exit_code == 7


def test_missing_program_file_is_an_error(tmp_path):
    sleep = time.sleep
    with SteppedGraph() as test, pytest.raises(FileNotFoundError):
        test.start_program(tmp_path / "missing.py")
    assert time.sleep is sleep


def test_patched_python_functions_are_restored(write):
    originals = (time.sleep, time.time, threading.Lock, threading.Thread.start)
    run_program(write("time.sleep(0.1)"))
    assert (time.sleep, time.time, threading.Lock, threading.Thread.start) == originals


def test_package_node_drives_robot_in_simulation():
    poses = []
    for _ in range(2):
        with SteppedSimulation("empty", ROBOT) as test:
            program = test.start_program(DRIVE_SQUARE, ["--ros-args", "-p", "side:=0.5"])
            test.advance(25.0)
            poses.append(test.robot_pose())
            assert any("the square is closed" in record.text for record in test.log)
        assert program.exit_code == 0
    assert poses[0] == poses[1]
