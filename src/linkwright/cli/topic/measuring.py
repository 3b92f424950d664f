"""What the verbs share that measure a topic: a window of messages, and a report each second until the user ends it."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from linkwright.cli.numbers import positive_int
from linkwright.cli.qos import fitting_profile

if TYPE_CHECKING:
    from linkwright.cli.session import Session

_PERIOD = 1.0


def add_window_argument(parser: argparse.ArgumentParser, default: int) -> None:
    """Declare over how many messages it is measured."""
    parser.add_argument(
        "-w",
        "--window",
        metavar="N",
        type=positive_int,
        default=default,
        help="over how many messages it is taken (default: %(default)s)",
    )


def subscribe(
    session: Session,
    arguments: argparse.Namespace,
    message_type: Any,
    name: str,
    callback: Callable[..., object],
    *,
    raw: bool,
) -> None:
    """Receive a topic with the QoS that was asked for, or that its publishers have.

    Args:
        session: of the verb.
        arguments: with those of `add_subscription_qos_arguments`.
        message_type: the class of the messages.
        name: absolute.
        callback: is given each message, and what is known of it beside if it takes that; its errors end the verb.
        raw: whether it is given the bytes, and no message is made of them.
    """
    profile = fitting_profile(session.node, name, arguments)
    session.node.create_subscription(message_type, name, session.receiver(callback), profile, raw=raw)


async def report_until_finished(session: Session, text: Callable[[], str | None]) -> int:
    """Print a text each second, when there is one, until the verb is done; the exit status."""

    def report() -> None:
        said = text()
        if said is not None:
            print(said)

    session.every(_PERIOD, report)
    return await session.finished() or 0
