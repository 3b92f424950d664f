"""The programs of Gazebo: ``gz`` and ``ign`` with their most used verbs, ``gazebo``, ``gzserver`` and ``gzclient``.

Topics and services of gz are those of the graph, so the verbs communicate with a simulation of Linkwright.

Source: gz-transport (``gz topic``, ``gz service``: options and output), gz-sim (``gz model``), sdformat (``gz sdf``).
"""

from __future__ import annotations

import argparse
import asyncio
import sys
from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

from linkwright.cli.command import main as linkwright
from linkwright.cli.exit_status import FINDINGS, FINE, USAGE
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase, quoted_names

if TYPE_CHECKING:
    from linkwright.cli.session import Session
    from linkwright.simulation.gz_services import GzService

_PUBLISH_WAIT_S, _SEND_TIME_S = 0.8, 0.2
"""The time to wait for subscribers, as in gz, and the time in which a message is sent."""
_DEFAULT_TIMEOUT_MS = 5000
_LIST_SERVICE = "gazebo_msgs/srv/GetModelList"


def run_gz(program: str, words: Sequence[str]) -> int:
    """Run ``gz`` or ``ign`` with a verb."""
    verb, arguments = (words[0], words[1:]) if words else ("", ())
    if verb in ("sim", "gazebo"):
        return run_simulator(program, words)
    if verb in _VERBS:
        return _VERBS[verb](arguments)
    if verb in ("", "-h", "--help"):
        print(f"usage: {program} VERB ...\n\nverbs: sim, {', '.join(_VERBS)}", file=sys.stdout if verb else sys.stderr)
        return FINE if verb else USAGE
    hint = phrase("the verbs are {verbs}", verbs=quoted_names(["sim", *_VERBS], " and "))
    raise LinkwrightError(
        Diagnostic("SHELL103", phrase("'{program}' has no verb '{verb}'", program=program, verb=verb), hint=hint)
    )


def run_simulator(program: str, words: Sequence[str]) -> int:
    """Run Linkwright's simulator instead of one of Gazebo's programs, with the page instead of Gazebo's window."""
    from linkwright.simulation.nodes.command_line import simulator_command

    command = simulator_command([program, *words])
    if command is None:
        return USAGE
    parameters = [word for name, value in command.parameters.items() for word in ("-p", f"{name}:={value}")]
    ros_arguments = list(command.ros_arguments) or ["--ros-args"]
    return linkwright(["run", command.package, command.executable, *ros_arguments, *parameters])


# --- services ---------------------------------------------------------------------------------------------------------


def _run_service(words: Sequence[str]) -> int:
    parser = argparse.ArgumentParser("gz service", description="list, describe and call services of gz")
    parser.add_argument("-l", "--list", action="store_true", help="list the services")
    parser.add_argument("-i", "--info", action="store_true", help="print the types of a service")
    parser.add_argument("-s", "--service", metavar="NAME", default="", help="the name of the service")
    parser.add_argument("--reqtype", metavar="TYPE", help="the type of the request; not needed")
    parser.add_argument("--reptype", metavar="TYPE", help="the type of the response; not needed")
    parser.add_argument(
        "--timeout", metavar="MS", type=int, default=_DEFAULT_TIMEOUT_MS, help="the timeout in ms, at least 5000"
    )
    parser.add_argument("-r", "--req", metavar="TEXT", help="the request, in the text format of protobuf")
    arguments = parser.parse_args(words)
    if arguments.list:
        return _run_in_graph(_list_services)
    if not arguments.service or (arguments.req is None and not arguments.info):
        parser.error("pass --list, or --service with --info or --req")
    service = _find_service(arguments.service)
    if arguments.info:
        print("Service providers [Address, Request Message Type, Response Message Type]:")
        print(f"  linkwright, {service.gz_type}, gz.msgs.Boolean")
        return FINE
    return _run_in_graph(partial(_call_service, service, arguments))


