"""Finding what a user names in the running graph, and saying what is near when it is not there."""

from __future__ import annotations

import asyncio
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, phrase, quoted

if TYPE_CHECKING:
    from linkwright.cli.session import Session

NamesAndTypes = Sequence[tuple[str, Sequence[str]]]

_POLL = 0.1


def visible(found: NamesAndTypes, *, hidden: bool) -> list[tuple[str, list[str]]]:
    """Names with their types, sorted; those hidden only when they are asked for."""
    from linkwright.graph.names.rules import is_hidden

    return [(name, list(types)) for name, types in sorted(found) if hidden or not is_hidden(name)]


def absolute(name: str) -> str:
    """A name as the graph has it: with its leading slash.

    Raises:
        InvalidNameError: it is no name.
    """
    from linkwright.graph.names.rules import expand_topic_name

    return expand_topic_name(name, "ros2cli", "/")


def unknown(code: str, message: Phrase, name: str, known: Iterable[str], nothing: Phrase) -> LinkwrightError:
    """The error for a name that the graph does not have.

    Args:
        code: of the diagnostic.
        message: what is said of it; ros2's words where it has some.
        name: as it was given.
        known: the names that there are.
        nothing: the hint when none is near.
    """
    candidates = list(known)
    by_end = [candidate for candidate in candidates if candidate.endswith("/" + name.strip("/").rpartition("/")[2])]
    hint = did_you_mean(absolute_or_given(name), candidates)
    if hint is None and by_end:
        hint = phrase("did you mean {names}?", names=quoted(by_end[0]))
    return LinkwrightError(Diagnostic(code, message, hint=hint or nothing))


def absolute_or_given(name: str) -> str:
    """A name with a leading slash, whether it is valid or not."""
    return name if name.startswith("/") else f"/{name}"


async def topic_types(session: Session, name: str, *, wait: bool) -> list[str]:
    """The types that a topic carries.

    Args:
        session: of the verb.
        name: absolute.
        wait: whether to wait for a topic that is not there yet, as ``ros2 topic hz`` does.

    Raises:
        LinkwrightError: CLI411, there is no such topic, and `wait` is not set.
    """
    types = _types_of(session, name)
    if types:
        return types
    print(f"WARNING: topic [{name}] does not appear to be published yet", file=sys.stderr)
    if not wait:
        known = [each for each, _ in session.node.get_topic_names_and_types()]
        nothing = phrase("give the type of its messages to wait for it, or look at `linkwright topic list`")
        message = phrase("Could not determine the type for the passed topic '{name}'", name=name)
        raise unknown("CLI411", message, name, known, nothing)
    while not types:
        await asyncio.sleep(_POLL)
        types = _types_of(session, name)
    return types


async def topic_type(
    session: Session, name: str, given: str | None = None, *, wait: bool = False, raw: bool = False
) -> Any:
    """The class of a topic's messages.

    Args:
        session: of the verb.
        name: absolute.
        given: the type's name, where the user gave it.
        wait: see `topic_types`.
        raw: whether the messages' bytes are all that is wanted; of a type that no package here has its name is given.

    Raises:
        LinkwrightError: MSG101, there is no such type; CLI411 as `topic_types`; CLI412, the topic has several types.
    """
    if given is not None:
        return _message_class(given, raw=raw)
    types = await topic_types(session, name, wait=wait)
    if len(types) > 1:
        message = phrase(
            "Cannot echo topic '{name}', as it contains more than one type: [{types}]",
            name=name,
            types=", ".join(types),
        )
        hint = phrase("name the one that is meant behind the topic; `linkwright doctor` tells who uses which")
        raise LinkwrightError(Diagnostic("CLI412", message, hint=hint))
    return _message_class(types[0], raw=raw)


def _message_class(name: str, *, raw: bool) -> Any:
    from linkwright.messages import InterfaceNotFoundError, get_message

    try:
        return get_message(name)
    except InterfaceNotFoundError:
        if raw and name.count("/") == 2:
            return name
        raise


def _types_of(session: Session, name: str) -> list[str]:
    return list(dict(session.node.get_topic_names_and_types()).get(name, ()))
