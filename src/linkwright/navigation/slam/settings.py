"""Settings of the mapper; names, units and defaults are those of slam_toolbox's parameters."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf

from linkwright.navigation.slam.search import Search


@dataclass(frozen=True, slots=True, kw_only=True)
class MapperSettings:
    """Settings of a mapper. Lengths are in metres, angles in radians, times in seconds.

    Attributes:
        use_scan_matching: whether scans are matched to those before; else odometry is believed.
        minimum_time_interval: between two scans that are taken.
        minimum_travel_distance: how far the robot has to go for a scan to be taken.
        minimum_travel_heading: or by how much to turn.
        scan_buffer_size: against how many of the last scans a new one is matched.
        scan_buffer_maximum_scan_distance: how far from the new one the oldest of them may be.
        link_match_minimum_response_fine: with a response below this a match does not count.
        link_scan_maximum_distance: scans of earlier passes that are nearer than this are linked with the new one.
        do_loop_closing: whether loops are looked for.
        loop_search_maximum_distance: how far away the robot may seem to be from where it has been before.
        loop_match_minimum_chain_size: how many scans in a row there must be for a loop to be tried.
        loop_match_maximum_variance_coarse: of a position, metres squared, beyond which a loop is not believed.
        loop_match_minimum_response_coarse: the least response of the search for a loop, 0 to 1.
        loop_match_minimum_response_fine: and the match that follows.
        matching: the window in which a new scan is searched.
        loop: the window in which a loop is searched.
        use_response_expansion: whether larger turns are tried where nothing fits.
    """

    use_scan_matching: bool = True
    minimum_time_interval: float = 0.5
    minimum_travel_distance: float = 0.5
    minimum_travel_heading: float = 0.5
    scan_buffer_size: int = 10
    scan_buffer_maximum_scan_distance: float = 10.0
    link_match_minimum_response_fine: float = 0.1
    link_scan_maximum_distance: float = 1.5
    do_loop_closing: bool = True
    loop_search_maximum_distance: float = 3.0
    loop_match_minimum_chain_size: int = 10
    loop_match_maximum_variance_coarse: float = 3.0
    loop_match_minimum_response_coarse: float = 0.35
    loop_match_minimum_response_fine: float = 0.45
    matching: Search = field(default_factory=Search)
    loop: Search = field(
        default_factory=lambda: Search(
            dimension=8.0,
            resolution=0.05,
            smear_deviation=0.03,
            distance_variance_penalty=inf,
            angle_variance_penalty=inf,
        )
    )
    use_response_expansion: bool = True
