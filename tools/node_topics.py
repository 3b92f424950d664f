"""Write the table of the topics, services and actions of Linkwright's nodes, for the language server.

Each node is started in a graph without a network, as in `node_parameters.py`, and its endpoints are recorded. The names
are those in the program, before a launch file remaps them.

Usage: python tools/node_topics.py [--check]
"""

from __future__ import annotations

import asyncio
import json
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any
from unittest import mock

from node_parameters import _LEFT_OUT, _NEEDED, _PACKAGES_LEFT_OUT, _start

from linkwright.graph import Node
from linkwright.graph.parameters.parameter import ParameterRules
from linkwright.nodes.options import EXECUTABLES

ROOT = Path(__file__).resolve().parent.parent
LIST = ROOT / "src" / "linkwright" / "language" / "node_topics.json"

_CREATORS = {
    "create_publisher": "publisher",
    "create_subscription": "subscription",
    "create_service": "service",
    "create_client": "client",
}
_GIVEN = frozenset({"a", "b", "THE_ITEM"})
"""Names from the parameters that nodes need to start."""
_OF_EVERY_NODE = ("/rosout", "/parameter_events", "~/describe_parameters", "~/get_param", "~/list_parameters")
_MORE: Mapping[str, list[tuple[str, str, str]]] = {
    "robot_state_publisher/robot_state_publisher": [("joint_states", "sensor_msgs/msg/JointState", "subscription")],
    "teleop_twist_keyboard/teleop_twist_keyboard": [("cmd_vel", "geometry_msgs/msg/Twist", "publisher")],
    "controller_manager/ros2_control_node": [("~/robot_description", "std_msgs/msg/String", "subscription")],
}
"""Names that a node creates only under conditions, such as with a terminal."""


def _type_name(kind: Any) -> str:
    if isinstance(kind, str):
        return kind
    module, _, _ = kind.__module__.partition(".")
    part = next((part for part in ("msg", "srv", "action") if f".{part}" in f".{kind.__module__}"), "msg")
    return f"{module}/{part}/{kind.__name__}"


def _shown(name: str, kind: str, role: str) -> tuple[str, str, str] | None:
    """Return the name, type and role of an endpoint; None for endpoints of every node, and for parts of an action."""
    name, is_action, part = name.partition("/_action/")
    if is_action:
        of_server = role == "publisher"
        is_shown = part == "feedback"
        role = "action server" if of_server else "action client"
        return (name, kind.removesuffix("_FeedbackMessage"), role) if is_shown else None
    if name in _GIVEN or name.startswith(_OF_EVERY_NODE) or "_parameter" in name or "/_container" in name:
        return None
    return None if kind.startswith("lifecycle_msgs/") or name.startswith(("a/", "THE_")) else (name, kind, role)


@contextmanager
def _recording(topics: dict[tuple[str, str], list[str]], names: list[str]) -> Iterator[None]:
    def recorder(create: Callable[..., Any], role: str) -> Callable[..., Any]:
        def creating(node: Node, kind: Any, name: str, *arguments: Any, **options: Any) -> Any:
            names.append(node.get_name())
            shown = _shown(name, _type_name(kind), role)
            if shown is not None:
                topics.setdefault((shown[0], shown[2]), list(shown))
            return create(node, kind, name, *arguments, **options)

        return creating

    with ExitStack() as stack:
        for method, role in _CREATORS.items():
            stack.enter_context(mock.patch.object(Node, method, recorder(getattr(Node, method), role)))
        yield


def _order(key: tuple[str, str]) -> tuple[bool, bool, str]:
    """Return the sort key of an endpoint: topics first, and topics of transforms after the others."""
    return key[1] not in ("publisher", "subscription"), key[0].startswith("/tf"), key[0]


def _endpoints() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the package and executable of each node, with the node's name and endpoints."""
    for package, executable in sorted(EXECUTABLES):
        topics: dict[tuple[str, str], list[str]] = {}
        names: list[str] = []
        if not executable.endswith(_LEFT_OUT) and not package.startswith(_PACKAGES_LEFT_OUT):
            with _recording(topics, names):
                _start((package, executable), _NEEDED.get(executable, {}), ParameterRules())
        for name, kind, role in _MORE.get(f"{package}/{executable}", ()):
            topics.setdefault((name, role), [name, kind, role])
        if topics:
            node = names[0] if names else executable
            yield (
                f"{package}/{executable}",
                {"node": node, "topics": [topics[key] for key in sorted(topics, key=_order)]},
            )


async def _table() -> str:
    lines = [f" {json.dumps(name)}: {json.dumps(entry)}" for name, entry in _endpoints()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def main(words: list[str]) -> int:
    """Write the table, or check it, and return the exit status."""
    with redirect_stderr(StringIO()), redirect_stdout(StringIO()):  # the logs of the nodes
        text = asyncio.run(_table())
    if words == ["--check"]:
        if LIST.read_text(encoding="utf-8") == text:
            return 0
        print(f"{LIST.relative_to(ROOT)} is stale: run `python tools/node_topics.py`", file=sys.stderr)
        return 1
    LIST.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
