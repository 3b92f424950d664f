"""The API of ``launch_pytest``: launches as pytest fixtures, and tests that run during and after them."""
