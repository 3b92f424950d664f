"""The configuration files of cartographer_ros.

A configuration is a file in Lua that returns a table. It includes Cartographer's own files, whose values Linkwright
brings. Sources: "Lua configuration reference documentation" and "Tuning methodology" of Cartographer ROS.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from math import inf
from pathlib import Path

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    Severity,
    SourceText,
    did_you_mean,
    display_path,
    foreign,
    missing_file_hint,
    phrase,
)
from linkwright.files.input_files import read_text
from linkwright.navigation.lua.reader import Environment, evaluate
from linkwright.navigation.lua.tables import Key, Place, Table, Value
from linkwright.navigation.slam.search import Search
from linkwright.navigation.slam.settings import MapperSettings
from linkwright.packages import get_package_share_path
from linkwright.packages.share_layout import find_substituted_share

_PACKAGE, _SUBFOLDER = "cartographer", "configuration_files"
"""The package and folder of the files that configurations include."""
_MIN_NODE_DISTANCE_M, _MIN_NODE_ANGLE_RAD = 0.3, 0.3
"""The smallest motion after which a scan is added to the map.

Cartographer merges scans into submaps, and accepts smaller ones. Here each scan is a node of the graph.
"""
_SCAN_BUFFER_SIZE = 16
"""The number of recent scans that a new scan is matched against: five meters of a drive."""
_NODE_OPTIONS = (
    *("map_builder", "trajectory_builder", "map_frame", "tracking_frame", "published_frame", "odom_frame"),
    *("provide_odom_frame", "publish_frame_projected_to_2d", "use_odometry", "use_nav_sat", "use_landmarks"),
    *("num_laser_scans", "num_multi_echo_laser_scans", "num_subdivisions_per_laser_scan", "num_point_clouds"),
    *("lookup_transform_timeout_sec", "submap_publish_period_sec", "pose_publish_period_sec"),
    *("trajectory_publish_period_sec", "rangefinder_sampling_ratio", "odometry_sampling_ratio"),
    *("fixed_frame_pose_sampling_ratio", "imu_sampling_ratio", "landmarks_sampling_ratio"),
)
"""The options that a configuration must have."""
_OPTIONAL = (
    *("publish_to_tf", "publish_tracked_pose", "use_pose_extrapolator", "ignore_out_of_order"),
    *("map_builder.pose_graph.overlapping_submaps_trimmer_2d", "trajectory_builder.pure_localization_trimmer"),
    *("trajectory_builder.pure_localization", "trajectory_builder.initial_trajectory_pose"),
)
"""The options that have no value by default, and those of earlier versions."""
_OBEYED = (
    "map_builder.use_trajectory_builder_",
    "map_builder.pose_graph.optimize_every_n_nodes",
    "trajectory_builder.trajectory_builder_2d.use_imu_data",
    "trajectory_builder.trajectory_builder_2d.min_",
    "trajectory_builder.trajectory_builder_2d.max_",
    "trajectory_builder.trajectory_builder_2d.missing_data_ray_length",
    "trajectory_builder.trajectory_builder_2d.use_online_correlative_scan_matching",
    "trajectory_builder.trajectory_builder_2d.real_time_correlative_scan_matcher.linear_search_window",
    "trajectory_builder.trajectory_builder_2d.real_time_correlative_scan_matcher.angular_search_window",
    "trajectory_builder.trajectory_builder_2d.motion_filter.max_distance_meters",
    "trajectory_builder.trajectory_builder_2d.motion_filter.max_angle_radians",
    "trajectory_builder.trajectory_builder_2d.submaps.grid_options_2d.resolution",
)
"""The beginnings of the names of options that have an effect."""
_IRRELEVANT = (
    "trajectory_builder.trajectory_builder_3d.",
    "map_builder.num_background_threads",
    "map_builder.pose_graph.log_",
    "map_builder.pose_graph.optimization_problem.log_solver_summary",
)
"""The beginnings of the names of options about threads, logs and mapping in space, which need no remark."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CartographerOptions:
    """The options of a configuration, in meters, seconds and radians.

    Names without a description are Cartographer's.

    Attributes:
        closes_loops: whether loops are closed: ``POSE_GRAPH.optimize_every_n_nodes`` is greater than 0.
        mapper: the settings of the mapper.
        without_effect: the names of options that differ from their defaults but have no effect.
        findings: warnings about options that Cartographer does not have.
    """

    map_frame: str
    tracking_frame: str
    published_frame: str
    odom_frame: str
    provide_odom_frame: bool
    publish_to_tf: bool
    publish_tracked_pose: bool
    use_pose_extrapolator: bool
    use_odometry: bool
    use_imu_data: bool
    num_laser_scans: int
    num_multi_echo_laser_scans: int
    num_point_clouds: int
    lookup_transform_timeout_sec: float
    submap_publish_period_sec: float
    pose_publish_period_sec: float
    trajectory_publish_period_sec: float
    rangefinder_sampling_ratio: float
    min_range: float
    max_range: float
    min_z: float
    max_z: float
    missing_data_ray_length: float
    resolution: float
    mapper: MapperSettings
    without_effect: tuple[str, ...]
    findings: tuple[Diagnostic, ...]


