"""ros2_control: hardware, controllers, and the manager that runs them."""
