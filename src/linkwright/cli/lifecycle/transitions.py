"""The states and transitions of managed nodes, asked of their services, and their texts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from linkwright.cli.calls import call, node_names

if TYPE_CHECKING:
    from linkwright.cli.session import Session

_GET_STATE = "lifecycle_msgs/srv/GetState"


def managed_nodes(session: Session, *, hidden: bool = False) -> list[str]:
    """Full names of the managed nodes, sorted: those that tell their state."""
    services = dict(session.node.get_service_names_and_types())
    names = dict.fromkeys(node_names(session, hidden=hidden))
    return [name for name in names if _GET_STATE in services.get(f"{name}/get_state", ())]


async def state(session: Session, node: str, timeout: float | None = None) -> Any:
    """The state (lifecycle_msgs/msg/State) of a node."""
    from linkwright.messages import get_service

    request = get_service(_GET_STATE).Request()
    return (await call(session, _GET_STATE, f"{node}/get_state", request, timeout=timeout)).current_state


async def transitions(session: Session, node: str, *, every: bool = False) -> Sequence[Any]:
    """Transitions of a node (lifecycle_msgs/msg/TransitionDescription): those of its state, or all of its graph."""
    from linkwright.messages import get_service

    kind = "lifecycle_msgs/srv/GetAvailableTransitions"
    service = "get_transition_graph" if every else "get_available_transitions"
    response = await call(session, kind, f"{node}/{service}", get_service(kind).Request())
    found: Sequence[Any] = response.available_transitions
    return found


async def change(session: Session, node: str, transition: Any) -> bool:
    """Have a node make a transition (lifecycle_msgs/msg/Transition); whether it came about."""
    from linkwright.messages import get_service

    kind = "lifecycle_msgs/srv/ChangeState"
    request = get_service(kind).Request()
    request.transition.id = transition.id
    request.transition.label = transition.label
    return bool((await call(session, kind, f"{node}/change_state", request)).success)


def transition_lines(descriptions: Sequence[Any]) -> list[str]:
    """What ``lifecycle list`` prints."""
    lines = []
    for each in descriptions:
        lines += [
            f"- {each.transition.label} [{each.transition.id}]",
            f"\tStart: {each.start_state.label}",
            f"\tGoal: {each.goal_state.label}",
        ]
    return lines
