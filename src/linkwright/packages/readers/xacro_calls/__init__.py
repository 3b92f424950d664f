"""Calls of xacro in launch files, tests and build files, read without running any of them."""