def _find_service(name: str) -> GzService:
    """Return the service of gz with a name.

    Raises:
        LinkwrightError: SHELL104, there is no such service here.
    """
    from linkwright.simulation.gz_services import WORLD_SERVICES

    parts = name.strip("/").split("/")
    for service in WORLD_SERVICES:
        if len(parts) == 3 and (parts[0], parts[2]) == ("world", service.name):
            return service
    names = [f"/world/NAME/{service.name}" for service in WORLD_SERVICES]
    hint = phrase("the services are {names}", names=quoted_names(names, " and "))
    message = phrase("the service '{name}' of gz does not exist in Linkwright", name=name)
    raise LinkwrightError(Diagnostic("SHELL104", message, hint=hint))


async def _list_services(session: Session) -> int:
    from linkwright.simulation.gz_services import WORLD_SERVICES

    types = {service.ros_type for service in WORLD_SERVICES}
    for name, service_types in sorted(session.node.get_service_names_and_types()):
        if name.startswith("/world/") and types.intersection(service_types):
            print(name)
    return FINE


async def _call_service(service: GzService, arguments: argparse.Namespace, session: Session) -> int:
    """Call a service, and print the response as gz does."""
    from linkwright.cli.calls import NoResponseError, call
    from linkwright.messages import get_message
    from linkwright.simulation.nodes.gz_requests import create_request, format_message
    from linkwright.simulation.plugins.node import to_ros_name

    request = _parse(partial(create_request, service, arguments.req), service.gz_type, arguments.req)
    name = to_ros_name("/" + arguments.service.strip("/"))
    try:
        response = await call(
            session, service.ros_type, name, request, timeout=max(arguments.timeout, _DEFAULT_TIMEOUT_MS) / 1000
        )
    except NoResponseError:
        print("Service call timed out", file=sys.stderr)
        return FINDINGS
    print(format_message(get_message("std_msgs/msg/Bool")(data=response.success)))
    return FINE if response.success else FINDINGS


# --- topics -----------------------------------------------------------------------------------------------------------


def _run_topic(words: Sequence[str]) -> int:
    parser = argparse.ArgumentParser("gz topic", description="list, describe, print and publish topics of gz")
    parser.add_argument("-l", "--list", action="store_true", help="list the topics")
    parser.add_argument("-i", "--info", action="store_true", help="print the type of a topic")
    parser.add_argument("-e", "--echo", action="store_true", help="print the messages of a topic")
    parser.add_argument("-t", "--topic", metavar="NAME", default="", help="the name of the topic")
    parser.add_argument("-m", "--msgtype", metavar="TYPE", default="", help="the type, such as gz.msgs.Twist")
    parser.add_argument("-p", "--pub", metavar="TEXT", help="publish this message, in the text format of protobuf")
    parser.add_argument("-n", "--num", metavar="COUNT", type=int, default=0, help="print this number of messages")
    parser.add_argument("-d", "--duration", metavar="SECONDS", type=float, help="print for this time")
    arguments = parser.parse_args(words)
    if arguments.list:
        return _run_in_graph(_list_topics)
    if not arguments.topic or not (arguments.info or arguments.echo or (arguments.pub is not None)):
        parser.error("pass --list, or --topic with --info, --echo or --pub")
    if arguments.pub is not None:
        return _run_in_graph(partial(_publish, arguments))
    return _run_in_graph(partial(_echo if arguments.echo else _print_topic_type, arguments))


async def _list_topics(session: Session) -> int:
    for name, _ in sorted(session.node.get_topic_names_and_types()):
        print(name)
    return FINE


async def _find_topic_type(name: str, session: Session) -> str:
    """Return the type of a topic in ROS, when it exists."""
    await session.wait_until(lambda: name in dict(session.node.get_topic_names_and_types()))
    return str(dict(session.node.get_topic_names_and_types())[name][0])


async def _print_topic_type(arguments: argparse.Namespace, session: Session) -> int:
    types = dict(session.node.get_topic_names_and_types()).get(_gz_topic(arguments.topic, session))
    if not types:
        print(f"No publishers on topic [{arguments.topic}]")
        return FINDINGS
    print("Publishers [Address, Message Type]:")
    print(f"  linkwright, {_gz_type(types[0])}")
    return FINE


