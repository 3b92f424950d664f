"""Time: points and durations, clocks, and alarms."""
