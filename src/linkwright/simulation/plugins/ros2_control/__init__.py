"""ros2_control in a simulated world: the hardware of simulated joints, and the plugin that runs the controllers."""
