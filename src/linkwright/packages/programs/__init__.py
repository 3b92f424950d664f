"""The programs and Python modules of packages, and the environment in which they run."""
