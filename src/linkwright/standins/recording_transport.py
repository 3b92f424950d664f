"""The classes of ``rosbag2_py`` for recording, playback and rewriting."""

from __future__ import annotations

import datetime as dt
import enum
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

from linkwright.bag import BagReader, PlayerServices, RecorderServices, TopicSelection
from linkwright.bag import Player as _Playing
from linkwright.bag import PlayOptions as _BagPlayOptions
from linkwright.bag import Recorder as _Recording
from linkwright.bag.reindexing import reindex
from linkwright.bag.rewriting import rewrite
from linkwright.diagnostics import LinkwrightError
from linkwright.graph.endpoints.service import EVENT_TOPIC_SUFFIX
from linkwright.graph.log.logger import level_from_name
from linkwright.graph.qos.profile import QoSProfile
from linkwright.graph.time.values import Duration
from linkwright.standins.rclpy_api.context import Context
from linkwright.standins.rclpy_api.executors import SingleThreadedExecutor
from linkwright.standins.rclpy_api.node import Node
from linkwright.standins.recording_storage import StorageOptions
from linkwright.standins.recordings import create_writer

_POLL_INTERVAL_S = 0.1


class ServiceRequestsSource(enum.Enum):
    """The source of service requests for playback: introspection events of services or clients."""

    SERVICE_INTROSPECTION = 0
    CLIENT_INTROSPECTION = 1


@dataclass(slots=True)
class PlayOptions:
    """The options of playback.

    Options that only affect rosbag2's performance are ignored.
    """

    read_ahead_queue_size: int = 1000
    node_prefix: str = ""
    rate: float = 1.0
    topics_to_filter: list[str] = field(default_factory=list)
    services_to_filter: list[str] = field(default_factory=list)
    regex_to_filter: str = ""
    exclude_regex_to_filter: str = ""
    exclude_topics_to_filter: list[str] = field(default_factory=list)
    exclude_service_events_to_filter: list[str] = field(default_factory=list)
    topic_qos_profile_overrides: dict[str, QoSProfile] = field(default_factory=dict)
    loop: bool = False
    topic_remapping_options: list[str] = field(default_factory=list)
    clock_publish_frequency: float = 0.0
    clock_publish_on_topic_publish: bool = False
    clock_topics: list[str] = field(default_factory=list)
    delay: float = 0.0
    playback_duration: float = -1.0
    playback_until_timestamp: int = -1
    start_offset: float = 0.0
    start_paused: bool = False
    disable_keyboard_controls: bool = False
    wait_acked_timeout: int = -1
    disable_loan_message: bool = False
    publish_service_requests: bool = False
    service_requests_source: ServiceRequestsSource = ServiceRequestsSource.SERVICE_INTROSPECTION


@dataclass(slots=True)
class RecordOptions:
    """The options of recording.

    Options that only affect rosbag2's performance are ignored.
    """

    all_topics: bool = False
    all_services: bool = False
    is_discovery_disabled: bool = False
    topics: list[str] = field(default_factory=list)
    topic_types: list[str] = field(default_factory=list)
    exclude_topic_types: list[str] = field(default_factory=list)
    services: list[str] = field(default_factory=list)
    rmw_serialization_format: str = ""
    topic_polling_interval: dt.timedelta = dt.timedelta(milliseconds=100)
    regex: str = ""
    exclude_regex: str = ""
    exclude_topics: list[str] = field(default_factory=list)
    exclude_service_events: list[str] = field(default_factory=list)
    node_prefix: str = ""
    compression_mode: str = ""
    compression_format: str = ""
    compression_queue_size: int = 1
    compression_threads: int = 0
    compression_threads_priority: int = 0
    topic_qos_profile_overrides: dict[str, QoSProfile] = field(default_factory=dict)
    include_hidden_topics: bool = False
    include_unpublished_topics: bool = False
    ignore_leaf_topics: bool = False
    start_paused: bool = False
    use_sim_time: bool = False
    disable_keyboard_controls: bool = False
    all: bool = False
    """The name of `all_topics` in Humble."""
    exclude: str = ""
    """The name of `exclude_regex` in Humble."""

    @property
    def selection(self) -> TopicSelection:
        """The selection of topics.

        As in ``ros2bag``, a service is selected by its event topic.
        """
        return TopicSelection(
            all_topics=self.all_topics or self.all,
            names=_to_absolute_names(self.topics),
            types=self.topic_types,
            pattern=self.regex,
            without_names=_to_absolute_names(self.exclude_topics),
            without_types=self.exclude_topic_types,
            without_pattern=self.exclude_regex or self.exclude,
            include_hidden=self.include_hidden_topics,
            all_services=self.all_services,
            services=_find_service_names(self.services),
            without_services=_find_service_names(self.exclude_service_events),
        )


