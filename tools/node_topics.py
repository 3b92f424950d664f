"""Write the table of topics, services and actions of nodes, for the language server and reviews.

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

from node_parameters import _EXCLUDED_EXECUTABLES, _EXCLUDED_PACKAGES, _REQUIRED_PARAMETERS, _ROBOT, _start_node

from linkwright.graph import Node
from linkwright.graph.parameters.parameter import ParameterRules
from linkwright.nodes.options import EXECUTABLES

ROOT = Path(__file__).resolve().parent.parent
TABLE_FILE = ROOT / "src" / "linkwright" / "nodes" / "node_topics.json"

_PARAMETERS: Mapping[str, Mapping[str, Any]] = {
    **_REQUIRED_PARAMETERS,
    "move_group": {"robot_description": _ROBOT, "robot_description_semantic": "<robot name='a'/>"},
}
"""Parameters without which nodes do not create their endpoints."""
_CREATORS = {
    "create_publisher": "publisher",
    "create_subscription": "subscription",
    "create_service": "service",
    "create_client": "client",
}
_EXAMPLE_NAMES = frozenset({"a", "b", "THE_ITEM"})
"""Names from the parameters that nodes need to start."""
_COMMON_ENDPOINTS = ("/rosout", "/parameter_events", "~/describe_parameters", "~/get_param", "~/list_parameters")
_ADDITIONAL_ENDPOINTS: Mapping[str, list[tuple[str, str, str]]] = {
    "robot_state_publisher/robot_state_publisher": [("joint_states", "sensor_msgs/msg/JointState", "subscription")],
    "teleop_twist_keyboard/teleop_twist_keyboard": [("cmd_vel", "geometry_msgs/msg/Twist", "publisher")],
    "controller_manager/ros2_control_node": [("~/robot_description", "std_msgs/msg/String", "subscription")],
}
"""Names that a node creates only under conditions, such as with a terminal."""


def _get_type_name(kind: Any) -> str:
    if isinstance(kind, str):
        return kind
    module, _, _ = kind.__module__.partition(".")
    part = next((part for part in ("msg", "srv", "action") if f".{part}" in f".{kind.__module__}"), "msg")
    return f"{module}/{part}/{kind.__name__}"


def _describe_endpoint(name: str, kind: str, role: str) -> tuple[str, str, str] | None:
    """Return the name, type and role of an endpoint, or None if it is not listed.

    Endpoints of every node and parts of an action are not listed.
    """
    name, is_action, part = name.partition("/_action/")
    if is_action:
        of_server = role == "publisher"
        is_shown = part == "feedback"
        role = "action server" if of_server else "action client"
        return (name, kind.removesuffix("_FeedbackMessage"), role) if is_shown else None
    if name in _EXAMPLE_NAMES or name.startswith(_COMMON_ENDPOINTS) or "_parameter" in name or "/_container" in name:
        return None
    return None if kind.startswith("lifecycle_msgs/") or name.startswith(("a/", "THE_")) else (name, kind, role)


@contextmanager
def _record_endpoints(topics: dict[tuple[str, str], list[str]], names: list[str]) -> Iterator[None]:
    def recorder(create: Callable[..., Any], role: str) -> Callable[..., Any]:
        def creating(node: Node, kind: Any, name: str, *arguments: Any, **options: Any) -> Any:
            names.append(node.get_name())
            shown = _describe_endpoint(name, _get_type_name(kind), role)
            if shown is not None:
                topics.setdefault((shown[0], shown[2]), list(shown))
            return create(node, kind, name, *arguments, **options)

        return creating

    with ExitStack() as stack:
        for method, role in _CREATORS.items():
            stack.enter_context(mock.patch.object(Node, method, recorder(getattr(Node, method), role)))
        yield


def _make_sort_key(key: tuple[str, str]) -> tuple[bool, bool, str]:
    """Return the sort key of an endpoint: topics first, those of transforms after others."""
    return key[1] not in ("publisher", "subscription"), key[0].startswith("/tf"), key[0]


def _iterate_endpoints() -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield the package and executable of each node, with the node's name and endpoints."""
    for package, executable in sorted(EXECUTABLES):
        topics: dict[tuple[str, str], list[str]] = {}
        names: list[str] = []
        if not executable.endswith(_EXCLUDED_EXECUTABLES) and not package.startswith(_EXCLUDED_PACKAGES):
            with _record_endpoints(topics, names):
                _start_node((package, executable), _PARAMETERS.get(executable, {}), ParameterRules())
        for name, kind, role in _ADDITIONAL_ENDPOINTS.get(f"{package}/{executable}", ()):
            topics.setdefault((name, role), [name, kind, role])
        if topics:
            node = names[0] if names else executable
            yield (
                f"{package}/{executable}",
                {"node": node, "topics": [topics[key] for key in sorted(topics, key=_make_sort_key)]},
            )


async def _format_table() -> str:
    lines = [f" {json.dumps(name)}: {json.dumps(entry)}" for name, entry in _iterate_endpoints()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


def main(words: list[str]) -> int:
    """Write the table, or check it, and return the exit status."""
    with redirect_stderr(StringIO()), redirect_stdout(StringIO()):  # the logs of the nodes
        text = asyncio.run(_format_table())
    if words == ["--check"]:
        if TABLE_FILE.read_text(encoding="utf-8") == text:
            return 0
        print(f"{TABLE_FILE.relative_to(ROOT)} is stale: run `python tools/node_topics.py`", file=sys.stderr)
        return 1
    TABLE_FILE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
