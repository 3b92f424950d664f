"""Time: points in time and durations, clocks, and alarms."""