def load_configuration(directory: str, basename: str) -> CartographerOptions:
    """Read a configuration.

    Args:
        directory: the folder that is searched first for the file and for the files that it includes.
        basename: the name of the file.

    Raises:
        LinkwrightError: NAV601, a file is not valid; NAV602, a file does not exist; NAV603, an option is missing or
            has an invalid value.
    """
    source = _read_source(directory, basename, None)
    return _OptionsReader(source, evaluate(source, _make_environment(directory))).read()


def _make_environment(directory: str) -> Environment:
    return Environment(lambda name, place: _read_source(directory, name, place))


def _read_source(directory: str, name: str, place: Place | None) -> SourceText:
    """Return the text of a file in the folder of the user, or of Cartographer's file with that name."""
    for folder in (Path(directory), *_find_default_folders()):
        path = folder / name
        try:
            return SourceText(str(path), read_text(path))
        except FileNotFoundError:
            continue
        except (OSError, UnicodeDecodeError) as error:
            message = phrase("the configuration '{path}' cannot be read: {reason}", path=path, reason=foreign(error))
            raise LinkwrightError(Diagnostic("NAV602", message)) from None
    path = Path(directory) / name
    message = phrase("the configuration '{path}' does not exist", path=display_path(path))
    span, source = (None, None) if place is None else (place.span, place.source)
    raise LinkwrightError(Diagnostic("NAV602", message, span, hint=missing_file_hint(path), source=source))


@cache
def _find_default_folders() -> tuple[Path, ...]:
    """Return the folders of Cartographer's files: of the installed package, and Linkwright's."""
    shares = [get_package_share_path(_PACKAGE), find_substituted_share(_PACKAGE)]
    return tuple(share / _SUBFOLDER for share in dict.fromkeys(shares) if share is not None)