class _Transport:
    """The base class of recorders and players. Each runs a node in a separate context."""

    _cancelled: ClassVar[threading.Event]

    def __init_subclass__(cls) -> None:
        cls._cancelled = threading.Event()

    def __init__(self, log_level: str = "info") -> None:
        """Create a recorder or player with a log level.

        Raises:
            RuntimeError: there is no such level.
        """
        if level_from_name(log_level) is None:
            raise RuntimeError(f"Couldn't parse log level '{log_level}'")
        self._arguments = ["--ros-args", "--log-level", log_level]
        self._cancelled.clear()

    @classmethod
    def cancel(cls) -> None:
        """Cancel the current run, from any thread."""
        cls._cancelled.set()

    @contextmanager
    def _running(self, name: str, *arguments: str) -> Iterator[tuple[Node, Callable[[Callable[[], bool]], None]]]:
        """Create a node for the duration of the context.

        Yields:
            The node, and a function that runs the node's callbacks until a condition is true or the run is cancelled.

        Raises:
            RuntimeError: a recording cannot be opened or created.
        """
        context = Context()
        context.init([*self._arguments, *arguments])
        try:
            node = Node(name, context=context)
            executor = SingleThreadedExecutor(context=context)
            executor.add_node(node)

            def spin_until(is_done: Callable[[], bool]) -> None:
                while not (is_done() or self._cancelled.is_set()) and context.ok():
                    executor.spin_once(timeout_sec=_POLL_INTERVAL_S)

            yield node, spin_until
        except LinkwrightError as error:
            raise RuntimeError(str(error)) from error
        finally:
            context.try_shutdown()
            self._cancelled.clear()  # not at the start, because another thread may cancel before the run begins


class Recorder(_Transport):
    """A recorder of topics, which runs until `cancel` is called."""

    def record(
        self, storage_options: StorageOptions, record_options: RecordOptions, node_name: str = "rosbag2_recorder"
    ) -> None:
        """Record until `cancel` is called or Ctrl-C is pressed.

        Raises:
            RuntimeError: the folder already exists, or there is no such storage.
        """
        parameters = ("-p", "use_sim_time:=true") if record_options.use_sim_time else ()
        with self._running(node_name, *parameters) as (node, spin_until):
            writer = create_writer(storage_options, record_options.compression_mode)
            recorder = _Recording(
                node,
                record_options.selection,
                writer,
                overrides=record_options.topic_qos_profile_overrides,
                discover=not record_options.is_discovery_disabled,
                polling_seconds=record_options.topic_polling_interval.total_seconds(),
                without_publishers=record_options.include_unpublished_topics,
                without_subscriptions=not record_options.ignore_leaf_topics,
                paused=record_options.start_paused,
            )
            RecorderServices(node, recorder, writer, snapshots=storage_options.snapshot_mode)
            try:
                spin_until(lambda: False)
            finally:
                recorder.close()


