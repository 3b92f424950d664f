"""``linkwright bag record``: record the messages of topics."""

from __future__ import annotations

import argparse
import signal
import sys
from datetime import datetime
from typing import TYPE_CHECKING

from linkwright.cli.bag.options import add_overrides_argument, read_overrides

if TYPE_CHECKING:
    from linkwright.bag import BagWriter, TopicSelection
    from linkwright.cli.session import Session

_USAGE_ERROR = 2
_CACHE_SIZE = 100 * 1024 * 1024
"""The default cache size of ros2, in bytes."""


def configure_record(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``bag record``."""
    parser.add_argument("names", metavar="TOPIC", nargs="*", help="the topics to record")
    parser.add_argument(
        "--topics",
        metavar="TOPIC",
        nargs="+",
        default=[],
        help="the topics to record (the option's name in newer ROS 2 releases)",
    )
    parser.add_argument(
        "--topic-types", metavar="TYPE", nargs="+", default=[], help="record every topic of these types"
    )
    parser.add_argument(
        "--services",
        metavar="SERVICE",
        nargs="+",
        default=[],
        help="record the events of these services (service introspection)",
    )
    parser.add_argument(
        "-a", "--all", action="store_true", help="record all topics except hidden ones, and the events of all services"
    )
    parser.add_argument("--all-topics", action="store_true", help="record all topics except hidden ones")
    parser.add_argument(
        "--all-services", action="store_true", help="record the events of all services (service introspection)"
    )
    parser.add_argument(
        "-e", "--regex", metavar="PATTERN", default="", help="record topics whose names match this regular expression"
    )
    parser.add_argument(
        "-x",
        "--exclude",
        "--exclude-regex",
        metavar="PATTERN",
        default="",
        help="do not record topics whose names match this regular expression",
    )
    parser.add_argument("--exclude-topics", metavar="TOPIC", nargs="+", default=[], help="do not record these topics")
    parser.add_argument(
        "--exclude-services", metavar="SERVICE", nargs="+", default=[], help="do not record these services"
    )
    parser.add_argument(
        "--exclude-topic-types", metavar="TYPE", nargs="+", default=[], help="do not record topics of these types"
    )
    parser.add_argument("--include-hidden-topics", action="store_true", help="also record hidden topics")
    parser.add_argument(
        "--include-unpublished-topics", action="store_true", help="also record topics that have only subscriptions"
    )
    parser.add_argument("--ignore-leaf-topics", action="store_true", help="do not record topics without subscriptions")
    parser.add_argument("--no-discovery", action="store_true", help="record only topics that exist at the start")
    parser.add_argument(
        "-p",
        "--polling-interval",
        metavar="MILLISECONDS",
        type=int,
        default=100,
        help="the time between searches for new topics, default 100",
    )
    parser.add_argument(
        "-o", "--output", metavar="FOLDER", help="the folder to create, default rosbag2_ and the date and time"
    )
    parser.add_argument(
        "-s", "--storage", choices=("mcap", "sqlite3"), default="mcap", help="the file format, default mcap"
    )
    parser.add_argument(
        "--compression-mode",
        choices=("none", "file", "message", "storage"),
        default="none",
        help="compression with zstd: none, of entire files, of each message, or of the chunks of an MCAP file",
    )
    parser.add_argument(
        "--compression-format", choices=("zstd",), help="accepted for compatibility with ros2; zstd is the only format"
    )
    parser.add_argument(
        "-b",
        "--max-bag-size",
        metavar="BYTES",
        type=_parse_count,
        default=0,
        help="start a new file after this many bytes",
    )
    parser.add_argument(
        "-d",
        "--max-bag-duration",
        metavar="SECONDS",
        type=_parse_count,
        default=0,
        help="start a new file after this many seconds",
    )
    parser.add_argument(
        "--max-cache-size",
        metavar="BYTES",
        type=_parse_count,
        default=_CACHE_SIZE,
        help="the memory for --snapshot-mode, default 100 MiB; it has no effect without that option",
    )
    parser.add_argument(
        "--snapshot-mode",
        action="store_true",
        help="keep the latest messages in memory, and write them when the service ~/snapshot is called",
    )
    parser.add_argument(
        "--custom-data",
        metavar="KEY=VALUE",
        type=_parse_key_value_pair,
        nargs="*",
        default=[],
        help="custom entries for the metadata",
    )
    parser.add_argument("--start-paused", action="store_true", help="start paused; the space key resumes")
    parser.add_argument("--use-sim-time", action="store_true", help="record messages with the time of /clock")
    parser.add_argument(
        "--node-name", metavar="NAME", default="rosbag2_recorder", help="the node's name, default rosbag2_recorder"
    )
    parser.add_argument("--disable-keyboard-controls", action="store_true", help="ignore the keyboard")
    add_overrides_argument(parser)
    for names, metavar in (
        (("-f", "--serialization-format"), "FORMAT"),
        (("--storage-preset-profile",), "NAME"),
        (("--storage-config-file",), "FILE"),
        (("--compression-queue-size",), "N"),
        (("--compression-threads",), "N"),
        (("--compression-threads-priority",), "N"),
        (("--log-level",), "LEVEL"),
    ):
        parser.add_argument(*names, metavar=metavar, help="accepted for compatibility with ros2; has no effect")


def run_record(arguments: argparse.Namespace) -> int:
    """Record until the user interrupts the command, and return the exit status."""
    from linkwright.cli.session import run_in_graph
    from linkwright.hosting.signals import SignalWatch

    selection = _read_selection(arguments)
    if selection.is_empty:
        print("linkwright bag record: pass topics, -a for all topics, or --regex", file=sys.stderr)
        return _USAGE_ERROR
    if arguments.storage != "mcap" and arguments.compression_mode == "storage":
        print("linkwright bag record: only MCAP files have chunks to be compressed", file=sys.stderr)
        return _USAGE_ERROR
    if arguments.snapshot_mode and not arguments.max_cache_size:
        print("linkwright bag record: --snapshot-mode needs a --max-cache-size above 0", file=sys.stderr)
        return _USAGE_ERROR
    if arguments.polling_interval <= 0:
        print("linkwright bag record: the polling interval must be positive", file=sys.stderr)
        return _USAGE_ERROR
    overrides = read_overrides(arguments)

    async def job(session: Session) -> int:
        from linkwright.bag import Recorder, RecorderServices
        from linkwright.cli.bag.keys import SPACE, reading_keys

        with _create_writer(arguments) as writer:
            recorder = Recorder(
                session.node,
                selection,
                writer,
                overrides=overrides,
                discover=not arguments.no_discovery,
                polling_seconds=arguments.polling_interval / 1000,
                without_publishers=arguments.include_unpublished_topics,
                without_subscriptions=not arguments.ignore_leaf_topics,
                paused=arguments.start_paused,
                wrap_callback=session.guard,
            )
            RecorderServices(session.node, recorder, writer, snapshots=arguments.snapshot_mode)
            keys = {} if arguments.disable_keyboard_controls else {SPACE: recorder.toggle_paused}
            try:
                with reading_keys(keys) as keyboard_active:
                    if keyboard_active and keys:
                        session.node.get_logger().info("Press SPACE for pausing/resuming")
                    return await session.wait_until_finished() or 0
            finally:
                recorder.close()

    signals = SignalWatch()
    try:
        status = run_in_graph(arguments, job, node_name=arguments.node_name, signals=signals)
    except KeyboardInterrupt:
        status = 0
    interrupted = signals.received in (None, signal.SIGINT)  # SIGINT is the usual way to end a recording
    return status if interrupted else signals.exit_status or status


def _read_selection(arguments: argparse.Namespace) -> TopicSelection:
    from linkwright.bag import TopicSelection

    return TopicSelection(
        all_topics=arguments.all or arguments.all_topics,
        names=_make_absolute(*arguments.names, *arguments.topics),
        types=arguments.topic_types,
        pattern=arguments.regex,
        without_names=_make_absolute(*arguments.exclude_topics),
        without_types=arguments.exclude_topic_types,
        without_pattern=arguments.exclude,
        include_hidden=arguments.include_hidden_topics,
        all_services=arguments.all or arguments.all_services,
        services=_make_absolute(*arguments.services),
        without_services=_make_absolute(*arguments.exclude_services),
    )


def _create_writer(arguments: argparse.Namespace) -> BagWriter:
    from linkwright.bag import BagWriter

    return BagWriter(
        arguments.output or f"rosbag2_{datetime.now().astimezone():%Y_%m_%d-%H_%M_%S}",
        arguments.storage,
        compression=arguments.compression_mode,
        max_size=arguments.max_bag_size,
        max_seconds=arguments.max_bag_duration,
        snapshot_size=arguments.max_cache_size if arguments.snapshot_mode else 0,
        custom_data=dict(arguments.custom_data),
    )


def _parse_count(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"'{text}' is not an integer of at least 0")
    return int(text)


def _parse_key_value_pair(text: str) -> tuple[str, str]:
    key, separator, value = text.partition("=")
    if not separator or not key:
        raise argparse.ArgumentTypeError(f"'{text}' is not KEY=VALUE")
    return key, value


def _make_absolute(*names: str) -> list[str]:
    return [f"/{name.lstrip('/')}" for name in names]
