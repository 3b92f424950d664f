import math


def velocity(forward, left, stop_distance=0.5, speed=0.3, turn_speed=1.0):
    """Return the speed in m/s and the turn rate in rad/s that bring the robot to a ball."""
    if forward <= stop_distance:
        return 0.0, 0.0
    direction = math.atan2(left, forward)
    turn = max(-turn_speed, min(turn_speed, 1.5 * direction))
    return min(speed, forward - stop_distance + 0.05), turn
