"""The programs and Python modules of packages, and the environment that they run in."""
