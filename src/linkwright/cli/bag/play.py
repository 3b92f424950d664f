"""``linkwright bag play``: publish the messages of a recording."""

from __future__ import annotations

import argparse
import math
import sys
from typing import TYPE_CHECKING

from linkwright.cli.bag.options import add_overrides_argument, add_storage_argument, read_overrides
from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase, print_diagnostics

if TYPE_CHECKING:
    from linkwright.cli.session import Session

_RATE_STEP = 0.1
"""The change of the playback rate by one press of a key."""
_DEFAULT_CLOCK_HZ = 40.0


def configure_play(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``bag play``."""
    parser.add_argument("bag", metavar="BAG", help="the folder of a recording, or one .mcap or .db3 file")
    add_storage_argument(parser)
    parser.add_argument(
        "-r", "--rate", metavar="FACTOR", type=_parse_positive, default=1.0, help="the playback rate, default 1.0"
    )
    parser.add_argument("--topics", metavar="TOPIC", nargs="+", default=[], help="play only these topics")
    parser.add_argument("--exclude-topics", metavar="TOPIC", nargs="+", default=[], help="do not play these topics")
    parser.add_argument(
        "-e",
        "--regex",
        metavar="PATTERN",
        default="",
        help="play only topics whose names match this regular expression",
    )
    parser.add_argument(
        "-x",
        "--exclude",
        "--exclude-regex",
        metavar="PATTERN",
        default="",
        help="do not play topics whose names match this regular expression",
    )
    parser.add_argument("-l", "--loop", action="store_true", help="repeat the recording until Ctrl-C")
    parser.add_argument(
        "-m", "--remap", metavar="FROM:=TO", nargs="+", default=[], help="publish topics under other names"
    )
    parser.add_argument(
        "--clock",
        metavar="HZ",
        type=_parse_positive,
        nargs="?",
        const=_DEFAULT_CLOCK_HZ,
        default=0.0,
        help="publish the recording's time on /clock, at HZ (default: 40)",
    )
    parser.add_argument(
        "--clock-topics",
        metavar="TOPIC",
        nargs="+",
        default=[],
        help="publish /clock before each message of these topics",
    )
    parser.add_argument("--clock-topics-all", action="store_true", help="publish /clock before each message")
    parser.add_argument(
        "-d",
        "--delay",
        metavar="SECONDS",
        type=_parse_non_negative,
        default=0.0,
        help="wait this long before each playback of the recording",
    )
    parser.add_argument(
        "--start-offset",
        metavar="SECONDS",
        type=_parse_non_negative,
        default=0.0,
        help="start at this offset into the recording",
    )
    parser.add_argument(
        "--playback-duration",
        metavar="SECONDS",
        type=_parse_non_negative,
        help="play only this many seconds of the recording",
    )
    end_group = parser.add_mutually_exclusive_group()
    end_group.add_argument(
        "--playback-until-sec", metavar="SECONDS", type=float, help="stop at this time since the epoch"
    )
    end_group.add_argument(
        "--playback-until-nsec",
        metavar="NANOSECONDS",
        type=int,
        help="stop at this time since the epoch, in nanoseconds",
    )
    parser.add_argument("-p", "--start-paused", action="store_true", help="start paused; the space key resumes")
    parser.add_argument(
        "--wait-for-all-acked",
        metavar="MILLISECONDS",
        type=_parse_non_negative,
        default=1000.0,
        help="the time to wait at the end for reliable subscriptions to acknowledge all messages, default 1000",
    )
    parser.add_argument("--disable-keyboard-controls", action="store_true", help="ignore the keyboard")
    add_overrides_argument(parser)
    for name, metavar in (
        ("--read-ahead-queue-size", "N"),
        ("--storage-preset-profile", "NAME"),
        ("--storage-config-file", "FILE"),
    ):
        parser.add_argument(name, metavar=metavar, help="accepted for compatibility with ros2; has no effect")
    parser.add_argument("--disable-loan-message", action="store_true", help="accepted for compatibility with ros2")


def run_play(arguments: argparse.Namespace) -> int:
    """Play a recording until it ends or is interrupted, and return the exit status."""
    from linkwright.bag import BagReader, PlayOptions
    from linkwright.cli.session import run_in_graph

    options = PlayOptions(
        rate=arguments.rate,
        topics=[_to_absolute_name(name) for name in arguments.topics],
        pattern=arguments.regex,
        without_pattern=arguments.exclude,
        clock_topics=[_to_absolute_name(name) for name in arguments.clock_topics],
        clock_before_all=arguments.clock_topics_all,
        until_ns=_compute_until_ns(arguments),
        excluded_topics=[_to_absolute_name(name) for name in arguments.exclude_topics],
        loop=arguments.loop,
        clock_hz=arguments.clock,
        delay=arguments.delay,
        start_offset=arguments.start_offset,
        duration=arguments.playback_duration,
        paused=arguments.start_paused,
        qos_overrides=read_overrides(arguments),
    )
    remappings = [_parse_remapping(rule) for rule in arguments.remap]

    with BagReader(arguments.bag) as bag:
        print_diagnostics(bag.findings, sys.stderr)

        async def job(session: Session) -> int:
            from linkwright.bag import Player, PlayerServices
            from linkwright.cli.bag.keys import DOWN, RIGHT, SPACE, UP, reading_keys
            from linkwright.graph import Duration

            player = Player(session.node, bag, options)
            PlayerServices(session.node, player)
            keys = {
                SPACE: player.toggle_paused,
                RIGHT: player.play_next,
                UP: lambda: player.set_rate(player.rate + _RATE_STEP),
                DOWN: lambda: player.set_rate(max(_RATE_STEP, player.rate - _RATE_STEP)),
            }
            with reading_keys({} if arguments.disable_keyboard_controls else keys) as keyboard_active:
                if keyboard_active and not arguments.disable_keyboard_controls:
                    logger = session.node.get_logger()
                    logger.info("Press SPACE for Pause/Resume, CURSOR_RIGHT for the next message while paused")
                    logger.info("Press CURSOR_UP and CURSOR_DOWN to play 10 % faster and slower")
                player.start()
                try:
                    await session.wait_until(lambda: player.finished)
                finally:
                    player.close()
            for publisher in player.publishers:
                publisher.wait_for_all_acked(Duration(seconds=arguments.wait_for_all_acked / 1000))
            return 0

        return run_in_graph(arguments, job, node_name="rosbag2_player", remappings=remappings)


def _compute_until_ns(arguments: argparse.Namespace) -> int | None:
    """Return the time in nanoseconds at which playback stops, or None for no limit.

    As in ros2, a negative option means no limit.
    """
    until_ns: int | None = arguments.playback_until_nsec
    if arguments.playback_until_sec is not None:
        until_ns = round(arguments.playback_until_sec * 1e9)
    return None if until_ns is None or until_ns < 0 else until_ns


def _to_absolute_name(name: str) -> str:
    return f"/{name.lstrip('/')}"


def _parse_remapping(rule: str) -> tuple[str, str]:
    source, separator, target = rule.partition(":=")
    if not separator or not source or not target:
        raise LinkwrightError(
            Diagnostic(
                "CLI109", phrase("'{remapping}' is not a remapping", remapping=rule), hint=phrase("write FROM:=TO")
            )
        )
    return source, target


def _parse_positive(text: str) -> float:
    value = _parse_non_negative(text)
    if value == 0:
        raise argparse.ArgumentTypeError(f"{text} is not positive")
    return value


def _parse_non_negative(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value) or value < 0:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of at least 0")
    return value