class Player(_Transport):
    """A player of recordings."""

    def play(self, storage_options: StorageOptions, play_options: PlayOptions) -> None:
        """Play a recording until it ends or `cancel` is called.

        Raises:
            RuntimeError: there is no such recording or topic, or the recording is damaged.
        """
        self._play(storage_options, play_options, None)

    def burst(self, storage_options: StorageOptions, play_options: PlayOptions, num_messages: int) -> None:
        """Publish the first messages as fast as possible, then pause until `cancel` is called.

        Raises:
            RuntimeError: see `play`.
        """
        self._play(storage_options, play_options, num_messages)

    def _play(self, storage_options: StorageOptions, options: PlayOptions, burst_count: int | None) -> None:
        remapping_arguments = [
            argument for rule in options.topic_remapping_options for argument in _to_remapping_arguments(rule)
        ]
        with (
            self._running("rosbag2_player", *remapping_arguments) as (node, spin_until),
            BagReader(storage_options.uri) as bag,
        ):
            player = _Playing(
                node, bag, _to_bag_play_options(options, paused=options.start_paused or burst_count is not None)
            )
            PlayerServices(node, player)
            try:
                player.start()
                if burst_count is not None:
                    player.burst(burst_count)
                spin_until(lambda: player.finished)
            finally:
                player.close()
            for publisher in player.publishers if options.wait_acked_timeout >= 0 else ():
                publisher.wait_for_all_acked(Duration(nanoseconds=options.wait_acked_timeout * 1_000_000))


class Reindexer:
    """A tool that rebuilds the metadata of recordings."""

    def reindex(self, storage_options: StorageOptions) -> None:
        """Rebuild the ``metadata.yaml`` of a recording from its files.

        Raises:
            RuntimeError: the folder contains no files of a recording, or a file is damaged.
        """
        try:
            reindex(Path(storage_options.uri))
        except LinkwrightError as error:
            raise RuntimeError(str(error)) from error


def bag_rewrite(input_options: Sequence[StorageOptions], output_config_file: str) -> None:
    """Rewrite recordings as the key ``output_bags`` of a YAML file specifies.

    Raises:
        RuntimeError: a recording cannot be read or created, or the structure of the file is invalid.
    """
    if not input_options:
        raise RuntimeError("Must provide at least one input and one output bag to rewrite.")
    try:
        rewrite([input_option.uri for input_option in input_options], output_config_file)
    except LinkwrightError as error:
        raise RuntimeError(str(error)) from error


def _to_bag_play_options(options: PlayOptions, *, paused: bool) -> _BagPlayOptions:
    return _BagPlayOptions(
        rate=options.rate,
        topics=_to_absolute_names(options.topics_to_filter),
        excluded_topics=[
            *_to_absolute_names(options.exclude_topics_to_filter),
            *options.exclude_service_events_to_filter,
        ],
        pattern=options.regex_to_filter,
        without_pattern=options.exclude_regex_to_filter,
        loop=options.loop,
        clock_hz=options.clock_publish_frequency,
        clock_topics=_to_absolute_names(options.clock_topics),
        clock_before_all=options.clock_publish_on_topic_publish and not options.clock_topics,
        delay=options.delay,
        start_offset=options.start_offset,
        duration=None if options.playback_duration < 0 else options.playback_duration,
        until_ns=None if options.playback_until_timestamp < 0 else options.playback_until_timestamp,
        paused=paused,
        qos_overrides=options.topic_qos_profile_overrides,
    )


def _to_remapping_arguments(rule: str) -> list[str]:
    """Convert a remapping option to command-line arguments.

    ``--ros-args`` and ``--remap``, which rosbag2 also accepts in this option, are ignored.
    """
    return [] if rule.startswith("-") else ["--remap", rule]


def _to_absolute_names(names: Sequence[str]) -> list[str]:
    return [f"/{name.lstrip('/')}" for name in names]


def _find_service_names(topics: Sequence[str]) -> list[str]:
    return [name.removesuffix(EVENT_TOPIC_SUFFIX) for name in _to_absolute_names(topics)]
