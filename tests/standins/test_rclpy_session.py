"""From init to shutdown: contexts, signals, loggers, names, small modules."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import textwrap
import threading
from importlib.util import find_spec

import pytest
import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy import signals
from rclpy._rclpy_pybind11 import RCLError, RCLInvalidROSArgsError, UnknownROSArgsError
from rclpy.context import Context
from rclpy.exceptions import InvalidServiceNameException, InvalidTopicNameException
from rclpy.executors import SingleThreadedExecutor
from rclpy.logging import LoggingSeverity
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.signals import SignalHandlerOptions
from rclpy.type_hash import TypeHash
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import String

from linkwright.standins import process


@pytest.fixture(autouse=True)
def _isolated(monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")


@pytest.fixture
def node():
    with rclpy.init(args=[]):
        yield rclpy.create_node("tested")


class TestContexts:
    def test_init_and_shutdown_can_be_repeated(self):
        rclpy.init(args=[])
        assert rclpy.ok()
        rclpy.shutdown()
        assert not rclpy.ok()
        rclpy.init(args=[])
        assert rclpy.ok()
        rclpy.shutdown()

    def test_repeated_init_and_shutdown_are_rejected(self):
        context = Context()
        rclpy.init(args=[], context=context)
        with pytest.raises(RuntimeError):
            rclpy.init(args=[], context=context)
        rclpy.shutdown(context=context)
        with pytest.raises(RCLError, match="already called on the given context"):
            rclpy.shutdown(context=context)
        rclpy.try_shutdown(context=context)

    def test_shutdown_without_init_is_rejected(self):
        with pytest.raises(RCLError, match="Context must be initialized before it can be shutdown"):
            rclpy.shutdown()
        rclpy.try_shutdown()

    def test_domain_id_is_read_from_argument_and_environment(self, monkeypatch):
        with rclpy.init(args=[], domain_id=12) as init:
            assert init.context.get_domain_id() == 12
            assert init.context.ok()
        monkeypatch.setenv("ROS_DOMAIN_ID", "34")
        with rclpy.init(args=[]):
            assert rclpy.get_default_context().get_domain_id() == 34
        with pytest.raises(RuntimeError, match="lower than zero"):
            rclpy.init(args=[], domain_id=-1)

    def test_on_shutdown_callbacks_are_called(self):
        context, text = Context(), []
        rclpy.init(args=[], context=context)
        context.on_shutdown(lambda: text.append(1))
        context.shutdown()
        context.on_shutdown(lambda: text.append(2))
        assert text == [1, 2]
        with pytest.raises(TypeError):
            context.on_shutdown(3)

    def test_invalid_ros_arguments_are_rejected(self):
        with pytest.raises(UnknownROSArgsError, match=r"\['unknown'\]"):
            rclpy.init(args=["--ros-args", "unknown"], context=Context())
        with pytest.raises(RCLInvalidROSArgsError, match=r"Failed to parse ROS arguments:.*not-a-remap"):
            rclpy.init(args=["--ros-args", "-r", "not-a-remap"], context=Context())
        with pytest.raises(UnicodeEncodeError):
            rclpy.init(args=["Ragnar\udcc3"], context=Context())
        assert issubclass(RCLInvalidROSArgsError, RCLError)

    def test_ros_arguments_apply_to_nodes_with_global_arguments(self):
        context = Context()
        rclpy.init(args=["program", "--ros-args", "-r", "__node:=renamed", "-p", "speed:=3"], context=context)
        node = rclpy.create_node("mine", context=context)
        other = rclpy.create_node("mine", context=context, use_global_arguments=False)
        assert (node.get_name(), other.get_name()) == ("renamed", "mine")
        assert node.declare_parameter("speed", 1).value == 3
        assert other.declare_parameter("speed", 1).value == 1
        rclpy.shutdown(context=context)

    def test_node_can_be_destroyed_after_shutdown(self):
        rclpy.init(args=[])
        node = rclpy.create_node("late")
        rclpy.shutdown()
        node.destroy_node()

    def test_executor_belongs_to_its_context(self):
        context = Context()
        rclpy.init(args=[], context=context)
        executor = SingleThreadedExecutor(context=context)
        assert executor.context is context
        assert isinstance(executor, rclpy.executors.Executor)
        rclpy.shutdown(context=context)
        executor.spin()


class TestSignals:
    def test_shutdown_restores_signal_handlers(self):
        before = signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)
        rclpy.init(args=[])
        assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.ALL
        rclpy.shutdown()
        assert signals.get_current_signal_handlers_options() == SignalHandlerOptions.NO
        assert (signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)) == before

    def test_no_signal_handlers_are_installed_if_disabled(self):
        before = signal.getsignal(signal.SIGINT)
        rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
        assert signal.getsignal(signal.SIGINT) is before
        rclpy.shutdown()

    def test_ctrl_c_ends_spin(self, node):
        threading.Timer(0.05, os.kill, [os.getpid(), signal.SIGINT]).start()
        with pytest.raises(KeyboardInterrupt):
            rclpy.spin(node)
        assert not rclpy.ok()
        node.destroy_node()
        with pytest.raises(RCLError, match="already called on the given context"):
            rclpy.shutdown()

    def test_node_can_log_but_not_publish_after_signal(self, node):
        """The real rclpy of Humble, Jazzy and Kilted does the same."""
        publisher = node.create_publisher(String, "chatter", 1)
        client = node.create_client(AddTwoInts, "sum")
        signal.raise_signal(signal.SIGTERM)
        node.get_logger().info(f"{node.get_name()} stops at {node.get_clock().now()}")
        for use in (
            lambda: publisher.publish(String()),
            lambda: client.call_async(AddTwoInts.Request()),
            lambda: node.create_publisher(String, "other", 1),
            lambda: node.create_timer(1.0, print),
        ):
            with pytest.raises(RCLError, match="context is invalid"):
                use()
        node.destroy_node()
        rclpy.try_shutdown()

    def test_sigterm_ends_spin(self, node):
        threading.Timer(0.05, os.kill, [os.getpid(), signal.SIGTERM]).start()
        with pytest.raises(rclpy.executors.ExternalShutdownException):
            rclpy.spin(node)

    def test_sigterm_wakes_a_rate_that_no_thread_ticks(self, node):
        rate = node.create_rate(0.001)
        threading.Timer(0.05, os.kill, [os.getpid(), signal.SIGTERM]).start()
        with pytest.raises(rclpy.exceptions.ROSInterruptException):
            rate.sleep()
        assert not rclpy.ok()

    @pytest.mark.parametrize("executor", ["SingleThreadedExecutor", "MultiThreadedExecutor"])
    def test_ctrl_c_raises_keyboard_interrupt_in_program(self, executor, tmp_path):
        program = tmp_path / "program.py"
        program.write_text(
            textwrap.dedent(f"""\
            import rclpy
            from rclpy.executors import {executor}
            rclpy.init()
            node = rclpy.create_node("program")
            node.create_timer(0.01, lambda: print("tick", flush=True))
            executor = {executor}()
            executor.add_node(node)
            try:
                executor.spin()
            except KeyboardInterrupt:
                print("interrupted", flush=True)
            finally:
                node.destroy_node()
                rclpy.try_shutdown()
            """)
        )
        child = subprocess.Popen(
            [sys.executable, program], env=process.create_environment(), stdout=subprocess.PIPE, text=True
        )
        with child:
            assert child.stdout.readline() == "tick\n"
            child.send_signal(signal.SIGINT)
            output = child.stdout.read()
            assert child.wait(60.0) == 0
        assert output.endswith("interrupted\n")

    def test_program_without_shutdown_ends(self, tmp_path):
        program = tmp_path / "program.py"
        program.write_text(
            textwrap.dedent("""\
            import threading
            import rclpy
            from rclpy.executors import MultiThreadedExecutor
            rclpy.init()
            node = rclpy.create_node("forgetful")
            executor = MultiThreadedExecutor(2)
            executor.add_node(node)
            node.create_timer(0.01, lambda: None)
            threading.Thread(target=executor.spin, daemon=True).start()
            """)
        )
        ended = subprocess.run(
            [sys.executable, program],
            env=process.create_environment(),
            check=False,
            capture_output=True,
            text=True,
            timeout=60,
        )
        assert (ended.returncode, ended.stderr) == (0, "")


class TestLogging:
    def test_log_levels_are_process_wide(self, node, capsys):
        logger = node.get_logger()
        rclpy.logging.set_logger_level("tested", LoggingSeverity.WARN)
        assert logger.get_effective_level() == LoggingSeverity.WARN
        assert logger.info("quiet") is False
        assert logger.get_child("arm").warning("loud") is True
        assert rclpy.logging.get_logger_effective_level("tested.arm") == LoggingSeverity.WARN
        rclpy.logging.set_logger_level("tested", LoggingSeverity.UNSET)
        assert logger.info("loud again") is True
        lines = capsys.readouterr().err.splitlines()
        assert [line.partition("]: ")[2] for line in lines] == ["loud", "loud again"]

    def test_named_loggers_work_without_node(self, capsys):
        rclpy.logging.get_logger("mine").error("broken")
        assert capsys.readouterr().err.endswith("[mine]: broken\n")
        with pytest.raises(ValueError, match="must not be empty"):
            rclpy.logging.get_logger("")
        assert rclpy.logging.get_logging_severity_from_string("FATAL") == LoggingSeverity.FATAL
        with pytest.raises(RuntimeError):
            rclpy.logging.get_logging_severity_from_string("dire")

    def test_log_filters_once_and_skip_first(self, node):
        logger = node.get_logger()
        assert [logger.info("once", once=True) for _ in range(3)] == [True, False, False]
        assert [logger.info("later", skip_first=True) for _ in range(3)] == [False, True, True]

    def test_log_level_is_read_from_command_line(self, capsys):
        with rclpy.init(args=["--ros-args", "--log-level", "quiet:=error"]):
            rclpy.create_node("quiet").get_logger().warning("not this")
            rclpy.create_node("other").get_logger().warning("this")
        rclpy.logging.clear_config()
        assert "not this" not in capsys.readouterr().err

    def test_log_file_is_written(self, tmp_path, monkeypatch):
        monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path / "log"))
        assert rclpy.logging.get_logging_directory() == tmp_path / "log"
        with rclpy.init(args=[]):
            rclpy.create_node("writer").get_logger().warning("to be kept")
        (file,) = (tmp_path / "log").iterdir()
        assert "to be kept" in file.read_text()


class TestSmallModules:
    def test_messages_are_serialized_and_deserialized(self):
        data = serialize_message(String(data="hello"))
        assert deserialize_message(data, String).data == "hello"
        with pytest.raises(TypeError):
            serialize_message("hello")

    def test_wait_for_message_returns_message_or_times_out(self, node):
        publisher = node.create_publisher(String, "chatter", 1)
        timer = threading.Timer(0.05, publisher.publish, [String(data="here")])
        timer.start()
        is_received, message = wait_for_message(String, node, "chatter", time_to_wait=3.0)
        assert (is_received, message.data) == (True, "here")
        assert wait_for_message(String, node, "chatter", time_to_wait=0.02) == (False, None)
        assert wait_for_message(String, node, "chatter", 0.02) == (False, None)
        assert list(node.subscriptions) == []

    def test_utilities_handle_ros_arguments_and_timeouts(self):
        from rclpy.utilities import get_rmw_implementation_identifier, remove_ros_args, timeout_sec_to_nsec

        line = ["program", "-d", "--ros-args", "-r", "a:=b", "--", "--foo"]
        assert remove_ros_args(line) == ["program", "-d", "--foo"]
        assert remove_ros_args([]) == []
        assert [timeout_sec_to_nsec(timeout) for timeout in (None, -1, 0, 1.5)] == [-1, -1, 0, 1_500_000_000]
        has_dds = find_spec("cyclonedds") is not None
        assert get_rmw_implementation_identifier() == ("rmw_cyclonedds_cpp" if has_dds else "rmw_zenoh_cpp")

    def test_name_functions_expand_and_validate(self):
        from rclpy.expand_topic_name import expand_topic_name
        from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden
        from rclpy.validate_full_topic_name import validate_full_topic_name
        from rclpy.validate_topic_name import validate_topic_name

        assert expand_topic_name("~/chatter", "node_name", "/ns") == "/ns/node_name/chatter"
        for names, match in (
            (("topic", "bad?", "/ns"), "node name"),
            (("topic", "name", "ns"), "namespace"),
            (("bad?", "name", "/ns"), "topic name"),
        ):
            with pytest.raises(ValueError, match=match):
                expand_topic_name(*names)
        assert topic_or_service_is_hidden("/a/_action/status")
        assert not any(topic_or_service_is_hidden(name) for name in ("/a/b", "", "a_/b_", "/2bad"))
        assert validate_topic_name("~/chatter")
        with pytest.raises(InvalidTopicNameException, match="must be absolute"):
            validate_full_topic_name("chatter")
        with pytest.raises(InvalidServiceNameException, match="must be absolute"):
            validate_full_topic_name("chatter", is_service=True)

    def test_type_hash_has_text_and_equality(self):
        assert str(TypeHash()) == "INVALID"
        assert str(TypeHash(version=1, value=bytes(range(32)))).startswith("RIHS01_000102")
        assert TypeHash() == TypeHash()
        assert TypeHash(version=5) != TypeHash()

    def test_submodules_are_available_after_package_import(self):
        assert rclpy.time.Time(seconds=1).nanoseconds == 1_000_000_000
        assert rclpy.duration.Duration(seconds=1) == rclpy.duration.Duration(nanoseconds=1_000_000_000)
        with pytest.raises(AttributeError, match="no attribute 'rmw_internals'"):
            rclpy.rmw_internals  # noqa: B018

    def test_parameters_are_parsed_from_text_and_files(self, tmp_path):
        from rclpy.parameter import get_parameter_value, parameter_dict_from_yaml_file

        assert get_parameter_value("1.5").double_value == 1.5
        assert get_parameter_value("[1, 2]").integer_array_value.tolist() == [1, 2]
        assert get_parameter_value("hello").string_value == "hello"
        file = tmp_path / "parameters.yaml"
        file.write_text("/**:\n  ros__parameters:\n    a: 1\n/talker:\n  ros__parameters:\n    b:\n      c: two\n")
        assert list(parameter_dict_from_yaml_file(str(file), target_nodes=["/talker"])) == ["b.c"]
        assert list(parameter_dict_from_yaml_file(str(file), True, ["/talker"], "ns")) == ["ns.a", "ns.b.c"]
        file.write_text(file.read_text().replace("/talker", "talker"))
        assert list(parameter_dict_from_yaml_file(str(file), target_nodes=["/talker"])) == ["b.c"]
        assert list(parameter_dict_from_yaml_file(str(file), target_nodes=["talker"])) == ["b.c"]
        with pytest.raises(RuntimeError, match="/nobody"):
            parameter_dict_from_yaml_file(str(file), target_nodes=["/nobody"])

    def test_async_parameter_client_reads_and_sets_parameters(self, node):
        from rclpy.parameter import Parameter
        from rclpy.parameter_client import AsyncParameterClient

        node.declare_parameter("speed", 1)
        client = AsyncParameterClient(node, "tested")
        assert client.wait_for_services(timeout_sec=60.0)
        future = client.set_parameters([Parameter("speed", value=2)])
        rclpy.spin_until_future_complete(node, future, timeout_sec=60.0)
        assert future.result().results[0].successful
        assert node.get_parameter("speed").value == 2

    def test_service_name_is_remapped(self, node):
        other = rclpy.create_node("other", namespace="ns", cli_args=["--ros-args", "-r", "add:=sum/add"])
        assert other.create_client(AddTwoInts, "add").service_name == "/ns/sum/add"
