"""What ``launch_pytest`` has: launches as pytest fixtures, and tests that run beside them and after them."""