class _OptionsReader:
    """A reader of the table that a configuration returns."""

    def __init__(self, source: SourceText, options: Value) -> None:
        self._source = source
        if not isinstance(options, Table):
            message = phrase("the configuration does not return a table")
            hint = phrase("end it with 'return options'")
            raise LinkwrightError(Diagnostic("NAV603", message, source.span(len(source.text)), hint=hint))
        self._options = options

    def read(self) -> CartographerOptions:
        """Return the options."""
        missing = [name for name in _NODE_OPTIONS if name not in self._options.values]
        if missing:
            unknown = [str(key) for key in self._options.values if key not in _NODE_OPTIONS]
            raise self._make_error(missing[0], phrase("the option '{name}' is missing", name=missing[0]), unknown)
        if self._flag("map_builder.use_trajectory_builder_3d"):
            message = phrase("mapping in space is not supported")
            hint = phrase("set MAP_BUILDER.use_trajectory_builder_2d to true, and use_trajectory_builder_3d to false")
            raise self._error_at("map_builder.use_trajectory_builder_3d", message, hint)
        plane = "trajectory_builder.trajectory_builder_2d"
        counts = [self._count(f"num_{kind}") for kind in ("laser_scans", "multi_echo_laser_scans", "point_clouds")]
        if not any(counts):
            message = phrase("num_laser_scans, num_multi_echo_laser_scans and num_point_clouds are all 0")
            hint = phrase("set the number of topics of one kind to 1")
            raise self._error_at("num_laser_scans", message, hint)
        unknown_places, without_effect = self._compare()
        return CartographerOptions(
            map_frame=self._text("map_frame"),
            tracking_frame=self._text("tracking_frame"),
            published_frame=self._text("published_frame"),
            odom_frame=self._text("odom_frame"),
            provide_odom_frame=self._flag("provide_odom_frame"),
            publish_to_tf=self._flag("publish_to_tf", True),
            publish_tracked_pose=self._flag("publish_tracked_pose", False),
            use_pose_extrapolator=self._flag("use_pose_extrapolator", True),
            use_odometry=self._flag("use_odometry"),
            use_imu_data=self._flag(f"{plane}.use_imu_data"),
            num_laser_scans=counts[0],
            num_multi_echo_laser_scans=counts[1],
            num_point_clouds=counts[2],
            lookup_transform_timeout_sec=self._number("lookup_transform_timeout_sec"),
            submap_publish_period_sec=self._number("submap_publish_period_sec", 0.0),
            pose_publish_period_sec=self._number("pose_publish_period_sec"),
            trajectory_publish_period_sec=self._number("trajectory_publish_period_sec", 0.0),
            rangefinder_sampling_ratio=self._number("rangefinder_sampling_ratio", 0.0),
            min_range=self._number(f"{plane}.min_range"),
            max_range=self._number(f"{plane}.max_range", 0.0),
            min_z=self._number(f"{plane}.min_z"),
            max_z=self._number(f"{plane}.max_z"),
            missing_data_ray_length=self._number(f"{plane}.missing_data_ray_length"),
            resolution=self._number(f"{plane}.submaps.grid_options_2d.resolution", 0.0),
            mapper=self._read_mapper_settings(plane),
            without_effect=tuple(without_effect),
            findings=tuple(self._make_unknown_finding(name, place) for name, place in unknown_places),
        )

    def _read_mapper_settings(self, plane: str) -> MapperSettings:
        """Return the settings of the mapper.

        Windows of the search are never smaller than those of the mapper, whose scans are farther apart.
        """
        defaults = MapperSettings()
        matching = defaults.matching
        if self._flag(f"{plane}.use_online_correlative_scan_matching"):
            window = f"{plane}.real_time_correlative_scan_matcher"
            matching = Search(
                dimension=max(matching.dimension, 2 * self._number(f"{window}.linear_search_window")),
                angle_offset=max(matching.angle_offset, self._number(f"{window}.angular_search_window")),
            )
        return MapperSettings(
            minimum_time_interval=0.0,
            minimum_travel_distance=max(
                _MIN_NODE_DISTANCE_M, self._number(f"{plane}.motion_filter.max_distance_meters")
            ),
            minimum_travel_heading=max(_MIN_NODE_ANGLE_RAD, self._number(f"{plane}.motion_filter.max_angle_radians")),
            scan_buffer_size=_SCAN_BUFFER_SIZE,
            do_loop_closing=self._number("map_builder.pose_graph.optimize_every_n_nodes") > 0,
            matching=matching,
        )

    # --- single options -----------------------------------------------------------------------------------------------

    def _find(self, name: str) -> Value:
        """Return the value of an option, or None."""
        table = self._options
        *parents, key = name.split(".")
        for parent in parents:
            value = table.values.get(parent)
            if not isinstance(value, Table):
                raise self._error_at(name, phrase("the option '{name}' is missing", name=name))
            table = value
        return table.values.get(key)

    def _require(self, name: str) -> Value:
        """Return the value of an option that has no default here."""
        value = self._find(name)
        if value is None:
            raise self._error_at(name, phrase("the option '{name}' is missing", name=name))
        return value

    def _text(self, name: str) -> str:
        value = self._require(name)
        if not isinstance(value, str):
            raise self._error_at(name, phrase("the option '{name}' must be a string", name=name))
        return value.removeprefix("/")

    def _flag(self, name: str, default: bool | None = None) -> bool:
        value = self._require(name) if default is None else self._find(name)
        if value is None and default is not None:
            return default
        if not isinstance(value, bool):
            raise self._error_at(name, phrase("the option '{name}' must be true or false", name=name))
        return value

    def _number(self, name: str, above: float = -inf) -> float:
        value = self._require(name)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise self._error_at(name, phrase("the option '{name}' must be a number", name=name))
        if not value > above:
            raise self._error_at(name, phrase("the option '{name}' must be greater than 0", name=name))
        return float(value)

    def _count(self, name: str) -> int:
        value = self._number(name)
        if value < 0 or value != int(value):
            raise self._error_at(name, phrase("the option '{name}' must be an integer, 0 or more", name=name))
        return int(value)

    # --- errors and remarks -------------------------------------------------------------------------------------------

    def _error_at(self, name: str, message: Phrase, hint: Phrase | None = None) -> LinkwrightError:
        place = self._find_place(name)
        span, source = (None, None) if place is None else (place.span, place.source)
        return LinkwrightError(Diagnostic("NAV603", message, span, hint=hint, source=source))

    def _make_error(self, name: str, message: Phrase, unknown: list[str]) -> LinkwrightError:
        return LinkwrightError(
            Diagnostic("NAV603", message, self._source.span(0), hint=did_you_mean(name, unknown), source=self._source)
        )

    def _find_place(self, name: str) -> Place | None:
        """Return the place of the last assignment of an option, or of the nearest table around it."""
        table, place = self._options, None
        for key in name.split("."):
            place = table.places.get(key, place)
            value = table.values.get(key)
            if not isinstance(value, Table):
                break
            table = value
        return place

    def _compare(self) -> tuple[list[tuple[str, Place | None]], list[str]]:
        """Return the options that do not exist with their places, and the options that have no effect."""
        defaults = _load_defaults()
        unknown: list[tuple[str, Place | None]] = [
            (str(key), place)
            for key, place in self._options.places.items()
            if key not in _NODE_OPTIONS and key not in _OPTIONAL
        ]
        without_effect = [
            name for name in ("use_nav_sat", "use_landmarks") if self._options.values.get(name) not in (False, None)
        ]
        for name, value, place in _iterate_options(self._options, ""):
            section = name.partition(".")[0]
            if section not in ("map_builder", "trajectory_builder") or name.startswith(_OPTIONAL):
                continue
            if name not in defaults:
                unknown.append((name, place))
            elif value != defaults[name] and not name.startswith((*_OBEYED, *_IRRELEVANT)):
                without_effect.append(name.partition(".")[2])
        return unknown, without_effect

    def _make_unknown_finding(self, name: str, place: Place | None) -> Diagnostic:
        key = name.rpartition(".")[2]
        section = name.rpartition(".")[0]
        siblings = [other.rpartition(".")[2] for other in _load_defaults() if other.rpartition(".")[0] == section]
        hint = did_you_mean(key, siblings or [*_NODE_OPTIONS, *_OPTIONAL])
        message = phrase("Cartographer has no option '{name}', and does not start with it", name=name)
        span, source = (None, None) if place is None else (place.span, place.source)
        return Diagnostic("NAV604", message, span, Severity.WARNING, hint=hint, source=source)


def _load_defaults() -> dict[str, Value]:
    """Return the default of each option of the map builder and of trajectories, by name."""
    environment = _make_environment(str(_find_default_folders()[-1]))
    text = (
        'include "map_builder.lua" include "trajectory_builder.lua"'
        " return { map_builder = MAP_BUILDER, trajectory_builder = TRAJECTORY_BUILDER }"
    )
    options = evaluate(SourceText("<defaults>", text), environment)
    assert isinstance(options, Table), "the text returns a table"
    return {name: value for name, value, _ in _iterate_options(options, "")}


def _iterate_options(table: Table, prefix: str) -> Iterator[tuple[str, Value, Place | None]]:
    """Yield the names, values and places of all options that are not tables."""
    for key, value in table.values.items():
        name = f"{prefix}{_format_key(key)}"
        if isinstance(value, Table):
            yield from _iterate_options(value, f"{name}.")
        else:
            yield name, value, table.places.get(key)


def _format_key(key: Key) -> str:
    return key if isinstance(key, str) else f"{key:g}"
