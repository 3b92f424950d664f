"""Readers for calls of xacro in launch files, tests and build files, which are not run."""
