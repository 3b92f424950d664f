"""Settings of the mapper, with the names, units and defaults of slam_toolbox's parameters."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf

from linkwright.navigation.slam.search import Search


@dataclass(frozen=True, slots=True, kw_only=True)
class MapperSettings:
    """Settings of a mapper, in meters, radians and seconds.

    Attributes:
        use_scan_matching: whether scans are matched to earlier scans; otherwise odometry alone is used.
        minimum_time_interval: the minimum time between two processed scans.
        minimum_travel_distance: how far the robot must move before a scan is processed.
        minimum_travel_heading: the rotation after which a scan is processed even if the robot did not move that far.
        scan_buffer_size: the number of recent scans that a new scan is matched against.
        scan_buffer_maximum_scan_distance: the maximum distance of these scans from the new scan.
        link_match_minimum_response_fine: the minimum response of a match that links scans.
        link_scan_maximum_distance: scans of earlier passes within this distance are linked with the new scan.
        do_loop_closing: whether to search for loops.
        loop_search_maximum_distance: the maximum distance to earlier scans in the search for loops.
        loop_match_minimum_chain_size: the minimum number of consecutive scans for a loop.
        loop_match_maximum_variance_coarse: the maximum variance of the position at which a loop is accepted, in square
            meters.
        loop_match_minimum_response_coarse: the minimum response of the search for a loop, 0 to 1.
        loop_match_minimum_response_fine: the minimum response of the match that follows this search, 0 to 1.
        matching: the search window for a new scan.
        loop: the search window for a loop.
        use_response_expansion: whether to search larger angles if no pose in the window fits.
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
