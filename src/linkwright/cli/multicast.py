"""``linkwright multicast``: test multicast on the network with one datagram."""

from __future__ import annotations

import argparse
from ipaddress import AddressValueError, IPv4Address

from linkwright.cli.nested import SubVerb, configure_nested, run_nested
from linkwright.cli.numbers import positive_int
from linkwright.wire import multicast

_GREETING = b"Hello World!"
_MAX_PORT = 0xFFFF
_MAX_TTL = 0xFF


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the subcommands of ``multicast``."""
    configure_nested(parser, VERBS)


def run(arguments: argparse.Namespace) -> int:
    """Run the requested subcommand."""
    return run_nested(arguments)


def parse_multicast_group(text: str) -> str:
    """Parse the IPv4 address of a multicast group.

    Raises:
        argparse.ArgumentTypeError: the text is not such an address.
    """
    try:
        is_group = IPv4Address(text).is_multicast
    except AddressValueError:
        is_group = False
    if not is_group:
        raise argparse.ArgumentTypeError("value must be an address from 224.0.0.0 to 239.255.255.255")
    return text


def parse_port(text: str) -> int:
    """Parse a UDP port.

    Raises:
        argparse.ArgumentTypeError: the text is not a port number.
    """
    return _parse_up_to(_MAX_PORT, text)


def parse_time_to_live(text: str) -> int:
    """Parse the time to live of IP packets.

    Raises:
        argparse.ArgumentTypeError: the text is not a valid time to live.
    """
    return _parse_up_to(_MAX_TTL, text)


def _parse_up_to(maximum: int, text: str) -> int:
    value = positive_int(text)
    if value > maximum:
        raise argparse.ArgumentTypeError(f"value must be from 1 to {maximum}")
    return value


def add_ttl_argument(parser: argparse.ArgumentParser) -> None:
    """Declare the option ``--ttl``, the time to live of multicast packets."""
    parser.add_argument(
        "--ttl", type=parse_time_to_live, help="TTL of the datagrams (default: 1, which routers do not forward)"
    )


def _configure_receive(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--group",
        type=parse_multicast_group,
        default=multicast.DEFAULT_GROUP,
        help="the multicast group (default: %(default)s)",
    )
    parser.add_argument(
        "--port", type=parse_port, default=multicast.DEFAULT_PORT, help="the UDP port (default: %(default)s)"
    )


def _configure_send(parser: argparse.ArgumentParser) -> None:
    _configure_receive(parser)
    add_ttl_argument(parser)


def _receive(arguments: argparse.Namespace) -> int:
    with multicast.open_receiver(arguments.group, arguments.port) as receiver:
        print("Waiting for UDP multicast datagram...", flush=True)
        data, (host, port, *_) = receiver.recvfrom(multicast.MAX_DATAGRAM_BYTES)
    print(f"Received from {host}:{port}: '{data.decode(errors='replace')}'")
    return 0


def _send(arguments: argparse.Namespace) -> int:
    print("Sending one UDP multicast datagram...", flush=True)
    with multicast.open_sender(arguments.ttl) as sender:
        multicast.send(sender, _GREETING, arguments.group, arguments.port)
    return 0


VERBS = {
    "receive": SubVerb(_configure_receive, _receive, help="wait for one datagram and print it"),
    "send": SubVerb(_configure_send, _send, help="send one datagram"),
}
