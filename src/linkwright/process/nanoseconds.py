"""Constants for times in nanoseconds, the unit of clocks in ROS 2 and Python."""

NANOSECONDS_PER_SECOND = 1_000_000_000
