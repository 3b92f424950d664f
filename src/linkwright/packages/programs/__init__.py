"""The programs and Python modules of packages, and the environment of these programs."""
