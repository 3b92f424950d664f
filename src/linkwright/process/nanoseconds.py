"""The unit of all clocks: ROS 2 and Python count time in nanoseconds."""

NANOSECONDS_PER_SECOND = 1_000_000_000
