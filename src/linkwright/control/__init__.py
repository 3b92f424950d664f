"""ros2_control: hardware, controllers, and who runs them."""
