"""ros2_control in a simulated world: hardware of simulated joints, and its plugin."""
