"""Lookup of graph names given by the user, with suggestions for unknown names."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase, quoted

if TYPE_CHECKING:
    from linkwright.cli.session import Session

NamesAndTypes = Sequence[tuple[str, Sequence[str]]]

_POLL_INTERVAL_S = 0.1


def sort_visible_names(names_and_types: NamesAndTypes, *, hidden: bool) -> list[tuple[str, list[str]]]:
    """Return names and types, sorted by name, without hidden names unless `hidden` is set."""
    from linkwright.graph.names.rules import is_hidden

    return [(name, list(types)) for name, types in sorted(names_and_types) if hidden or not is_hidden(name)]


def make_absolute(name: str) -> str:
    """Return a graph name with a leading slash.

    Raises:
        InvalidNameError: the name is not valid.
    """
    from linkwright.graph.names.rules import expand_topic_name

    return expand_topic_name(name, "ros2cli", "/")


def unknown_name_error(
    code: str, message: Phrase, name: str, existing_names: Iterable[str], fallback_hint: Phrase
) -> LinkwrightError:
    """Return the error for a name that is not in the graph.

    Args:
        code: the code of the diagnostic.
        message: the message, with ros2's wording if ros2 has a message for this error.
        name: the name that the user gave.
        existing_names: the existing names, for suggestions.
        fallback_hint: the hint if no existing name is similar.
    """
    candidates = list(existing_names)
    same_base_names = [
        candidate for candidate in candidates if candidate.endswith("/" + name.strip("/").rpartition("/")[2])
    ]
    hint = did_you_mean(add_leading_slash(name), candidates)
    if hint is None and same_base_names:
        hint = phrase("did you mean {names}?", names=quoted(same_base_names[0]))
    return LinkwrightError(Diagnostic(code, message, hint=hint or fallback_hint))


def add_leading_slash(name: str) -> str:
    """Return a name with a leading slash, without checking whether the name is valid."""
    return name if name.startswith("/") else f"/{name}"


async def find_topic_types(session: Session, name: str, *, wait: bool) -> list[str]:
    """Return the types of a topic.

    Args:
        session: the session of the command.
        name: the absolute name.
        wait: whether to wait for a topic that does not exist yet, as ``ros2 topic hz`` does.

    Raises:
        LinkwrightError: CLI411, there is no such topic, and `wait` is not set.
    """
    types = _list_types(session, name)
    if types:
        return types
    print(f"WARNING: topic [{name}] does not appear to be published yet", file=sys.stderr)
    if not wait:
        topic_names = [topic for topic, _ in session.node.get_topic_names_and_types()]
        hint = phrase("pass the message type to wait for the topic, or run `linkwright topic list` to list the topics")
        message = phrase("Could not determine the type for the passed topic '{name}'", name=name)
        raise unknown_name_error("CLI411", message, name, topic_names, hint)
    while not types:
        await asyncio.sleep(_POLL_INTERVAL_S)
        types = _list_types(session, name)
    return types


async def find_message_class(
    session: Session, name: str, type_name: str | None = None, *, wait: bool = False, raw: bool = False
) -> Any:
    """Return the message class of a topic.

    Args:
        session: the session of the command.
        name: the absolute name of the topic.
        type_name: the name of the type, if the user specified one.
        wait: whether to wait for a topic that does not exist yet.
        raw: whether the command needs only serialized messages; if so, the result for an unknown type is its name.

    Raises:
        LinkwrightError: MSG101, there is no such type; CLI411, there is no such topic, and `wait` is not set; CLI412,
            the topic has several types.
    """
    if type_name is not None:
        return _import_message_class(type_name, raw=raw)
    types = await find_topic_types(session, name, wait=wait)
    if len(types) > 1:
        message = phrase(
            "Cannot echo topic '{name}', as it contains more than one type: [{types}]",
            name=name,
            types=", ".join(types),
        )
        hint = phrase("pass the type after the topic; `linkwright doctor` shows the type that each node uses")
        raise LinkwrightError(Diagnostic("CLI412", message, hint=hint))
    return _import_message_class(types[0], raw=raw)


def _import_message_class(name: str, *, raw: bool) -> Any:
    from linkwright.messages import InterfaceNotFoundError, get_message

    try:
        return get_message(name)
    except InterfaceNotFoundError:
        if raw and name.count("/") == 2:
            return name
        raise


def _list_types(session: Session, name: str) -> list[str]:
    return list(dict(session.node.get_topic_names_and_types()).get(name, ()))