async def _publish(arguments: argparse.Namespace, session: Session) -> int:
    from linkwright.simulation.nodes.gz_requests import create_message

    text = arguments.pub
    message = _parse(partial(create_message, arguments.msgtype, text), arguments.msgtype, text)
    if message is None:
        raise _text_error(arguments.msgtype, text)
    publisher: Any = session.node.create_publisher(type(message), _gz_topic(arguments.topic, session), 10)
    await session.wait_until(lambda: bool(publisher.get_subscription_count()), _PUBLISH_WAIT_S)
    publisher.publish(message)
    await asyncio.sleep(_SEND_TIME_S)
    return FINE


async def _echo(arguments: argparse.Namespace, session: Session) -> int:
    from linkwright.graph import SENSOR_DATA_QOS
    from linkwright.simulation.nodes.gz_requests import format_message

    topic = _gz_topic(arguments.topic, session)
    count = 0

    def on_message(message: Any) -> None:
        nonlocal count
        print(format_message(message))
        count += 1
        if count == arguments.num:
            session.finish()

    session.node.create_subscription(
        await _find_topic_type(topic, session), topic, session.guard_receiver(on_message), SENSOR_DATA_QOS
    )
    return await session.wait_until_finished(arguments.duration) or FINE


def _gz_topic(name: str, session: Session) -> str:
    """Return the name of a topic of gz in the graph; a bridge with another type for the same name hides it."""
    from linkwright.simulation.plugins.bridged_topics import hidden_gz_topic
    from linkwright.simulation.plugins.node import to_ros_name

    topic = to_ros_name("/" + name.strip("/"))
    hidden_topic = hidden_gz_topic(topic)
    return hidden_topic if hidden_topic in dict(session.node.get_topic_names_and_types()) else topic


def _gz_type(ros_type: str) -> str:
    from linkwright.simulation.plugins.gz_messages import ROS_TYPES

    return next((f"gz.msgs.{name}" for name, known_type in ROS_TYPES.items() if known_type == ros_type), ros_type)


# --- models and descriptions ------------------------------------------------------------------------------------------


def _run_model(words: Sequence[str]) -> int:
    parser = argparse.ArgumentParser("gz model", description="list the models of the world")
    parser.add_argument("--list", action="store_true", required=True, help="list the models")
    parser.parse_args(words)
    return _run_in_graph(_list_models)


async def _list_models(session: Session) -> int:
    from linkwright.cli.calls import call
    from linkwright.messages import get_service

    response = await call(session, _LIST_SERVICE, "/get_model_list", get_service(_LIST_SERVICE).Request())
    print("Available models:")
    for name in response.model_names:
        print(f"    - {name}")
    return FINE


def _run_sdf(words: Sequence[str]) -> int:
    parser = argparse.ArgumentParser("gz sdf", description="convert a file to SDF, or check it")
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument("-p", "--print", metavar="FILE", help="print a URDF or SDF file as SDF")
    action.add_argument("-k", "--check", metavar="FILE", help="check an SDF file")
    arguments = parser.parse_args(words)
    if arguments.print:
        return linkwright(["convert", arguments.print, "--to", "sdf"])
    status = linkwright(["check", arguments.check])
    if status == FINE:
        print("Valid.")
    return status


# --- what the verbs share ---------------------------------------------------------------------------------------------


def _run_in_graph(job: Callable[[Session], Any]) -> int:
    from linkwright.cli.session import run_in_graph

    return run_in_graph(argparse.Namespace(), job)


def _parse(parse: Callable[[], Any], gz_type: str, text: str) -> Any:
    """Return a parsed message or request.

    Raises:
        LinkwrightError: SHELL105, the text is not such a message; CLI and MSG codes of invalid fields.
    """
    from linkwright.simulation.plugins.protobuf_text import TextFormatError

    try:
        return parse()
    except TextFormatError:
        raise _text_error(gz_type, text) from None


def _text_error(gz_type: str, text: str) -> LinkwrightError:
    message = phrase("'{text}' is not a '{type}' in the text format of protobuf", text=text, type=gz_type)
    return LinkwrightError(Diagnostic("SHELL105", message, hint=phrase("write it as {form}", form="linear: {x: 0.5}")))


_VERBS: dict[str, Callable[[Sequence[str]], int]] = {
    "service": _run_service,
    "topic": _run_topic,
    "model": _run_model,
    "sdf": _run_sdf,
}
"""The verbs besides ``sim``."""
